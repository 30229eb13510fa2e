#include "app/studio/calibration/report_pdf.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "calibration/report/report_page.h"
#include "core/base/error.h"
#include "tests/core/temporary_folder.h"

namespace lumorph::studio {
namespace {

std::string bytesOf(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

int countOf(const std::string& text, const std::string& what) {
    int count = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
    return count;
}

/// A report of so many views, each with a picture.
std::string pageOf(int views) {
    CalibrationReport report;
    ProcamCalibration& result = report.record.result;
    result.camera = {{640, 480}, {800, 1, 319.5, 239.5}, {}, {}, 0.25, "pinhole"};
    for (int i = 0; i < views; ++i) {
        result.views.push_back({"pose_" + std::to_string(i), 0.1, 0.2, 0.3});
        cv::Mat picture(200, 300, CV_8U);
        for (int y = 0; y < picture.rows; ++y)
            for (int x = 0; x < picture.cols; ++x) picture.at<uchar>(y, x) = static_cast<uchar>(x * y + i);
        report.pictures.push_back({"picture " + std::to_string(i), picture});
    }
    return reportPage(report);
}

TEST(ReportPdf, HasPagesPicturesAndPlots) {
    const TemporaryFolder folder;
    writeReportPdf(pageOf(1), folder / "short.pdf");
    writeReportPdf(pageOf(12), folder / "long.pdf");
    const std::string few = bytesOf(folder / "short.pdf");
    const std::string many = bytesOf(folder / "long.pdf");
    EXPECT_TRUE(few.starts_with("%PDF-"));
    EXPECT_NE(few.find("%%EOF"), std::string::npos);
    const int fewPages = countOf(few, "/Type /Page\n") + countOf(few, "/Type /Page ");
    const int manyPages = countOf(many, "/Type /Page\n") + countOf(many, "/Type /Page ");
    EXPECT_GE(fewPages, 1);
    EXPECT_GT(manyPages, fewPages + 2);
    EXPECT_GE(countOf(many, "/Subtype /Image"), 13) << "each picture, and the plot";
}

TEST(ReportPdf, FolderThatIsNotThereIsToldAndNothingIsLeft) {
    const TemporaryFolder folder;
    EXPECT_THROW(writeReportPdf(pageOf(1), folder / "no/such.pdf"), DeviceError);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

} // namespace
} // namespace lumorph::studio
