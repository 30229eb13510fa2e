#include "calibration/light/camera_response.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "calibration/decode/refusal.h"

namespace lumorph {

namespace {

constexpr int kKnots = 32;
constexpr double kFirstKnot = 14.0, kLastKnot = 246.0; // bytes
constexpr double kNeutralByte = 128.0;                 // by which a channel's light is counted
constexpr double kStiffness = 1.0;                     // of the curve, against one byte's word
constexpr std::size_t kFewestBytes = 60;
constexpr double kLeastSlope = 0.12;  // ln of the byte by ln of the exposure: no camera's gamma is above 8
constexpr double kMostScatter = 0.05; // of the light: exposures that contradict each other

/// Where a byte lies among the knots.
double knotOf(double byte) {
    const double step = std::log(kLastKnot / kFirstKnot) / (kKnots - 1);
    return std::log(byte / kFirstKnot) / step;
}

struct KnotWeights {
    int first = 0;
    double second = 0.0; ///< share of the next knot
};

/// Beyond the ends on the line of the outermost two.
KnotWeights weightsOf(double byte) {
    const double at = knotOf(byte);
    const int first = std::clamp(static_cast<int>(std::floor(at)), 0, kKnots - 2);
    return {first, at - first};
}

bool isTrusted(double byte) { return byte >= kDarkestByte && byte <= kBrightestByte; }

/// How much brighter pictures become with longer exposures: the slope of logarithms, over all places.
double brightening(std::span<const ExposedByte> seen) {
    struct Sums {
        double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    };
    std::map<std::size_t, Sums> places;
    for (const ExposedByte& one : seen) {
        if (!isTrusted(one.byte)) continue;
        Sums& sums = places[one.place];
        const double x = std::log(one.seconds), y = std::log(one.byte);
        sums.n += 1.0;
        sums.x += x;
        sums.y += y;
        sums.xx += x * x;
        sums.xy += x * y;
    }
    double along = 0.0, together = 0.0;
    for (const auto& [place, sums] : places) {
        along += sums.xx - sums.x * sums.x / sums.n;
        together += sums.xy - sums.x * sums.y / sums.n;
    }
    return along > 0.0 ? together / along : 0.0;
}

[[noreturn]] void refuseAdjusting(const std::string& why) {
    throw CaptureRefused({Cause::cameraAdjusts,
                          "camera",
                          {},
                          why,
                          "switch off its automatic exposure, gain and white balance, and set them by hand"});
}

} // namespace

double CameraResponse::lightOf(double byte) const {
    if (!(byte > 0.0) || logLight_.size() != kKnots) return 0.0;
    const KnotWeights at = weightsOf(byte);
    const auto first = static_cast<std::size_t>(at.first);
    return std::exp((1.0 - at.second) * logLight_[first] + at.second * logLight_[first + 1]);
}

CameraResponse estimateCameraResponse(std::span<const ExposedByte> seen) {
    std::size_t places = 0, trusted = 0;
    for (const ExposedByte& one : seen) {
        places = std::max(places, one.place + 1);
        trusted += isTrusted(one.byte) ? 1 : 0;
    }
    if (trusted < kFewestBytes)
        throw CaptureRefused({Cause::lightTooDark,
                              "camera",
                              {},
                              "hardly any place is neither black nor cut off at any exposure",
                              "let the camera see more of what the projector lights"});
    if (brightening(seen) < kLeastSlope)
        refuseAdjusting("longer exposures do not make brighter pictures: the camera evens them out by itself");
    const auto size = static_cast<Eigen::Index>(kKnots + places);
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    const auto add = [&](std::span<const std::pair<Eigen::Index, double>> row, double wanted, double weight) {
        for (const auto& [i, a] : row) {
            right(i) += weight * a * wanted;
            for (const auto& [j, b] : row) normal(i, j) += weight * a * b;
        }
    };
    const auto weightOf = [](double byte) { return byte / kNeutralByte * byte / kNeutralByte; };
    for (const ExposedByte& one : seen) {
        if (!isTrusted(one.byte)) continue;
        const KnotWeights at = weightsOf(one.byte);
        const std::array<std::pair<Eigen::Index, double>, 3> row{
            {{at.first, 1.0 - at.second},
             {at.first + 1, at.second},
             {static_cast<Eigen::Index>(kKnots + one.place), -1.0}}};
        add(row, std::log(one.seconds), weightOf(one.byte));
    }
    for (Eigen::Index k = 1; k + 1 < kKnots; ++k)
        add(std::array<std::pair<Eigen::Index, double>, 3>{{{k - 1, 1.0}, {k, -2.0}, {k + 1, 1.0}}}, 0.0, kStiffness);
    const KnotWeights neutral = weightsOf(kNeutralByte);
    add(std::array<std::pair<Eigen::Index, double>, 2>{{{neutral.first, 1.0 - neutral.second},
                                                        {neutral.first + 1, neutral.second}}},
        0.0, 1e6);
    for (Eigen::Index i = 0; i < size; ++i) normal(i, i) += 1e-9; // a place that was never seen well
    const Eigen::VectorXd found = normal.ldlt().solve(right);
    double squares = 0.0, weights = 0.0;
    for (const ExposedByte& one : seen) {
        if (!isTrusted(one.byte)) continue;
        const KnotWeights at = weightsOf(one.byte);
        const double off = (1.0 - at.second) * found(at.first) + at.second * found(at.first + 1) -
                           found(static_cast<Eigen::Index>(kKnots + one.place)) - std::log(one.seconds);
        squares += weightOf(one.byte) * off * off;
        weights += weightOf(one.byte);
    }
    const double rms = std::sqrt(squares / weights);
    if (!(rms < kMostScatter))
        refuseAdjusting("its exposures contradict each other by " + std::to_string(std::lround(100.0 * rms)) +
                        " % of the light");
    return {std::vector<double>(found.data(), found.data() + kKnots), rms};
}

} // namespace lumorph
