#include "calibration/doctor/view_check.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "calibration/doctor/phase_check.h"
#include "calibration/doctor/uneven_light.h"

namespace lumorph {

namespace {

constexpr double kMostMotion = 0.5;       // camera pixels
constexpr double kFaint = 0.3;            // of the coarsest stripes' contrast
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

/// How far each of the board's points moved from where they are.
std::vector<cv::Point2d> motionsOf(const cv::Mat& image, const std::vector<cv::Point2d>& board, double reach) {
    std::vector<cv::Point2f> points(board.begin(), board.end());
    const int room = std::clamp(static_cast<int>(reach), 3, 12);
    cv::cornerSubPix(image, points, {room, room}, {-1, -1},
                     {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 0.01});
    std::vector<cv::Point2d> motions;
    for (std::size_t i = 0; i < points.size(); ++i) motions.push_back(cv::Point2d(points[i]) - board[i]);
    return motions;
}

cv::Point2d medianOfPoints(const std::vector<cv::Point2d>& points) {
    std::vector<double> x, y;
    for (const cv::Point2d& point : points) {
        x.push_back(point.x);
        y.push_back(point.y);
    }
    return {medianOfNumbers(x), medianOfNumbers(y)};
}

/// Whether points moved as one board does: most by the same, or by a turn.
bool areOneMotion(const std::vector<cv::Point2d>& motions, const std::vector<cv::Point2d>& board) {
    std::vector<cv::Point2f> from(board.begin(), board.end());
    std::vector<cv::Point2f> to;
    for (std::size_t i = 0; i < board.size(); ++i) to.emplace_back(board[i] + motions[i]);
    constexpr double kReach = 0.6, kMost = 0.6; // pixels, share of the points
    std::vector<uchar> agree;
    if (cv::estimateAffinePartial2D(from, to, agree, cv::RANSAC, kReach).empty()) return false;
    return static_cast<double>(std::ranges::count(agree, 1)) > kMost * static_cast<double>(board.size());
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
                                       const CaptureOrder& order, const cv::Mat1b& white,
                                       const std::vector<cv::Point2d>& board) {
    double reach = 30.0;
    for (std::size_t i = 0; i + 1 < board.size(); ++i) reach = std::min(reach, 0.4 * cv::norm(board[i] - board[i + 1]));
    const std::vector<EvenlyLit> lit = evenlyLit(images, order);
    const cv::Mat1b mask = outlineMask(images.front().size(), board);
    std::vector<std::vector<cv::Point2d>> motions;
    std::vector<bool> isOther;
    for (const EvenlyLit& light : lit) {
        cv::Mat1b grey;
        light.image.convertTo(grey, CV_8U);
        motions.push_back(motionsOf(grey, board, reach));
        isOther.push_back(correlationOf(light.image, white, mask) < kLeastCorrelation);
    }
    const auto fileOf = [&view](int image) { return view.files[static_cast<std::size_t>(image)].filename().string(); };
    const auto moved = [&](std::size_t i) {
        return Finding{Cause::rigMoved, view.name, fileOf(lit[i].firstImage),
                       "camera or board moved: from about this image on the board is elsewhere in the picture",
                       "fix both, touch nothing while patterns are shown, and capture this pose again"};
    };
    // White, in which the board was found, against all others.
    if (std::ranges::all_of(isOther, [](bool other) { return other; }) && !lit.empty()) {
        const int image =
            static_cast<int>(std::ranges::find(order.images, PatternImage(FlatField{true})) - order.images.begin());
        return Finding{Cause::foreignImage, view.name, fileOf(std::min(image, static_cast<int>(view.files.size()) - 1)),
                       "white shows the board elsewhere than all patterns do",
                       "put the right image there, or capture this pose again"};
    }
    for (std::size_t i = 1; i < motions.size(); ++i) {
        std::vector<cv::Point2d> since = motions[i];
        for (std::size_t k = 0; k < since.size(); ++k) since[k] -= motions.front()[k];
        if (isOther[i] == isOther[0] && (isOther[i] || cv::norm(medianOfPoints(since)) <= kMostMotion)) continue;
        if (!isOther[i] && !isOther[0] && areOneMotion(since, board)) return moved(i);
        if (auto cause = causeInImages(view, images, order)) return cause;
        return moved(i);
    }
    constexpr double kMostByWhite = 2.0 * kMostMotion; // corners are found in another way there
    if (!lit.empty() && cv::norm(medianOfPoints(motions.front())) > kMostByWhite) return moved(lit.size() - 1);
    return std::nullopt;
}

namespace {

/// The largest chessboard of at least so many inner corners; nothing where there is none, or where it may go on past
/// the picture.
std::optional<cv::Size> largestChessboard(const cv::Mat1b& white, cv::Size least) {
    std::vector<cv::Point2f> corners;
    cv::Mat meta;
    try {
        if (!cv::findChessboardCornersSB(white, least, corners, cv::CALIB_CB_LARGER | cv::CALIB_CB_NORMALIZE_IMAGE,
                                         meta))
            return std::nullopt;
    } catch (const cv::Exception&) { // pictures that are too small for it
        return std::nullopt;
    }
    const cv::Size size = meta.size();
    if (size.area() != static_cast<int>(corners.size()) || size.width < 2 || size.height < 2) return std::nullopt;
    // Two squares beyond each corner of it.
    const auto at = [&](int column, int row) {
        return corners[static_cast<std::size_t>(row) * static_cast<std::size_t>(size.width) +
                       static_cast<std::size_t>(column)];
    };
    const cv::Rect2f picture(0.0F, 0.0F, static_cast<float>(white.cols), static_cast<float>(white.rows));
    for (const int column : {0, size.width - 1})
        for (const int row : {0, size.height - 1}) {
            const int inColumn = column == 0 ? 1 : column - 1;
            const int inRow = row == 0 ? 1 : row - 1;
            const cv::Point2f out = 2.0F * (2.0F * at(column, row) - at(inColumn, row) - at(column, inRow));
            if (!picture.contains(at(column, row) + 0.75F * out)) return std::nullopt;
        }
    return size;
}

} // namespace

std::optional<Finding> checkBoardSize(const std::string& view, const cv::Mat1b& white, const CalibrationBoard& board,
                                      bool found) {
    if (board.kind != CalibrationBoard::Kind::chess) return std::nullopt;
    constexpr int kFewest = 3;
    const cv::Size said(board.columns, board.rows);
    const auto seen = largestChessboard(white, found ? said : cv::Size(kFewest, kFewest));
    if (!seen || *seen == said || *seen == cv::Size(said.height, said.width)) return std::nullopt;
    if (found && seen->area() <= said.area()) return std::nullopt;
    const std::string words = std::to_string(seen->width) + " x " + std::to_string(seen->height);
    const std::string saidWords =
        " inner corners, not " + std::to_string(said.width) + " x " + std::to_string(said.height);
    return Finding{Cause::boardSize, view, "",
                   found ? "the board has " + words + saidWords
                         : "only " + words + saidWords + ", are seen: it has fewer, or a part of it is dark or covered",
                   "give the number of inner corners that the board has: one fewer than squares, both ways"};
}

std::optional<Finding> checkSharpness(const std::string& view, const cv::Mat1b& white, const BoardPoints& found) {
    constexpr double kMostBlur = 2.5;   // standard deviation, pixels; sound captures have 0.7 to 1.5
    constexpr double kLeastStep = 12.0; // grey levels
    const auto greyAt = [&white](cv::Point2d at) {
        cv::Mat1f patch;
        cv::getRectSubPix(white, {1, 1}, cv::Point2f(at), patch, CV_32F);
        return static_cast<double>(patch(0, 0));
    };
    std::vector<double> blurs;
    for (std::size_t i = 0; i + 1 < found.seen.size(); ++i) {
        if (found.board[i].y != found.board[i + 1].y) continue; // the next row begins
        // Two corners of a square: the edge runs from one to the other, and is crossed in its middle.
        const cv::Point2d along = found.seen[i + 1] - found.seen[i];
        const double length = cv::norm(along);
        if (length < 8.0) continue;
        const cv::Point2d across(-along.y / length, along.x / length);
        const cv::Point2d middle = 0.5 * (found.seen[i] + found.seen[i + 1]);
        const double reach = 0.4 * length;
        const double low = greyAt(middle - reach * across);
        const double step = greyAt(middle + reach * across) - low;
        if (std::abs(step) < kLeastStep) continue;
        double first = reach;
        double last = -reach;
        for (double t = -reach; t <= reach; t += 0.25) {
            const double share = (greyAt(middle + t * across) - low) / step;
            if (share > 0.25) first = std::min(first, t);
            if (share < 0.75) last = std::max(last, t);
        }
        blurs.push_back(std::max(0.0, last - first) / 1.35); // between the quartiles of a normal distribution
    }
    constexpr std::size_t kFewestEdges = 8;
    if (blurs.size() < kFewestEdges) return std::nullopt;
    const double blur = medianOfNumbers(blurs);
    if (blur < kMostBlur) return std::nullopt;
    return Finding{Cause::outOfFocus, view, "",
                   "edges of the board are blurred over " + std::to_string(std::lround(3.0 * blur)) + " pixels",
                   "focus camera and projector on the board, and hold it still"};
}

std::optional<Finding> checkFocus(const std::string& view, const DecodedView& decoded,
                                  const std::vector<cv::Mat>& images, const CaptureOrder& order) {
    constexpr double kWide = 4.5; // camera pixels of a stripe that any camera resolves
    const cv::Matx22d growth = growthOf(somePointsOf(decoded));
    for (const bool columns : {true, false}) {
        const int row = columns ? 0 : 1;
        const double pixels = std::hypot(growth(row, 0), growth(row, 1)); // of the projector a camera pixel
        if (!(pixels > 0.0) || !std::isfinite(pixels)) continue;
        const double lost = 0.5 * (columns ? decoded.columnCell : decoded.rowCell) / pixels;
        const double length = columns ? order.projector.width : order.projector.height;
        const auto phases = fineContrast(images, order, columns ? PatternAxis::columns : PatternAxis::rows);
        const bool isBlurred = phases ? phases->contrast < kFaint && 0.5 * length / phases->periods / pixels > kWide
                                      : (columns ? decoded.columnCell : decoded.rowCell) > 1 && lost > kWide;
        if (isBlurred)
            return Finding{Cause::outOfFocus, view, "",
                           "stripes are blurred away that are several pixels wide in the camera's picture",
                           "focus camera and projector on the board, and hold it still"};
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
                       " % of what the projector lights are overexposed, so that the board is lost",
                   "expose for less time until white is below 250 of 255"};
}

namespace {

/// How much the projector's light adds to what it lights well, grey levels.
double lightIn(const DecodedView& decoded) {
    std::vector<int> light;
    for (int y = 0; y < decoded.white.rows; y += 4)
        for (int x = 0; x < decoded.white.cols; x += 4) light.push_back(decoded.white(y, x) - decoded.black(y, x));
    const auto bright = light.begin() + static_cast<std::ptrdiff_t>(light.size() * 95 / 100);
    std::ranges::nth_element(light, bright);
    return *bright;
}

} // namespace

std::optional<Finding> checkDark(const std::string& view, const DecodedView& decoded) {
    constexpr double kFewestGreys = 10.0;
    const double light = lightIn(decoded);
    if (light >= kFewestGreys) return std::nullopt;
    return Finding{Cause::underexposed, view, "",
                   "the projector's light makes " + std::to_string(std::lround(light)) + " of 255 greys",
                   "expose for longer, open the aperture, darken the room"};
}

std::optional<Finding> checkNoise(const std::string& view, const DecodedView& decoded) {
    constexpr double kLeastNoise = 4.0, kMostNoise = 0.05; // grey levels, of the light
    const double light = lightIn(decoded);
    if (decoded.noise < std::max(kLeastNoise, kMostNoise * light)) return std::nullopt;
    return Finding{Cause::noisy, view, "",
                   "the pictures have a noise of " + std::to_string(std::lround(decoded.noise)) +
                       " grey levels, where light makes " + std::to_string(std::lround(light)),
                   "expose for longer with less gain, bring more light onto the board"};
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

namespace {

bool isTurnedOver(const ViewObservations& view) {
    const cv::Matx22d growth = growthOf(view.projector);
    return growth(0, 0) < 0.0 && growth(1, 1) < 0.0 && isUpright(growth);
}

bool isRightSideUp(const ViewObservations& view) {
    const cv::Matx22d growth = growthOf(view.projector);
    return growth(0, 0) > 0.0 && growth(1, 1) > 0.0 && isUpright(growth);
}

} // namespace

std::optional<Finding> checkTurned(const std::vector<ViewObservations>& views) {
    const auto count = std::ranges::count_if(views, isTurnedOver);
    const bool mostAre = 2 * count > std::ssize(views);
    const auto isOdd = mostAre ? isRightSideUp : isTurnedOver;
    const auto odd = std::ranges::find_if(views, isOdd);
    // Of a rig that is rolled some poses are neither.
    if (odd == views.end() || std::ranges::none_of(views, mostAre ? isTurnedOver : isRightSideUp)) return std::nullopt;
    return Finding{Cause::phaseOrder, odd->name, "",
                   "the projector's picture is upside down in this pose and not in others: steps of its phases are "
                   "exchanged",
                   "put the images into the order of the steps, or capture this pose again"};
}

bool isUpsideDown(const std::vector<ViewObservations>& views) { return std::ranges::all_of(views, isTurnedOver); }

} // namespace lumorph
