#include "calibration/report/report_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>

#include <opencv2/imgproc.hpp>

#include "calibration/report/calibrated_room.h"
#include "core/base/image.h"

namespace lumorph {

namespace {

constexpr int kPictureWidth = 320;
constexpr std::size_t kMostDots = 1500; // of a plot
constexpr double kDegreesInRadian = 57.29577951308232;
constexpr const char* kCameraColour = "#2b6cb0";
constexpr const char* kProjectorColour = "#c05621";
constexpr const char* kHeldOutColour = "#718096";

/// Text that HTML and SVG take for text.
std::string escaped(std::string_view text) {
    std::string safe;
    for (const char c : text) switch (c) {
        case '&':
            safe += "&amp;";
            break;
        case '<':
            safe += "&lt;";
            break;
        case '>':
            safe += "&gt;";
            break;
        case '"':
            safe += "&quot;";
            break;
        case '\'':
            safe += "&#39;";
            break;
        default:
            safe += static_cast<unsigned char>(c) < 32 ? ' ' : c;
        }
    return safe;
}

std::string fixed(double number, int digits) {
    if (!std::isfinite(number)) return "-";
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, number);
    return text;
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        unsigned bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kLetters[bits >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

std::string imageTag(std::string_view kind, std::string_view bytes, int width, int height, const std::string& title) {
    return "<img alt=\"" + escaped(title) + "\" width=\"" + std::to_string(width) + "\" height=\"" +
           std::to_string(height) + "\" src=\"data:image/" + std::string(kind) + ";base64," + base64(bytes) + "\">";
}

std::string pictureTag(const cv::Mat& picture, const std::string& title) {
    cv::Mat small = picture;
    const double scale = std::min(1.0, static_cast<double>(kPictureWidth) / picture.cols);
    const cv::Size size(std::max(1, cvRound(picture.cols * scale)), std::max(1, cvRound(picture.rows * scale)));
    if (scale < 1.0) cv::resize(picture, small, size, 0.0, 0.0, cv::INTER_AREA);
    cv::Mat colours;
    cv::cvtColor(small, colours, small.channels() == 1 ? cv::COLOR_GRAY2RGBA : cv::COLOR_BGR2RGBA);
    Image image({size.width, size.height});
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const auto& pixel = colours.at<cv::Vec4b>(y, x);
            image.at(x, y) = {pixel[0], pixel[1], pixel[2], pixel[3]};
        }
    const std::vector<std::byte> bytes = pngBytes(image, title);
    return imageTag("png", {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, size.width, size.height, title);
}

std::string row(std::initializer_list<std::string> cells, const char* cell = "td") {
    std::string text = "<tr>";
    for (const std::string& one : cells) text += "<" + std::string(cell) + ">" + one + "</" + cell + ">";
    return text + "</tr>\n";
}

std::string beginTable() { return "<table border=\"1\" cellspacing=\"0\" cellpadding=\"4\">\n"; }

std::string withSigma(double value, double sigma, int digits) {
    return fixed(value, digits) + (sigma > 0.0 ? " &#177; " + fixed(sigma, digits) : "");
}

std::string deviceTable(const ProcamCalibration& result) {
    const bool both = !result.projector.size.empty();
    const auto line = [&](const char* name, const auto& of) {
        return both ? row({name, of(result.camera), of(result.projector)}) : row({name, of(result.camera)});
    };
    const auto term = [&](const char* name, LensParameter parameter, int digits) {
        return line(name, [=](const CalibratedDevice& device) {
            return withSigma(device.lens[parameter], device.sigma[parameter], digits);
        });
    };
    std::string text = beginTable() + (both ? row({"", "Camera", "Projector"}, "th") : row({"", "Camera"}, "th"));
    text += line("Picture", [](const CalibratedDevice& device) {
        return std::to_string(device.size.width) + " &#215; " + std::to_string(device.size.height) + " pixels";
    });
    text += line("Lens", [](const CalibratedDevice& device) { return escaped(device.model); });
    text += line("Reprojection error, RMS",
                 [](const CalibratedDevice& device) { return fixed(device.rms, 3) + " pixels"; });
    text += term("Focal length, pixels", kFocalLength, 2);
    text += term("Aspect", kAspect, 5);
    text += term("Principal point, x", kPrincipalX, 2) + term("Principal point, y", kPrincipalY, 2);
    text += term("k1", kK1, 5) + term("k2", kK2, 5) + term("p1", kP1, 6) + term("p2", kP2, 6) + term("k3", kK3, 5);
    return text + "</table>\n";
}

std::string rigText(const ProcamCalibration& result) {
    if (result.projector.size.empty()) return {};
    const PoseVector& rig = result.projectorFromCamera;
    const PoseVector& sigma = result.projectorFromCameraSigma;
    const double distance = std::hypot(rig[3], rig[4], rig[5]);
    const double turn = kDegreesInRadian * std::hypot(rig[0], rig[1], rig[2]);
    return "<p>The projector's frame from the camera's: T = (" + withSigma(rig[3], sigma[3], 3) + ", " +
           withSigma(rig[4], sigma[4], 3) + ", " + withSigma(rig[5], sigma[5], 3) + ") in the board's unit, length " +
           fixed(distance, 3) + "; turned by " + fixed(turn, 3) + " degrees.</p>\n";
}

std::string viewTable(const ProcamCalibration& result) {
    if (result.views.empty()) return {};
    std::string text = "<h2>Views</h2>\n" + beginTable() +
                       row({"Pose", "Camera, RMS pixels", "Projector, RMS pixels", "Held out, pixels", ""}, "th");
    for (const ViewQuality& view : result.views)
        text += row({escaped(view.name), fixed(view.cameraRms, 3), fixed(view.projectorRms, 3),
                     view.heldOut ? fixed(*view.heldOut, 3) : "-", view.name == result.worstView ? "worst" : ""});
    return text + "</table>\n<p>Held out: the pose was left out of the solution, its board found by the camera alone, "
                  "and what was decoded on it reprojected into the projector.</p>\n";
}

std::string svgBegin(int width, int height) {
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + std::to_string(width) + "\" height=\"" +
           std::to_string(height) +
           "\" font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" "
           "height=\"100%\" fill=\"#ffffff\"/>\n";
}

std::string svgText(double x, double y, const std::string& text, const char* anchor = "start") {
    return "<text x=\"" + fixed(x, 1) + "\" y=\"" + fixed(y, 1) + "\" text-anchor=\"" + anchor + "\">" + escaped(text) +
           "</text>\n";
}

/// Errors of each view as bars.
std::string barPlot(const ProcamCalibration& result) {
    constexpr double kLeft = 120.0, kLong = 380.0, kBar = 9.0;
    const auto count = static_cast<int>(std::min<std::size_t>(result.views.size(), 60));
    double most = 1e-6;
    for (const ViewQuality& view : result.views)
        most = std::max({most, view.cameraRms, view.projectorRms, view.heldOut.value_or(0.0)});
    const int height = 30 + count * 36 + 8;
    std::string text = svgBegin(560, height);
    text += svgText(kLeft, 16, "camera (blue), projector (orange), held out (grey); pixels");
    for (int i = 0; i < count; ++i) {
        const ViewQuality& view = result.views[static_cast<std::size_t>(i)];
        double y = 28.0 + 36.0 * i;
        text += svgText(kLeft - 6.0, y + 17.0, view.name.substr(0, 18), "end");
        for (const auto& [value, colour] :
             {std::pair(view.cameraRms, kCameraColour), std::pair(view.projectorRms, kProjectorColour),
              std::pair(view.heldOut.value_or(0.0), kHeldOutColour)}) {
            const double length = std::isfinite(value) ? kLong * value / most : 0.0;
            text += "<rect x=\"" + fixed(kLeft, 1) + "\" y=\"" + fixed(y, 1) + "\" width=\"" + fixed(length, 1) +
                    "\" height=\"" + fixed(kBar, 1) + "\" fill=\"" + colour + "\"/>\n";
            if (value > 0.0) text += svgText(kLeft + length + 4.0, y + kBar, fixed(value, 3));
            y += kBar + 1.0;
        }
    }
    return imageTag("svg+xml", text + "</svg>\n", 560, height, "errors of each view");
}

/// Errors as dots around 0, with a circle of their RMS.
std::string dotPlot(const std::vector<cv::Point2d>& errors, const char* title, const char* colour) {
    constexpr int kSide = 260;
    constexpr double kMiddle = 0.5 * kSide;
    const double rms = rmsOf(errors);
    const double scale = 0.4 * kSide / std::max(1e-6, 3.0 * rms); // pixels of the plot a pixel of error
    std::string text = svgBegin(kSide, kSide);
    text +=
        "<line x1=\"0\" y1=\"130\" x2=\"260\" y2=\"130\" stroke=\"#cbd5e0\"/>\n<line x1=\"130\" y1=\"0\" x2=\"130\" "
        "y2=\"260\" stroke=\"#cbd5e0\"/>\n";
    const std::size_t every = errors.size() / kMostDots + 1;
    for (std::size_t i = 0; i < errors.size(); i += every) {
        const double x = std::clamp(kMiddle + scale * errors[i].x, 2.0, kSide - 2.0);
        const double y = std::clamp(kMiddle + scale * errors[i].y, 2.0, kSide - 2.0);
        if (std::isfinite(x) && std::isfinite(y))
            text += "<circle cx=\"" + fixed(x, 1) + "\" cy=\"" + fixed(y, 1) + "\" r=\"1.3\" fill=\"" + colour +
                    "\" fill-opacity=\"0.5\"/>\n";
    }
    text += "<circle cx=\"130\" cy=\"130\" r=\"" + fixed(scale * rms, 1) +
            "\" fill=\"none\" stroke=\"#1a202c\" stroke-dasharray=\"4 3\"/>\n";
    text += svgText(6, 16, title) + svgText(6, kSide - 8, "circle: RMS " + fixed(rms, 3) + " pixels");
    return imageTag("svg+xml", text + "</svg>\n", kSide, kSide, title);
}

/// The picture of a pose with the board's points, and their errors a hundred times as long.
cv::Mat sightWithErrors(const cv::Mat& sight, const ViewObservations& view, const std::vector<cv::Point2d>& errors) {
    constexpr double kLonger = 100.0;
    cv::Mat picture;
    const double scale = std::min(1.0, 2.0 * kPictureWidth / sight.cols);
    cv::resize(sight, picture, {}, scale, scale, cv::INTER_AREA);
    cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
    for (std::size_t i = 0; i < view.corners.seen.size() && i < errors.size(); ++i) {
        const cv::Point2d at = scale * view.corners.seen[i];
        const cv::Point2d to = at + kLonger * scale * errors[i];
        cv::circle(picture, at, 3, {80, 220, 80}, 1, cv::LINE_AA);
        if (std::isfinite(to.x) && std::abs(to.x) < 1e5 && std::isfinite(to.y) && std::abs(to.y) < 1e5)
            cv::line(picture, at, to, {60, 60, 240}, 2, cv::LINE_AA);
    }
    return picture;
}

std::string residualsText(const CalibrationReport& report) {
    const ProcamCalibration& result = report.record.result;
    const std::size_t count =
        std::min({report.observations.size(), result.views.size(), result.state.cameraFromBoard.size()});
    std::string text = "<h2>Residuals</h2>\n<p>" + barPlot(result) + "</p>\n";
    std::vector<cv::Point2d> camera, projector;
    std::string sights;
    for (std::size_t i = 0; i < count; ++i) {
        const ViewObservations& view = report.observations[i];
        const PoseVector& pose = result.state.cameraFromBoard[i];
        const std::vector<cv::Point2d> errors = cameraErrors(view, result.state, pose);
        camera.insert(camera.end(), errors.begin(), errors.end());
        const std::vector<cv::Point2d> lit = projectorErrors(view, result.state, pose);
        projector.insert(projector.end(), lit.begin(), lit.end());
        if (i < report.sights.size() && report.sights[i].type() == CV_8UC1)
            sights += "<p>" + pictureTag(sightWithErrors(report.sights[i], view, errors), view.name) + "<br>" +
                      escaped(view.name) + "</p>\n";
    }
    if (!camera.empty()) {
        text += "<p>" + dotPlot(camera, "board's points in the camera", kCameraColour);
        if (!projector.empty()) text += " " + dotPlot(projector, "decoded points in the projector", kProjectorColour);
        text += "</p>\n";
    }
    if (!sights.empty())
        text += "<h2>What the camera saw</h2>\n<p>The board's points (green), and their errors a hundred times as long "
                "(red).</p>\n" +
                sights;
    return text;
}

std::string findingText(const Finding& finding) {
    const std::string place = finding.view + (finding.view.empty() || finding.file.empty() ? "" : ", ") + finding.file;
    return "<b>" + escaped(std::string(keyOf(finding.cause))) + "</b>" +
           (place.empty() ? "" : " (" + escaped(place) + ")") + ": " + escaped(finding.why) +
           ".<br>What to do: " + escaped(finding.remedy) + ".";
}

std::string warningsText(const ProcamCalibration& result) {
    std::string text = "<h2>Warnings</h2>\n";
    if (result.warnings.empty()) return text + "<p>None.</p>\n";
    text += "<ul>\n";
    for (const Finding& finding : result.warnings) text += "<li>" + findingText(finding) + "</li>\n";
    return text + "</ul>\n";
}

std::string sourceText(const CalibrationSource& source) {
    std::string text = beginTable();
    const auto add = [&text](const char* name, const std::string& value) {
        if (!value.empty()) text += row({name, escaped(value)});
    };
    add("Date (UTC)", source.date);
    add("Board", source.board);
    add("Patterns", source.pattern);
    for (const std::string& input : source.inputs) add("Input", input);
    if (source.isSimulated) add("Way", "simulated");
    return text + "</table>\n";
}

std::string figuresText(const CalibrationReport& report) {
    const ProcamCalibration& result = report.record.result;
    std::string text = "<h2>Figures</h2>\n";
    const double unit = 1000.0 * report.record.source.metresPerUnit;
    const std::optional<double> onBoards = heldOutMillimetresOf(result);
    if (const auto within = report.millimetres ? report.millimetres : onBoards)
        text += "<p>Light lands within <b>" + fixed(report.millimetres ? *within : unit * *within, 2) +
                " mm</b> of where it should " + escaped(report.where) + ", in 95 of 100 cases.</p>\n";
    text += "<p>Reprojection error of all: <b>" + fixed(result.rms, 3) + " pixels</b> RMS.";
    if (!result.worstView.empty()) text += " Worst view: " + escaped(result.worstView) + ".";
    if (result.halvesDiffer && result.halvesAllowed)
        text += " Two halves of the views differ by " + fixed(*result.halvesDiffer, 3) +
                " pixels in the projector; their uncertainties allow " + fixed(*result.halvesAllowed, 3) + ".";
    if (result.degenerate) text += " <b>The data does not determine everything: see the warnings.</b>";
    text += "</p>\n" + deviceTable(result) + "<p>&#177;: one standard deviation; what has none was held.</p>\n";
    return text + rigText(result) + viewTable(result) + warningsText(result) + residualsText(report);
}

} // namespace

std::string reportPage(const CalibrationReport& report) {
    std::string page =
        "<!DOCTYPE html>\n<html>\n<head>\n<meta charset=\"utf-8\">\n<title>Calibration</title>\n"
        "<style>\nbody { font-family: sans-serif; color: #1a202c; margin: 24px; }\n"
        "table { border-collapse: collapse; }\nth, td { text-align: left; }\n</style>\n</head>\n<body>\n"
        "<h1>Calibration by Lumorph</h1>\n" +
        (report.record.source.isSimulated ? "<p><b>Simulated</b>: made in the virtual lab, and true of no room.</p>\n"
                                          : std::string()) +
        sourceText(report.record.source);
    if (report.refusal)
        page += "<h2>Refused</h2>\n<p>This capture cannot be trusted, so there are no figures.</p>\n<p>" +
                findingText(*report.refusal) + "</p>\n";
    else
        page += figuresText(report);
    for (const ReportPicture& picture : report.pictures)
        page += "<p>" + pictureTag(picture.picture, picture.title) + "<br>" + escaped(picture.title) + "</p>\n";
    return page + "</body>\n</html>\n";
}

} // namespace lumorph
