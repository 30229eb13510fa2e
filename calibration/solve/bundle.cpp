#include "calibration/solve/bundle.h"

#include <algorithm>
#include <cmath>

#include "calibration/solve/projection.h"

namespace lumorph {

namespace {

constexpr double kFarOff = 1e3; // pixels: the error of a point that its ray misses

InstallationState installationOf(const BundleState& state) {
    InstallationState all;
    all.cameras = {{state.camera, {}}};
    all.projectors = {{state.projector, state.projectorFromCamera}};
    all.worldFromBody = state.cameraFromBoard;
    all.board = state.board;
    return all;
}

void addPoints(const ViewObservations& view, int body, double weight, std::vector<SeenPoint>& into) {
    for (std::size_t i = 0; i < view.corners.seen.size(); ++i)
        into.push_back({0, body, false, view.corners.board[i], view.corners.seen[i], weight});
}

/// At most so many, spread evenly, which count for all.
void addLights(const ViewObservations& view, int body, double weight, std::size_t most, std::vector<SeenLight>& into) {
    const std::size_t count = view.projector.size();
    const std::size_t used = std::min(count, most);
    const double each = std::min(weight * static_cast<double>(count) / std::max<double>(1.0, double(used)), 1.0);
    for (std::size_t i = 0; i < used; ++i) into.push_back({0, 0, body, false, view.projector[i * count / used], each});
}

InstallationObservations observationsOf(const std::vector<ViewObservations>& views, const ViewChoice& use,
                                        const BundleOptions& options) {
    InstallationObservations all;
    for (const int v : use) {
        const ViewObservations& view = views[static_cast<std::size_t>(v)];
        addPoints(view, v, std::min(options.independentCorners, 1.0), all.points);
        if (options.projectorPoints)
            addLights(view, v, options.independentPoints, static_cast<std::size_t>(options.most), all.lights);
    }
    return all;
}

InstallationNoise noiseOf(const BundleOptions& options) {
    InstallationNoise noise;
    noise.camera = options.cameraSigma;
    noise.projector = options.projectorSigma;
    return noise;
}

/// Places of a covariance of a camera and a projector among those of the installation.
std::vector<int> placesOf(const InstallationState& state) {
    const InstallationPlaces all(state);
    std::vector<int> places;
    const auto add = [&places](int first, int count) {
        for (int i = 0; i < count; ++i) places.push_back(first + i);
    };
    add(all.camera(0), kLensParameters);
    add(all.projector(0), InstallationPlaces::kOfDevice);
    add(all.board, kBoardParameters);
    add(all.bodies, all.count - all.bodies);
    return places;
}

/// Normal matrices at the places of a covariance of a camera and a projector.
InstallationNormals normalsOf(const std::vector<ViewObservations>& views, const ViewChoice& use,
                              const BundleOptions& options, const BundleState& state, Counts counts) {
    const InstallationState all = installationOf(state);
    const InstallationNormals normals =
        installationNormals(observationsOf(views, use, options), noiseOf(options), all, counts);
    const std::vector<int> places = placesOf(all);
    return {normals.points(places, places), normals.lights(places, places), {}};
}

/// Places of what may move.
std::vector<int> freePlaces(const ViewChoice& use, const BundleOptions& options) {
    std::vector<int> places;
    const auto add = [&places](const auto& mask, int first) {
        for (std::size_t i = 0; i < mask.size(); ++i)
            if (mask[i]) places.push_back(first + static_cast<int>(i));
    };
    add(options.camera, 0);
    if (options.projectorPoints) add(options.projector, kProjectorPlace);
    if (options.projectorPoints) add(std::vector<bool>(6, options.rig), kRigPlace);
    add(options.board, kBoardPlace);
    for (const int v : use) add(std::vector<bool>(6, options.poses), kPosePlace + 6 * v);
    return places;
}

/// Errors in pixels; of those that cannot be seen at all, as far off.
std::vector<cv::Point2d> allErrors(const std::vector<std::optional<cv::Point2d>>& found) {
    std::vector<cv::Point2d> errors;
    for (const auto& error : found) errors.push_back(error.value_or(cv::Point2d(kFarOff, 0.0)));
    return errors;
}

InstallationState withBoardAt(const BundleState& state, const PoseVector& cameraFromBoard) {
    InstallationState all = installationOf({state.camera, state.projector, state.projectorFromCamera, state.board, {}});
    all.worldFromBody = {cameraFromBoard};
    return all;
}

} // namespace

double refine(const std::vector<ViewObservations>& views, const ViewChoice& use, const BundleOptions& options,
              BundleState& state) {
    InstallationFree free;
    free.cameras = {{options.camera, false}};
    free.projectors = {{options.projector, options.rig}};
    free.bodies.assign(state.cameraFromBoard.size(), options.poses);
    free.board = options.board;
    InstallationState all = installationOf(state);
    const double cost = refineInstallation(observationsOf(views, use, options), free, noiseOf(options), all, 100);
    state = {all.cameras[0].lens, all.projectors[0].lens, all.projectors[0].fromWorld, all.board,
             std::move(all.worldFromBody)};
    return cost;
}

BundleCovariance covarianceOf(const std::vector<ViewObservations>& views, const ViewChoice& use,
                              const BundleOptions& options, const BundleState& state) {
    const InstallationNormals normals = normalsOf(views, use, options, state, Counts::asLossLets);
    const std::vector<int> places = freePlaces(use, options);
    const Eigen::MatrixXd corners = normals.points(places, places);
    const Eigen::MatrixXd points = normals.lights(places, places);
    const Eigen::MatrixXd inverse = inverseOfNormal(corners + points);
    BundleCovariance covariance;
    covariance.matrix = Eigen::MatrixXd::Zero(normals.points.rows(), normals.points.cols());
    covariance.matrix(places, places) = inverse;
    covariance.cameraFreedom = corners.cwiseProduct(inverse).sum();
    covariance.projectorFreedom = points.cwiseProduct(inverse).sum();
    return covariance;
}

Eigen::MatrixXd normalMatrixOf(const std::vector<ViewObservations>& views, const ViewChoice& use,
                               const BundleOptions& options, const BundleState& state) {
    const InstallationNormals normals = normalsOf(views, use, options, state, Counts::inFull);
    return normals.points + normals.lights;
}

Eigen::MatrixXd informationOf(const ViewObservations& view, const BundleOptions& options, const BundleState& state,
                              const PoseVector& cameraFromBoard) {
    BundleState alone = state;
    alone.cameraFromBoard = {cameraFromBoard};
    const Eigen::MatrixXd all = normalMatrixOf({view}, {0}, options, alone);
    const Eigen::MatrixXd mixed = all.bottomLeftCorner(6, kPosePlace);
    return all.topLeftCorner(kPosePlace, kPosePlace) -
           mixed.transpose() * inverseOfNormal(all.bottomRightCorner(6, 6)) * mixed;
}

std::vector<cv::Point2d> cameraErrors(const ViewObservations& view, const BundleState& state,
                                      const PoseVector& cameraFromBoard) {
    std::vector<SeenPoint> points;
    addPoints(view, 0, 1.0, points);
    return allErrors(errorsOf(points, withBoardAt(state, cameraFromBoard)));
}

std::vector<cv::Point2d> projectorErrors(const ViewObservations& view, const BundleState& state,
                                         const PoseVector& cameraFromBoard) {
    std::vector<SeenLight> lights;
    addLights(view, 0, 1.0, view.projector.size(), lights);
    return allErrors(errorsOf(lights, withBoardAt(state, cameraFromBoard)));
}

cv::Point3d pointOnBoard(const cv::Point2d& pixel, const Lens& camera, const PoseVector& cameraFromBoard,
                         const BoardShape& board) {
    const auto [x, y] = directionOfPixel(camera, pixel.x, pixel.y);
    const PoseMatrix pose(cameraFromBoard);
    const double depth = depthOfBoard(-pose.rotation.transpose() * pose.shift,
                                      pose.rotation.transpose() * Eigen::Vector3d(x, y, 1.0), board);
    return {depth * x, depth * y, depth};
}

cv::Point2d projectorPixel(const cv::Point3d& point, const BundleState& state) {
    const glm::dvec3 inProjector = Rigid::exp(state.projectorFromCamera) * glm::dvec3(point.x, point.y, point.z);
    double pixel[2];
    projectPoint(state.projector.data(), &inProjector.x, pixel);
    return {pixel[0], pixel[1]};
}

} // namespace lumorph
