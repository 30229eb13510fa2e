#include "calibration/solve/held_out.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace lumorph {

namespace {

constexpr LensMask freeUpTo(int extras) {
    constexpr int kOrder[] = {kK1, kK2, kP1, kP2, kAspect, kK3};
    LensMask mask{};
    mask[kFocalLength] = mask[kPrincipalX] = mask[kPrincipalY] = true;
    for (int i = 0; i < extras; ++i) mask[static_cast<std::size_t>(kOrder[i])] = true;
    return mask;
}

constexpr LensModel kLensModels[] = {{"pinhole", freeUpTo(0)},
                                     {"k1", freeUpTo(1)},
                                     {"k1 k2", freeUpTo(2)},
                                     {"k1 k2 p1 p2", freeUpTo(4)},
                                     {"k1 k2 p1 p2 aspect", freeUpTo(5)},
                                     {"k1 k2 p1 p2 aspect k3", freeUpTo(6)}};

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

/// Numbers of a state as one vector, in the order of `covarianceOf`.
Eigen::Matrix<double, 24, 1> vectorOf(const BundleState& state) {
    Eigen::Matrix<double, 24, 1> all;
    for (int i = 0; i < kLensParameters; ++i) {
        all[i] = state.camera[static_cast<std::size_t>(i)];
        all[kLensParameters + i] = state.projector[static_cast<std::size_t>(i)];
    }
    for (int i = 0; i < 6; ++i) all[2 * kLensParameters + i] = state.projectorFromCamera[static_cast<std::size_t>(i)];
    return all;
}

BundleState stateOf(const Eigen::Matrix<double, 24, 1>& all) {
    BundleState state;
    for (int i = 0; i < kLensParameters; ++i) {
        state.camera[static_cast<std::size_t>(i)] = all[i];
        state.projector[static_cast<std::size_t>(i)] = all[kLensParameters + i];
    }
    for (int i = 0; i < 6; ++i) state.projectorFromCamera[static_cast<std::size_t>(i)] = all[2 * kLensParameters + i];
    return state;
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

/// Mean variance of a pixel's light, both coordinates together.
double varianceOf(const std::vector<DeepPixel>& pixels, const BundleState& state,
                  const Eigen::Matrix<double, 24, 24>& covariance) {
    const Eigen::Matrix<double, 24, 1> here = vectorOf(state);
    Eigen::MatrixXd slopes(2 * static_cast<Eigen::Index>(pixels.size()), 24);
    for (int p = 0; p < 24; ++p) {
        const double step = std::max(1e-3 * std::sqrt(covariance(p, p)), 1e-9 * std::max(1.0, std::abs(here[p])));
        Eigen::Matrix<double, 24, 1> up = here;
        Eigen::Matrix<double, 24, 1> down = here;
        up[p] += step;
        down[p] -= step;
        const BundleState above = stateOf(up);
        const BundleState below = stateOf(down);
        for (std::size_t i = 0; i < pixels.size(); ++i)
            slopes.block<2, 1>(2 * static_cast<Eigen::Index>(i), p) =
                (lightOf(pixels[i], above) - lightOf(pixels[i], below)) / (2.0 * step);
    }
    const double sum = (slopes * covariance).cwiseProduct(slopes).sum();
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

std::span<const LensModel> lensModels() { return kLensModels; }

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
        variance += varianceOf(pixels, solved, covarianceOf(views, half, free, solved).matrix.topLeftCorner<24, 24>());
        halves.push_back(solved);
    }
    double sum = 0.0;
    for (const DeepPixel& pixel : pixels) sum += (lightOf(pixel, halves[0]) - lightOf(pixel, halves[1])).squaredNorm();
    return {std::sqrt(sum / static_cast<double>(pixels.size())), kAllowedSigmas * std::sqrt(variance)};
}

} // namespace lumorph
