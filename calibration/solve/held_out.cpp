#include "calibration/solve/held_out.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

#include <Eigen/Core>

#include "calibration/solve/projection.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr const char* kTermNames[] = {"f", "aspect", "cx", "cy", "k1", "k2", "p1", "p2", "k3"};

constexpr std::size_t kTestPoints = 60; // of a view, for comparing halves
constexpr std::size_t kViewsForDistortion = 4;
constexpr double kAllowedSigmas = 3.0;

ViewChoice without(const ViewChoice& use, int view) {
    ViewChoice rest = use;
    std::erase(rest, view);
    return rest;
}

/// The view's pose, fitted to its corners under a camera that is held.
void fitPose(const std::vector<ViewObservations>& views, int view, BundleOptions options, BundleState& state) {
    options.camera = {};
    options.board = {};
    options.projectorPoints = false;
    refine(views, {view}, options, state);
}

/// A camera pixel and how deep it sees.
struct DeepPixel {
    cv::Point2d pixel;
    double depth = 0.0;
};

Eigen::Vector2d lightOf(const DeepPixel& seen, const BundleState& state) {
    const auto [x, y] = directionOfPixel(state.camera, seen.pixel.x, seen.pixel.y);
    const cv::Point2d pixel = projectorPixel({seen.depth * x, seen.depth * y, seen.depth}, state);
    return {pixel.x, pixel.y};
}

/// Mean variance of a pixel's light, both coordinates together, by lenses and rig in the order of `covarianceOf`.
double varianceOf(const std::vector<DeepPixel>& pixels, const BundleState& state,
                  const Eigen::Matrix<double, kBoardPlace, kBoardPlace>& covariance) {
    const PoseMatrix rig(state.projectorFromCamera);
    double sum = 0.0;
    for (const auto& [pixel, depth] : pixels) {
        const auto [x, y] = directionOfPixel(state.camera, pixel.x, pixel.y);
        const Eigen::Vector3d inCamera = depth * Eigen::Vector3d(x, y, 1.0);
        const Projected light = project(state.projector, rig * inCamera);
        const PixelByPoint byPoint = light.byPoint * rig.rotation;
        Eigen::Matrix<double, 2, kBoardPlace> slopes;
        slopes << depth * byPoint.leftCols<2>() * directionByLens(state.camera, pixel.x, pixel.y, x, y), light.byLens,
            -byPoint * crossOf(inCamera) * rig.turn, light.byPoint;
        sum += (slopes * covariance).cwiseProduct(slopes).sum();
    }
    return sum / static_cast<double>(pixels.size());
}

std::vector<DeepPixel> deepPixels(const std::vector<ViewObservations>& views, const ViewChoice& use,
                                  const BundleState& state) {
    std::vector<DeepPixel> pixels;
    for (const int v : use) {
        const auto& points = views[static_cast<std::size_t>(v)].projector;
        const std::size_t step = std::max<std::size_t>(1, points.size() / kTestPoints);
        for (std::size_t i = 0; i < points.size(); i += step)
            pixels.push_back(
                {points[i].camera, pointOnBoard(points[i].camera, state.camera,
                                                state.cameraFromBoard[static_cast<std::size_t>(v)], state.board)
                                       .z});
    }
    return pixels;
}

} // namespace

std::span<const std::vector<LensParameter>> lensTerms() {
    static const std::vector<LensParameter> kTerms[] = {{kK1}, {kK2}, {kP1, kP2}, {kAspect}, {kK3}};
    return kTerms;
}

std::string lensModelName(const LensMask& free) {
    std::string name;
    for (const auto& terms : lensTerms())
        for (const LensParameter term : terms)
            if (free[static_cast<std::size_t>(term)]) name += (name.empty() ? "" : " ") + std::string(kTermNames[term]);
    return name.empty() ? "pinhole" : name;
}

LensMask lensModelOf(const std::string& name) {
    LensMask free{};
    free[kFocalLength] = free[kPrincipalX] = free[kPrincipalY] = true;
    if (name == "pinhole") return free;
    std::istringstream words(name);
    for (std::string word; words >> word;) {
        const auto at = std::ranges::find(kTermNames, word);
        if (at == std::end(kTermNames))
            throw InvalidInput("lens model", "'" + word + "' is no term of it", "name some of k1 k2 p1 p2 aspect k3");
        free[static_cast<std::size_t>(at - std::begin(kTermNames))] = true;
    }
    return free;
}

std::vector<double> heldOutCorners(const std::vector<ViewObservations>& views, const ViewChoice& use,
                                   const BundleOptions& options, const BundleState& state) {
    std::vector<double> errors;
    BundleOptions alone = options;
    alone.projectorPoints = false;
    for (const int view : use) {
        BundleState rest = state;
        refine(views, without(use, view), alone, rest);
        fitPose(views, view, alone, rest);
        const auto v = static_cast<std::size_t>(view);
        errors.push_back(rmsOf(cameraErrors(views[v], rest, rest.cameraFromBoard[v])));
    }
    return errors;
}

std::vector<double> heldOutTransfers(const std::vector<ViewObservations>& views, const ViewChoice& use,
                                     const BundleOptions& options, const BundleState& state) {
    std::vector<double> errors;
    for (const int view : use) {
        BundleState rest = state;
        refine(views, without(use, view), options, rest);
        fitPose(views, view, options, rest);
        const auto v = static_cast<std::size_t>(view);
        errors.push_back(rmsOf(projectorErrors(views[v], rest, rest.cameraFromBoard[v])));
    }
    return errors;
}

HalvesComparison compareHalves(const std::vector<ViewObservations>& views, const ViewChoice& use,
                               const BundleOptions& options, const BundleState& state) {
    const std::vector<DeepPixel> pixels = deepPixels(views, use, state);
    std::vector<BundleState> halves;
    double variance = 0.0;
    for (std::size_t first : {0U, 1U}) {
        ViewChoice half;
        for (std::size_t i = first; i < use.size(); i += 2) half.push_back(use[i]);
        BundleOptions free = options;
        if (half.size() < kViewsForDistortion)
            for (LensMask* mask : {&free.camera, &free.projector})
                for (const int i : {kAspect, kK1, kK2, kP1, kP2, kK3}) (*mask)[static_cast<std::size_t>(i)] = false;
        BundleState solved = state;
        refine(views, half, free, solved);
        variance += varianceOf(
            pixels, solved, covarianceOf(views, half, free, solved).matrix.topLeftCorner<kBoardPlace, kBoardPlace>());
        halves.push_back(solved);
    }
    double sum = 0.0;
    for (const DeepPixel& pixel : pixels) sum += (lightOf(pixel, halves[0]) - lightOf(pixel, halves[1])).squaredNorm();
    return {std::sqrt(sum / static_cast<double>(pixels.size())), kAllowedSigmas * std::sqrt(variance)};
}

} // namespace lumorph
