#include "calibration/doctor/view_check.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <opencv2/imgproc.hpp>

namespace lumorph {

namespace {

constexpr double kMostMotion = 0.5;       // camera pixels
constexpr double kLeastCorrelation = 0.8; // of two pictures of the same board under the same light
constexpr int kSaturated = 254;
constexpr double kMostSaturated = 0.1; // of the board
constexpr double kMostStray = 0.002;   // of decoded pixels
constexpr int kCameraBorder = 4;       // pixels that tell nothing of where the projector's picture ends
constexpr int kBand = 8;               // projector pixels
constexpr double kSameEnd = 1.2;       // resolved stripes: an edge of something lit is hardly ever that parallel
constexpr double kEndSlack = 4.0;      // resolved stripes that may be lost at the picture's end
constexpr double kEndPixels = 2.5;     // camera pixels
constexpr double kPaper = 1.6;         // a board with its margin to the outline of its points
constexpr double kLeastBeside = 0.05;  // of the light
constexpr int kRim = 3;                // camera pixels
constexpr int kStraightBands = 14;     // that end in the same place

double medianOfNumbers(std::vector<double> numbers) {
    const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
    std::ranges::nth_element(numbers, middle);
    return *middle;
}

cv::Mat1b outlineMask(cv::Size size, const std::vector<cv::Point2d>& board) {
    std::vector<cv::Point> points, outline;
    for (const cv::Point2d& point : board) points.emplace_back(cvRound(point.x), cvRound(point.y));
    cv::convexHull(points, outline);
    cv::Mat1b mask = cv::Mat1b::zeros(size);
    cv::fillConvexPoly(mask, outline, cv::Scalar(255));
    return mask;
}

/// Share of the decoded light that lies beside the board, its margin of paper counted with it; 1 without a board.
double shareBeside(const DecodedView& decoded, const std::vector<cv::Point2d>& board) {
    if (board.empty()) return 1.0;
    cv::Point2d centre;
    for (const cv::Point2d& point : board) centre += point / static_cast<double>(board.size());
    std::vector<cv::Point2d> paper;
    paper.reserve(board.size());
    for (const cv::Point2d& point : board) paper.push_back(centre + kPaper * (point - centre));
    const cv::Mat1b beside = ~outlineMask(decoded.column.size(), paper);
    const cv::Mat1b lit = decoded.column == decoded.column; // false where it is not a number
    return static_cast<double>(cv::countNonZero(lit & beside)) / std::max(1, cv::countNonZero(lit));
}

/// How far the board's points moved from where they are; the median of each coordinate.
cv::Point2d motionOf(const cv::Mat& image, const std::vector<cv::Point2d>& board, double reach) {
    std::vector<cv::Point2f> points(board.begin(), board.end());
    const int room = std::clamp(static_cast<int>(reach), 3, 12);
    cv::cornerSubPix(image, points, {room, room}, {-1, -1},
                     {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 0.01});
    std::vector<double> x, y;
    for (std::size_t i = 0; i < points.size(); ++i) {
        x.push_back(points[i].x - board[i].x);
        y.push_back(points[i].y - board[i].y);
    }
    return {medianOfNumbers(x), medianOfNumbers(y)};
}

double correlationOf(const cv::Mat1f& one, const cv::Mat1f& other, const cv::Mat1b& mask) {
    cv::Scalar meanOne, meanOther, spreadOne, spreadOther;
    cv::meanStdDev(one, meanOne, spreadOne, mask);
    cv::meanStdDev(other, meanOther, spreadOther, mask);
    const cv::Mat1f product = (one - meanOne[0]).mul(other - meanOther[0]);
    return cv::mean(product, mask)[0] / std::max(1e-6, spreadOne[0] * spreadOther[0]);
}

/// Coordinates of one axis at the end of what is decoded, by bands of the other axis.
struct PictureEnd {
    double last = 0.0;    ///< largest coordinate that is no stray
    bool isSharp = false; ///< many bands end there, within the camera's picture
};

struct Band {
    std::vector<float> values;
    std::vector<float> atRim; ///< those at the rim of the camera's picture
};

PictureEnd endOf(const cv::Mat1f& along, const cv::Mat1f& across, int cell) {
    const cv::Rect inside(kCameraBorder + kRim, kCameraBorder + kRim, along.cols - 2 * (kCameraBorder + kRim),
                          along.rows - 2 * (kCameraBorder + kRim));
    std::map<int, Band> bands;
    for (int y = kCameraBorder; y + kCameraBorder < along.rows; ++y)
        for (int x = kCameraBorder; x + kCameraBorder < along.cols; ++x)
            if (std::isfinite(along(y, x)) && std::isfinite(across(y, x))) {
                Band& band = bands[static_cast<int>(across(y, x)) / kBand];
                band.values.push_back(along(y, x));
                if (!inside.contains({x, y})) band.atRim.push_back(along(y, x));
            }
    std::vector<double> ends;
    std::vector<double> within; // ends that are not where the camera's picture ends
    for (auto& [number, band] : bands) {
        if (band.values.size() < 40) continue;
        const auto stray = static_cast<std::size_t>(kMostStray * static_cast<double>(band.values.size())) + 1;
        const auto at = band.values.end() - static_cast<std::ptrdiff_t>(stray) - 1;
        std::ranges::nth_element(band.values, at);
        ends.push_back(*at);
        const float near = *at - static_cast<float>(kSameEnd * cell);
        if (std::ranges::count_if(band.atRim, [near](float value) { return value > near; }) < 2) within.push_back(*at);
    }
    if (ends.size() < 8) return {};
    std::ranges::sort(ends);
    const double last = ends[ends.size() - 3];
    const auto same = std::ranges::count_if(within, [=](double end) { return end > last - kSameEnd * cell; });
    return {last, same >= kStraightBands};
}

/// How projector coordinates grow with camera pixels: a pixel of the one by a pixel of the other, on average.
cv::Matx22d growthOf(const std::vector<ProjectorPoint>& points) {
    cv::Matx22d spread = cv::Matx22d::zeros();
    cv::Matx22d mixed = cv::Matx22d::zeros();
    cv::Point2d camera, projector;
    for (const ProjectorPoint& point : points) {
        camera += point.camera / static_cast<double>(points.size());
        projector += point.projector / static_cast<double>(points.size());
    }
    for (const ProjectorPoint& point : points) {
        const cv::Vec2d c(point.camera.x - camera.x, point.camera.y - camera.y);
        const cv::Vec2d p(point.projector.x - projector.x, point.projector.y - projector.y);
        spread += c * c.t();
        mixed += p * c.t();
    }
    return mixed * spread.inv();
}

/// Whether rows of the projector lie along rows of the camera more than along its columns.
bool isUpright(const cv::Matx22d& growth) {
    return std::abs(growth(0, 0)) + std::abs(growth(1, 1)) > std::abs(growth(0, 1)) + std::abs(growth(1, 0));
}

std::vector<ProjectorPoint> somePointsOf(const DecodedView& decoded) {
    constexpr int kEachPixel = 6;
    std::vector<ProjectorPoint> points;
    for (int y = kCameraBorder; y + kCameraBorder < decoded.column.rows; y += kEachPixel)
        for (int x = kCameraBorder; x + kCameraBorder < decoded.column.cols; x += kEachPixel)
            if (std::isfinite(decoded.column(y, x)) && std::isfinite(decoded.row(y, x)))
                points.push_back({cv::Point2d(x, y), {decoded.column(y, x), decoded.row(y, x)}});
    return points;
}

Finding exchangedAxes(const std::string& view) {
    return {Cause::wrongOrder, view, "", "columns and rows of the patterns are exchanged",
            "capture columns before rows, or correct the order file; and check width and height of the projector"};
}

} // namespace

std::optional<Finding> checkSteadiness(const CapturedView& view, const std::vector<cv::Mat>& images,
                                       const CaptureOrder& order, const std::vector<cv::Point2d>& board) {
    double reach = 30.0;
    for (std::size_t i = 0; i + 1 < board.size(); ++i) reach = std::min(reach, 0.4 * cv::norm(board[i] - board[i + 1]));
    const std::vector<EvenlyLit> lit = evenlyLit(images, order);
    const cv::Mat1b mask = outlineMask(images.front().size(), board);
    std::vector<cv::Point2d> motion;
    for (const EvenlyLit& light : lit) {
        cv::Mat1b grey;
        light.image.convertTo(grey, CV_8U);
        const bool isOther = correlationOf(light.image, lit.back().image, mask) < kLeastCorrelation;
        motion.push_back(isOther ? cv::Point2d(reach, reach) : motionOf(grey, board, reach));
    }
    for (std::size_t i = 1; i < motion.size(); ++i) {
        if (cv::norm(motion[i] - motion.front()) <= kMostMotion) continue;
        const auto file = view.files[static_cast<std::size_t>(lit[i].firstImage)].filename().string();
        return Finding{Cause::rigMoved, view.name, file,
                       "camera or board moved: from about this image on the board is elsewhere in the picture",
                       "fix both, touch nothing while patterns are shown, and capture this pose again"};
    }
    return std::nullopt;
}

std::optional<Finding> checkExposure(const std::string& view, const DecodedView& decoded,
                                     const std::vector<cv::Point2d>& board) {
    const cv::Mat1b mask = outlineMask(decoded.white.size(), board);
    const cv::Mat1b saturated = (decoded.white >= kSaturated) & mask;
    const double share = cv::countNonZero(saturated) / std::max(1.0, static_cast<double>(cv::countNonZero(mask)));
    if (share < kMostSaturated) return std::nullopt;
    return Finding{Cause::clipped, view, "",
                   std::to_string(static_cast<int>(std::lround(100.0 * share))) + " % of the board are overexposed",
                   "expose for less time until white is below 250 of 255"};
}

std::optional<Finding> checkLight(const std::string& view, const DecodedView& decoded) {
    constexpr int kLit = 20;             // grey levels
    constexpr double kMostClipped = 0.3; // of what is lit
    const int lit = cv::countNonZero(decoded.white - decoded.black > kLit);
    const double share = cv::countNonZero(decoded.white >= kSaturated) / std::max(1.0, static_cast<double>(lit));
    if (share < kMostClipped) return std::nullopt;
    return Finding{Cause::clipped, view, "",
                   std::to_string(static_cast<int>(std::lround(100.0 * share))) +
                       " % of what the projector lights are overexposed, so that the board cannot be found",
                   "expose for less time until white is below 250 of 255"};
}

std::optional<Finding> checkProjectorSize(const std::string& view, const DecodedView& decoded, cv::Size projector,
                                          const std::vector<cv::Point2d>& board) {
    const PictureEnd column = endOf(decoded.column, decoded.row, decoded.columnCell);
    const PictureEnd row = endOf(decoded.row, decoded.column, decoded.rowCell);
    const int width = projector.width;
    const int height = projector.height;
    const cv::Matx22d growth = growthOf(somePointsOf(decoded));
    // Nor is an end known to less than what a camera pixel covers and its blur.
    const double slack =
        std::max(kEndSlack * std::max(decoded.columnCell, decoded.rowCell),
                 kEndPixels * std::max(std::hypot(growth(0, 0), growth(0, 1)), std::hypot(growth(1, 0), growth(1, 1))));
    // A board before the dark, nothing lit beside it: the light then ends where the board does.
    const bool isBoardAlone = shareBeside(decoded, board) < kLeastBeside;
    const auto endsAt = [slack, isBoardAlone](const PictureEnd& end, int length) {
        return end.isSharp && !isBoardAlone && std::abs(end.last + 1.0 - length) < slack;
    };
    const auto isWrong = [&](const PictureEnd& end, int length) {
        return end.last > length - 0.4 || (end.isSharp && !isBoardAlone && end.last + 1.0 < length - slack);
    };
    if (!isWrong(column, width) && !isWrong(row, height)) return std::nullopt;
    const bool isMirror = cv::determinant(growth) < 0.0;
    if (isMirror && !isUpright(growth)) return exchangedAxes(view);
    if (isMirror && (column.last > width - 0.4 || row.last > height - 0.4))
        return Finding{Cause::inverseSwapped, view, "",
                       std::string("the coarsest pattern of the ") + (column.last > width - 0.4 ? "columns" : "rows") +
                           " and its inverse are exchanged",
                       "exchange the two images, or say so in an order file"};
    const bool fitsSwapped = !isWrong(column, height) && !isWrong(row, width);
    if (fitsSwapped &&
        (column.last > width - 0.4 || row.last > height - 0.4 || endsAt(column, height) || endsAt(row, width)))
        return Finding{Cause::widthHeightSwapped, view, "",
                       "the patterns are of a projector of " + std::to_string(height) + " x " + std::to_string(width) +
                           ", not " + std::to_string(width) + " x " + std::to_string(height),
                       "exchange width and height"};
    return Finding{Cause::projectorSize, view, "",
                   "the projector's picture reaches column " + std::to_string(std::lround(column.last)) + " and row " +
                       std::to_string(std::lround(row.last)) + ", which does not agree with " + std::to_string(width) +
                       " x " + std::to_string(height),
                   "give the size of the projector that the patterns were made for"};
}

std::optional<Finding> checkMirrored(const std::vector<ViewObservations>& views) {
    const auto isMirrored = [](const ViewObservations& view) {
        return cv::determinant(growthOf(view.projector)) < 0.0;
    };
    const auto first = std::ranges::find_if(views, isMirrored);
    if (first == views.end()) return std::nullopt;
    if (std::ranges::all_of(views, isMirrored) &&
        std::ranges::none_of(views, [](const ViewObservations& view) { return isUpright(growthOf(view.projector)); }))
        return exchangedAxes("");
    if (std::ranges::all_of(views, isMirrored))
        return Finding{Cause::mirrored, "", "", "camera and projector see all boards as mirror images of each other",
                       "switch off mirroring (rear projection) in projector and camera; check that the first pattern "
                       "comes before its inverse"};
    return Finding{Cause::mirrored, first->name, "", "the images of this pose are mirrored, others are not",
                   "capture this pose again with the camera's setting of the others"};
}

} // namespace lumorph
