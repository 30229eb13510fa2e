#include "calibration/report/report_page.h"

#include <array>
#include <cmath>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "core/base/image.h"

namespace lumorph::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A camera that sees a flat board of 5 x 4 points, each seen beside its place by what `error` says.
CalibrationReport exampleReport(const std::string& name) {
    CalibrationReport report;
    ProcamCalibration& result = report.record.result;
    report.record.source = {"2026-11-25T10:00:00Z", "chess:5x4:30", "graycode", {"/captures/" + name}, 0.001};
    result.camera = {{640, 480}, {800, 1, 319.5, 239.5, 0, 0, 0, 0, 0}, {}, {1.5, 0, 2, 2}, 0.25, "pinhole"};
    result.projector = {{800, 600}, {1000, 1, 399.5, 650.0, 0, 0, 0, 0, 0}, {}, {}, 0.5, "k1"};
    result.projectorFromCamera = {0, 0, 0, -100, 0, 0};
    result.rms = 0.375;
    result.worstView = name;
    result.warnings = {{Cause::clipped, name, "a&b.png", "30 % of it is <too> bright", "expose \"less\""}};
    result.state.camera = result.camera.lens;
    result.state.projector = result.projector.lens;
    result.state.projectorFromCamera = result.projectorFromCamera;
    for (const std::string& view : {name, std::string("pose_2")}) {
        result.views.push_back({view, 0.25, 0.5, 0.75});
        result.state.cameraFromBoard.push_back({0, 0, 0, -60, -45, 1000});
        ViewObservations& seen = report.observations.emplace_back();
        seen.name = view;
        for (int i = 0; i < 20; ++i) {
            const cv::Point3d point(30.0 * (i % 5), 30.0 * (i / 5), 0.0);
            seen.corners.board.push_back(point);
            seen.corners.seen.emplace_back(319.5 + 0.8 * (point.x - 60.0) + (i % 2 == 0 ? 0.25 : -0.25),
                                           239.5 + 0.8 * (point.y - 45.0));
        }
        report.sights.push_back(cv::Mat(480, 640, CV_8U, cv::Scalar(90)));
    }
    return report;
}

/// Every picture in a page: its kind, and its bytes.
std::vector<std::pair<std::string, std::string>> picturesIn(const std::string& page) {
    std::vector<std::pair<std::string, std::string>> pictures;
    const std::regex pattern("data:image/([a-z+]+);base64,([A-Za-z0-9+/=]*)\"");
    for (auto at = std::sregex_iterator(page.begin(), page.end(), pattern); at != std::sregex_iterator(); ++at) {
        std::string bytes;
        unsigned bits = 0;
        int count = 0;
        for (const char c : (*at)[2].str()) {
            constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
            const std::size_t value = kLetters.find(c);
            if (value == std::string_view::npos) break;
            bits = bits << 6 | static_cast<unsigned>(value);
            if ((count += 6) >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255U);
        }
        pictures.emplace_back((*at)[1].str(), bytes);
    }
    return pictures;
}

/// Whether every tag is closed by its own.
bool isBalanced(const std::string& page) {
    std::vector<std::string> open;
    const std::regex tag("<(/?)([a-zA-Z0-9]+)[^>]*?(/?)>");
    for (auto at = std::sregex_iterator(page.begin(), page.end(), tag); at != std::sregex_iterator(); ++at) {
        const std::string name = (*at)[2].str();
        if (name == "meta" || name == "img" || name == "br" || (*at)[3].length() > 0) continue;
        if ((*at)[1].length() == 0) {
            open.push_back(name);
        } else {
            if (open.empty() || open.back() != name) return false;
            open.pop_back();
        }
    }
    return open.empty();
}

int countOf(const std::string& text, const std::string& what) {
    int count = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
    return count;
}

TEST(ReportPage, HoldsFiguresViewsWarningsAndInputs) {
    const std::string page = reportPage(exampleReport("pose_1"));
    for (const char* part :
         {"2026-11-25T10:00:00Z", "chess:5x4:30", "graycode", "/captures/pose_1", "0.375 pixels", "800.00 &#177; 1.50",
          "640 &#215; 480", "T = (-100.000", "<td>pose_1</td><td>0.250</td><td>0.500</td><td>0.750</td><td>worst</td>",
          "<td>pose_2</td>", "clipped", "What to do: expose &quot;less&quot;", "&lt;too&gt; bright"})
        EXPECT_THAT(page, HasSubstr(part));
    EXPECT_TRUE(isBalanced(page));
}

TEST(ReportPage, BeginsWithTheMillimetresThatTheWindowShows) {
    CalibrationReport report = exampleReport("pose_1");
    // 95 of 100 of a length that is spread evenly to all sides: the root of -2 ln 0.05 over 2, times its root mean
    // square.
    const double rms = 0.75 * std::hypot(60.0, 45.0, 1000.0) / report.record.result.projector.lens[kFocalLength];
    char text[80];
    std::snprintf(text, sizeof text, "within <b>%.2f mm</b> of where it should on its boards",
                  std::sqrt(-std::log(0.05)) * rms);
    EXPECT_THAT(reportPage(report), HasSubstr(text));
    report.millimetres = 0.4271;
    report.where = "where the device stands";
    EXPECT_THAT(reportPage(report), HasSubstr("within <b>0.43 mm</b> of where it should where the device stands"));
    EXPECT_THAT(reportPage(report), Not(HasSubstr("on its boards")));
}

TEST(ReportPage, SaysThatItIsSimulated) {
    CalibrationReport report = exampleReport("pose_1");
    EXPECT_THAT(reportPage(report), Not(HasSubstr("imulated")));
    report.record.source.isSimulated = true;
    const std::string page = reportPage(report);
    EXPECT_THAT(page, HasSubstr("<b>Simulated</b>"));
    EXPECT_THAT(page, Not(HasSubstr("measured")));
    EXPECT_TRUE(isBalanced(page));
}

TEST(ReportPage, PlotsShowTheErrors) {
    const auto pictures = picturesIn(reportPage(exampleReport("pose_1")));
    ASSERT_EQ(pictures.size(), 4U) << "bars, dots of the camera, two sights";
    const std::string& bars = pictures[0].second;
    EXPECT_EQ(pictures[0].first, "svg+xml");
    EXPECT_EQ(countOf(bars, "<rect x="), 6) << "three of each view";
    EXPECT_THAT(bars, HasSubstr("width=\"380.0\"")) << "the longest fills the plot";
    EXPECT_THAT(bars, HasSubstr("width=\"126.7\"")) << "a third of it";
    const std::string& dots = pictures[1].second;
    EXPECT_EQ(countOf(dots, "<circle"), 41) << "forty points, and their RMS";
    EXPECT_THAT(dots, HasSubstr("RMS 0.250"));
    for (const std::size_t sight : {2U, 3U}) {
        EXPECT_EQ(pictures[sight].first, "png");
        const std::string& bytes = pictures[sight].second;
        const Image image = decodeImage(std::as_bytes(std::span(bytes)), "sight");
        EXPECT_EQ(image.size(), glm::ivec2(320, 240));
        int red = 0;
        for (const Image::Pixel& pixel : image.pixels()) red += pixel[0] > 150 && pixel[1] < 110;
        EXPECT_GT(red, 50) << "its errors are drawn";
    }
    for (const auto& [kind, bytes] : pictures) EXPECT_TRUE(kind != "svg+xml" || isBalanced(bytes)) << bytes;
}

TEST(ReportPage, NamesAreTextWhateverTheyHold) {
    const std::string name = "\"><script>alert('1')</script>&amp;\x01";
    CalibrationReport report = exampleReport(name);
    report.pictures.push_back({name, cv::Mat(10, 10, CV_8UC3, cv::Scalar(1, 2, 3))});
    const std::string page = reportPage(report);
    EXPECT_THAT(page, Not(HasSubstr("<script")));
    EXPECT_THAT(page, HasSubstr("&lt;script&gt;alert(&#39;1&#39;)"));
    EXPECT_TRUE(isBalanced(page));
    for (const auto& [kind, bytes] : picturesIn(page)) EXPECT_THAT(bytes, Not(HasSubstr("<script")));
}

TEST(ReportPage, RefusalSaysWhatToDoAndHasNoFigures) {
    CalibrationReport report;
    report.record.source.inputs = {"captures"};
    report.refusal = Finding{Cause::lateFrame, "pose_3", "07.png", "shows the pattern before its own", "wait longer"};
    const std::string page = reportPage(report);
    EXPECT_THAT(page, HasSubstr("late_frame"));
    EXPECT_THAT(page, HasSubstr("pose_3, 07.png"));
    EXPECT_THAT(page, HasSubstr("What to do: wait longer"));
    EXPECT_THAT(page, Not(HasSubstr("Focal length")));
    EXPECT_TRUE(isBalanced(page));
}

TEST(ReportPage, CameraAloneAndNumbersThatAreNoneAreWrittenToo) {
    CalibrationReport report = exampleReport("pose_1");
    report.record.result.projector = {};
    report.record.result.views[0].cameraRms = std::nan("");
    report.observations.clear();
    report.sights.clear();
    const std::string page = reportPage(report);
    EXPECT_THAT(page, Not(HasSubstr("<th>Projector</th>")));
    EXPECT_THAT(page, Not(HasSubstr("nan")));
    EXPECT_EQ(picturesIn(page).size(), 1U);
    EXPECT_TRUE(isBalanced(page));
}

} // namespace
} // namespace lumorph::test
