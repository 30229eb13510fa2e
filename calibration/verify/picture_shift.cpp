#include "calibration/verify/picture_shift.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Dense>
#include <opencv2/imgproc.hpp>

namespace lumorph {

namespace {

constexpr float kAlone = 0.93F;       // of the light of a cell that one projector gives
constexpr double kBent = 0.35;        // camera pixels by which a cell's places may differ from a plane's
constexpr int kFarthest = 6;          // pixels that content is looked for
constexpr double kFewestLevels = 2.0; // grey levels of contrast below which nothing can be told
constexpr double kExplains = 0.6;     // of the variance
constexpr double kNear = 1.0;         // pixels within which least squares alone is right
constexpr double kSharedNoise = 12.0; // soft pixels share their noise with their neighbours
constexpr double kSurest = 0.12;      // pixels: nothing is told better than that

/// The affine map from camera to panel pixels, least squares; nothing where the cell is not smooth.
bool fitPlane(const cv::Mat2f& panel, WatchCell& cell) {
    Eigen::Matrix<double, 3, 3> normal = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
    for (int y = cell.place.y; y < cell.place.br().y; ++y)
        for (int x = cell.place.x; x < cell.place.br().x; ++x) {
            const Eigen::Vector3d at(x - cell.middle.x, y - cell.middle.y, 1.0);
            const cv::Vec2f p = panel(y, x);
            normal += at * at.transpose();
            right += at * Eigen::RowVector2d(p[0], p[1]);
        }
    const Eigen::Matrix<double, 3, 2> map = normal.ldlt().solve(right);
    cell.panel = map.row(2).transpose();
    cell.panelByPixel = map.topRows<2>().transpose();
    if (!(std::abs(cell.panelByPixel.determinant()) > 1e-6)) return false;
    const Eigen::Matrix2d back = cell.panelByPixel.inverse();
    for (int y = cell.place.y; y < cell.place.br().y; ++y)
        for (int x = cell.place.x; x < cell.place.br().x; ++x) {
            const Eigen::Vector3d at(x - cell.middle.x, y - cell.middle.y, 1.0);
            const Eigen::Vector2d is(panel(y, x)[0], panel(y, x)[1]);
            if ((back * (is - map.transpose() * at)).norm() > kBent) return false;
        }
    return true;
}

/// The projector that lights all of a cell nearly alone, on one surface.
std::optional<std::size_t> lampOf(const ShowSight& sight, const cv::Rect& place) {
    const int surface = sight.surface(place.tl());
    if (surface < 0 || cv::countNonZero(sight.surface(place) == surface) != place.area()) return std::nullopt;
    double all = 0.0;
    for (const cv::Mat1f& share : sight.share) all += cv::sum(share(place))[0];
    for (std::size_t i = 0; i < sight.share.size(); ++i) {
        const cv::Mat1f share = sight.share[i](place);
        if (cv::sum(share)[0] < static_cast<double>(kAlone) * all || cv::countNonZero(share) != place.area()) continue;
        return i;
    }
    return std::nullopt;
}

/// The whole-pixel shift at which the cell looks most alike, near ones first.
cv::Point coarseShift(const cv::Mat1f& predicted, const cv::Mat1f& seen, const cv::Rect& cell) {
    const cv::Rect search(cell.x - kFarthest, cell.y - kFarthest, cell.width + 2 * kFarthest,
                          cell.height + 2 * kFarthest);
    cv::Mat1f alike;
    cv::matchTemplate(seen(search), predicted(cell), alike, cv::TM_CCOEFF_NORMED);
    float best = -2.0F;
    cv::Point shift;
    for (int y = 0; y < alike.rows; ++y)
        for (int x = 0; x < alike.cols; ++x) {
            const cv::Point at(x - kFarthest, y - kFarthest);
            const float score = alike(y, x) - 0.01F * static_cast<float>(cv::norm(at));
            if (score <= best) continue;
            best = score;
            shift = at;
        }
    return shift;
}

/// Least squares around a whole-pixel shift.
CellShift fineShift(const cv::Mat1f& predicted, const cv::Mat1f& seen, const cv::Rect& cell, cv::Point from,
                    double usualGain) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    double squares = 0.0, sum = 0.0;
    for (int y = cell.y; y < cell.br().y; ++y)
        for (int x = cell.x; x < cell.br().x; ++x) {
            const double dx = 0.5 * static_cast<double>(predicted(y, x + 1) - predicted(y, x - 1));
            const double dy = 0.5 * static_cast<double>(predicted(y + 1, x) - predicted(y - 1, x));
            const Eigen::Vector4d row(-dx, -dy, predicted(y, x), 1.0);
            const double value = seen(y + from.y, x + from.x);
            normal += row * row.transpose();
            right += value * row;
            squares += value * value;
            sum += value;
        }
    CellShift shift;
    const double count = cell.area();
    const double meanLight = normal(2, 3) / count;
    const double contrast = std::sqrt(std::max(0.0, normal(2, 2) / count - meanLight * meanLight));
    const double variance = std::max(0.0, squares / count - (sum / count) * (sum / count));
    normal(3, 3) += 1e-9;
    const Eigen::Vector4d found = normal.ldlt().solve(right);
    const double left = std::max(1e-3, (squares - found.dot(right)) / (count - 4.0));
    shift.gain = found[2];
    if (!(contrast > 0.0) || (usualGain > 0.0 && usualGain * contrast < kFewestLevels)) return shift;
    const double explained = 1.0 - left / std::max(1e-9, variance);
    const bool isAlike = variance > 0.0 && explained > kExplains && found[2] > 0.0;
    if (!isAlike) {
        shift.kind = CellShift::Kind::unlike;
        return shift;
    }
    if (found[2] * contrast < kFewestLevels) return shift;
    // What shift alone explains, brightness and offset being free as well.
    const Eigen::Matrix2d cross = normal.topLeftCorner<2, 2>() - normal.topRightCorner<2, 2>() *
                                                                     normal.bottomRightCorner<2, 2>().inverse() *
                                                                     normal.bottomLeftCorner<2, 2>();
    shift.shift = found.head<2>() / found[2] + Eigen::Vector2d(from.x, from.y);
    const Eigen::Matrix2d information = found[2] * found[2] * cross / (kSharedNoise * left);
    const Eigen::Matrix2d covariance =
        (information + 1e-6 * Eigen::Matrix2d::Identity()).inverse() + kSurest * kSurest * Eigen::Matrix2d::Identity();
    shift.information = covariance.inverse();
    shift.kind = CellShift::Kind::measured;
    return shift;
}

/// What brightness and offset leave of a square; and how much of it varies at all.
std::pair<double, double> leftAndVariance(const cv::Mat1f& predicted, const cv::Mat1f& seen) {
    const double count = static_cast<double>(seen.total());
    const double light = cv::mean(predicted)[0], grey = cv::mean(seen)[0];
    const double lights = predicted.dot(predicted) - count * light * light;
    const double greys = seen.dot(seen) - count * grey * grey;
    const double both = predicted.dot(seen) - count * light * grey;
    if (!(lights > 1e-12) || both <= 0.0) return {greys, greys};
    return {greys - both * both / lights, greys};
}

} // namespace

Rivalry rivalryOf(const cv::Mat1f& first, const cv::Mat1f& second, const cv::Mat1f& seen, double usualGain) {
    constexpr int kSide = 16;
    constexpr double kDiffers = 5.0; // grey levels
    Rivalry rivalry;
    for (int y = 0; y + kSide <= seen.rows; y += kSide)
        for (int x = 0; x + kSide <= seen.cols; x += kSide) {
            const cv::Rect place(x, y, kSide, kSide);
            if (usualGain * cv::norm(first(place), second(place), cv::NORM_INF) < kDiffers) continue;
            const auto [leftOfFirst, variance] = leftAndVariance(first(place).clone(), seen(place).clone());
            const double leftOfSecond = leftAndVariance(second(place).clone(), seen(place).clone()).first;
            if (std::min(leftOfFirst, leftOfSecond) > (1.0 - kExplains) * variance) continue;
            rivalry.first += leftOfFirst;
            rivalry.second += leftOfSecond;
            ++rivalry.squares;
        }
    return rivalry;
}

std::vector<WatchCell> cellsOf(const ShowSight& sight, int size, int step) {
    std::vector<WatchCell> cells;
    const int edge = kFarthest + 1;
    for (int y = edge; y + size + edge < sight.surface.rows; y += step)
        for (int x = edge; x + size + edge < sight.surface.cols; x += step) {
            WatchCell cell;
            cell.place = {x, y, size, size};
            const std::optional<std::size_t> lamp = lampOf(sight, cell.place);
            if (!lamp) continue;
            cell.projector = *lamp;
            cell.middle = {x + 0.5 * (size - 1), y + 0.5 * (size - 1)};
            if (fitPlane(sight.panel[*lamp], cell)) cells.push_back(cell);
        }
    return cells;
}

CellShift shiftOf(const cv::Mat1f& predicted, const cv::Mat1f& seen, const cv::Rect& cell, double usualGain) {
    const CellShift near = fineShift(predicted, seen, cell, {0, 0}, usualGain);
    if (near.kind == CellShift::Kind::empty) return near;
    if (near.kind == CellShift::Kind::measured && near.shift.norm() < kNear) return near;
    const cv::Point from = coarseShift(predicted, seen, cell);
    CellShift far = fineShift(predicted, seen, cell, from, usualGain);
    const bool isNear =
        far.kind == CellShift::Kind::measured && (far.shift - Eigen::Vector2d(from.x, from.y)).norm() < 1.5 * kNear;
    if (!isNear) far.kind = CellShift::Kind::unlike;
    return far;
}

} // namespace lumorph
