#include "calibration/solve/sight.h"

#include <algorithm>

#include <Eigen/Dense>

namespace lumorph {

namespace {

constexpr double kNearest = 1e-9; // a point nearer than that, or behind, is not seen

/// A board's height over its plane, its slope, and how it moves with the terms.
struct Height {
    double value = 0.0;
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    Eigen::Matrix<double, 7, 1> byTerm;
};

Height heightOf(const BoardShape& board, double x, double y) {
    const double u = (x - board.middle.x) / board.half;
    const double v = (y - board.middle.y) / board.half;
    Height height;
    height.byTerm << u * u, u * v, v * v, u * u * u, u * u * v, u * v * v, v * v * v;
    const Eigen::Map<const Eigen::Matrix<double, 7, 1>> terms(board.terms.data());
    height.value = terms.dot(height.byTerm);
    Eigen::Matrix<double, 7, 2> slopes;
    slopes << 2.0 * u, 0.0, v, u, 0.0, 2.0 * v, 3.0 * u * u, 0.0, 2.0 * u * v, u * u, v * v, 2.0 * u * v, 0.0,
        3.0 * v * v;
    height.slope = slopes.transpose() * terms / board.half;
    return height;
}

bool isFlat(const BoardShape& board) {
    return std::all_of(board.terms.begin(), board.terms.begin() + kBoardStretch, [](double t) { return t == 0.0; });
}

} // namespace

BoardShape flatBoard(const std::vector<ViewObservations>& views) {
    cv::Point2d low(1e300, 1e300);
    cv::Point2d high = -low;
    for (const ViewObservations& view : views)
        for (const cv::Point3d& point : view.corners.board) {
            low = {std::min(low.x, point.x), std::min(low.y, point.y)};
            high = {std::max(high.x, point.x), std::max(high.y, point.y)};
        }
    BoardShape board;
    if (!(low.x < high.x)) return board;
    board.middle = 0.5 * (low + high);
    board.half = 0.5 * std::max(high.x - low.x, high.y - low.y);
    return board;
}

cv::Point3d onBoard(const BoardShape& board, const cv::Point3d& printed) {
    const double x = printed.x + board.terms[kBoardStretch] * (printed.x - board.middle.x);
    if (isFlat(board)) return {x, printed.y, printed.z};
    return {x, printed.y, printed.z + heightOf(board, x, printed.y).value};
}

double depthOfBoard(const Eigen::Vector3d& from, const Eigen::Vector3d& way, const BoardShape& board) {
    constexpr int kNewtonSteps = 4;
    double depth = -from.z() / way.z();
    if (isFlat(board)) return depth;
    for (int step = 0; step < kNewtonSteps; ++step) {
        const Eigen::Vector3d at = from + depth * way;
        const Height height = heightOf(board, at.x(), at.y());
        depth -= (at.z() - height.value) / (way.z() - height.slope.dot(way.head<2>()));
    }
    return depth;
}

Eigen::Vector3d Sight::mirrored(const Eigen::Vector3d& place) const {
    return place - 2.0 * (mirror.dot(place) / mirror.squaredNorm() - 1.0) * mirror;
}

Eigen::Matrix3d Sight::reflection() const {
    return Eigen::Matrix3d::Identity() - 2.0 / mirror.squaredNorm() * mirror * mirror.transpose();
}

/// How the mirror image of a place moves with the mirror.
Eigen::Matrix3d Sight::mirroredByMirror(const Eigen::Vector3d& place) const {
    const double square = mirror.squaredNorm();
    const double share = mirror.dot(place) / square;
    return -2.0 *
           (mirror * (place - 2.0 * share * mirror).transpose() / square + (share - 1.0) * Eigen::Matrix3d::Identity());
}

bool Sight::error(const SeenPoint& seen, Eigen::Vector2d& error, SightSlopes* slopes) const {
    const cv::Point3d placed = onBoard(board, seen.point);
    const Eigen::Vector3d point(placed.x, placed.y, placed.z);
    const Eigen::Vector3d inWorld = body * point;
    const Eigen::Vector3d shown = seen.mirrored ? mirrored(inWorld) : inWorld;
    const Eigen::Vector3d inCamera = camera * shown;
    if (inCamera.z() < kNearest) return false;
    const Projected projected = project(lens, inCamera);
    error = projected.pixel - Eigen::Vector2d(seen.pixel.x, seen.pixel.y);
    if (!slopes || !error.allFinite()) return error.allFinite();
    slopes->setZero();
    const PixelByPoint byShown = projected.byPoint * camera.rotation;
    const PixelByPoint byWorld = seen.mirrored ? PixelByPoint(byShown * reflection()) : byShown;
    const PixelByPoint byBody = byWorld * body.rotation;
    slopes->middleCols<kLensParameters>(kLensColumn) = projected.byLens;
    slopes->middleCols<3>(kCameraColumn) = -byShown * crossOf(shown) * camera.turn;
    slopes->middleCols<3>(kCameraColumn + 3) = projected.byPoint;
    slopes->middleCols<3>(kBodyColumn) = -byBody * crossOf(point) * body.turn;
    slopes->middleCols<3>(kBodyColumn + 3) = byWorld;
    const Height height = heightOf(board, point.x(), point.y());
    slopes->middleCols<7>(kBoardColumn) = byBody.col(2) * height.byTerm.transpose();
    const Eigen::Vector3d stretch(1.0, 0.0, height.slope.x());
    slopes->col(kStretchColumn) = byBody * stretch * (seen.point.x - board.middle.x);
    if (seen.mirrored) slopes->middleCols<3>(kMirrorColumn) = byShown * mirroredByMirror(inWorld);
    return true;
}

bool Sight::error(const SeenLight& seen, Eigen::Vector2d& error, SightSlopes* slopes) const {
    const auto [x, y] = directionOfPixel(lens, seen.pixels.camera.x, seen.pixels.camera.y);
    const Eigen::Vector3d direction(x, y, 1.0);
    Eigen::Vector3d ray = camera.rotation.transpose() * direction;
    Eigen::Vector3d from = -camera.rotation.transpose() * camera.shift;
    const Eigen::Vector3d shownRay = ray, shownFrom = from; // as the camera sees it, behind the mirror
    if (seen.mirrored) {
        ray = reflection() * ray;
        from = mirrored(from);
    }
    // The surface, in the body's frame.
    const Eigen::Vector3d start = body.rotation.transpose() * (from - body.shift);
    const Eigen::Vector3d way = body.rotation.transpose() * ray;
    Eigen::Vector3d upward = Eigen::Vector3d::UnitZ();
    double depth = 0.0;
    if (seen.plane) {
        upward = {seen.plane->normal[0], seen.plane->normal[1], seen.plane->normal[2]};
        depth = (seen.plane->distance - upward.dot(start)) / upward.dot(way);
    } else {
        depth = depthOfBoard(start, way, board);
    }
    if (!(depth > kNearest)) return false;
    const Eigen::Vector3d inWorld = from + depth * ray;
    const Eigen::Vector3d inProjector = projector * inWorld;
    if (!(inProjector.z() > kNearest)) return false;
    const Projected projected = project(projectorLens, inProjector);
    error = projected.pixel - Eigen::Vector2d(seen.pixels.projector.x, seen.pixels.projector.y);
    if (!slopes || !error.allFinite()) return error.allFinite();
    slopes->setZero();
    const Eigen::Vector3d inBody = start + depth * way;
    Eigen::Matrix<double, 7, 1> byTerm = Eigen::Matrix<double, 7, 1>::Zero();
    if (!seen.plane) {
        const Height height = heightOf(board, inBody.x(), inBody.y());
        upward = {-height.slope.x(), -height.slope.y(), 1.0};
        byTerm = height.byTerm;
    }
    // The point moves along its ray by what the body moves through it, and with the ray.
    const Eigen::Vector3d normal = body.rotation * upward;
    const PixelByPoint byPoint = projected.byPoint * projector.rotation;
    const Eigen::Vector2d alongRay = byPoint * ray / normal.dot(ray);
    const PixelByPoint byRay = byPoint - alongRay * normal.transpose();
    const PixelByPoint byShown = seen.mirrored ? PixelByPoint(byRay * reflection()) : byRay;
    const PixelByPoint inCamera = byShown * camera.rotation.transpose();
    const Eigen::Vector3d shown = shownFrom + depth * shownRay;
    slopes->middleCols<kLensParameters>(kLensColumn) =
        depth * inCamera.leftCols<2>() * directionByLens(lens, seen.pixels.camera.x, seen.pixels.camera.y, x, y);
    slopes->middleCols<3>(kCameraColumn) = byShown * crossOf(shown) * camera.turn;
    slopes->middleCols<3>(kCameraColumn + 3) = -inCamera;
    slopes->middleCols<3>(kBodyColumn) = -alongRay * upward.cross(inBody).transpose() * body.turn;
    slopes->middleCols<3>(kBodyColumn + 3) = alongRay * normal.transpose();
    slopes->middleCols<7>(kBoardColumn) = alongRay * byTerm.transpose();
    if (seen.mirrored) slopes->middleCols<3>(kMirrorColumn) = byRay * mirroredByMirror(shown);
    slopes->middleCols<kLensParameters>(kProjectorLensColumn) = projected.byLens;
    slopes->middleCols<3>(kProjectorColumn) = -byPoint * crossOf(inWorld) * projector.turn;
    slopes->middleCols<3>(kProjectorColumn + 3) = projected.byPoint;
    return true;
}

} // namespace lumorph
