#include "calibration/light/light_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>
#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include "calibration/decode/refusal.h"

namespace lumorph::light {

namespace {

constexpr std::size_t kFewestPatches = 8;
constexpr double kLeastWhite = 0.1;    // of the light that is there anyway
constexpr double kMostFall = 0.004;    // of white: a response that falls by more is not noise
constexpr double kStraightening = 2.2; // light to this root is nearly straight over the values
constexpr int kCurveSteps = 64;
constexpr int kRounds = 5;        // of weights against patches that something else lies on
constexpr double kOutlier = 0.03; // ln of the light

const char* const kChannelNames[] = {"red", "green", "blue"};

/// Of the light of one channel at full value.
std::optional<double> whiteOf(const ProjectorShots& shots, const CameraResponses& responses, std::size_t patch,
                              int camera, int channel) {
    return lightBeyond(shots.ramp.back()[static_cast<std::size_t>(channel)], &shots.dark, responses, patch, camera);
}

/// Light over all patches that the projector lights, above its black, by value; and how many those are.
std::pair<std::vector<double>, std::size_t> summedRamp(const ProjectorShots& shots, std::span<const LightPatch> patches,
                                                       const CameraResponses& responses, int channel) {
    std::vector<double> sums(shots.values.size(), 0.0);
    std::size_t count = 0;
    for (std::size_t i = 0; i < patches.size(); ++i) {
        if (!(patches[i].shares[shots.projector] > 0.0)) continue;
        std::vector<double> light;
        for (const auto& shown : shots.ramp)
            if (const auto beyond =
                    lightBeyond(shown[static_cast<std::size_t>(channel)], &shots.dark, responses, i, channel))
                light.push_back(*beyond);
        if (light.size() != sums.size()) continue;
        ++count;
        std::ranges::transform(sums, light, sums.begin(), std::plus{});
    }
    return {sums, count};
}

/// All light that is there while the projectors show black, over the same patches.
double darkLight(const ProjectorShots& shots, std::span<const LightPatch> patches, const CameraResponses& responses,
                 int channel) {
    double sum = 0.0;
    for (std::size_t i = 0; i < patches.size(); ++i)
        if (patches[i].shares[shots.projector] > 0.0)
            sum += lightBeyond(shots.dark, nullptr, responses, i, channel).value_or(0.0);
    return sum;
}

constexpr double kLeastColour = 1e-6; // determinant of what the channels see, of its largest

/// A black falls into all channels of the camera, so they are solved for together.
glm::dvec3 blacksOf(const ProjectorShots& shots, std::span<const LightPatch> patches,
                    const CameraResponses& responses) {
    glm::dmat3 whites(0.0);
    glm::dvec3 blacks(0.0);
    for (std::size_t i = 0; i < patches.size(); ++i) {
        if (!(patches[i].shares[shots.projector] > 0.0)) continue;
        for (int camera = 0; camera < 3; ++camera) {
            const auto black = lightBeyond(shots.dark, &shots.covered, responses, i, camera);
            if (!black) continue;
            blacks[camera] += *black;
            for (int channel = 0; channel < 3; ++channel)
                whites[channel][camera] += whiteOf(shots, responses, i, camera, channel).value_or(0.0);
        }
    }
    // A camera without colour tells no channel's black from another's: all get the same share.
    const double size = glm::length(whites[0]) * glm::length(whites[1]) * glm::length(whites[2]);
    const bool isGrey = !(std::abs(glm::determinant(whites)) > kLeastColour * size);
    const double all = whites[0][0] + whites[1][0] + whites[2][0];
    const glm::dvec3 byWhite = isGrey ? glm::dvec3(std::max(0.0, blacks[0] / std::max(all, 1e-12)))
                                      : glm::max(glm::inverse(whites) * blacks, glm::dvec3(0.0));
    return byWhite / (1.0 + byWhite);
}

/// Slopes of a cubic through points that never turns where they do not (Fritsch and Carlson, 1980).
std::vector<double> monotoneSlopes(std::span<const double> x, std::span<const double> y) {
    const std::size_t n = x.size();
    std::vector<double> steps(n - 1), slopes(n);
    for (std::size_t k = 0; k + 1 < n; ++k) steps[k] = (y[k + 1] - y[k]) / (x[k + 1] - x[k]);
    slopes.front() = steps.front();
    slopes.back() = steps.back();
    for (std::size_t k = 1; k + 1 < n; ++k) {
        const double wide = x[k + 1] - x[k], before = x[k] - x[k - 1];
        if (steps[k - 1] * steps[k] <= 0.0) continue;
        const double a = 2.0 * wide + before, b = wide + 2.0 * before;
        slopes[k] = (a + b) / (a / steps[k - 1] + b / steps[k]);
    }
    return slopes;
}

double onCubic(std::span<const double> x, std::span<const double> y, std::span<const double> slopes, double at) {
    const auto above = std::ranges::upper_bound(x, at);
    const auto k = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - x.begin(), 1, std::ssize(x) - 1)) - 1;
    const double wide = x[k + 1] - x[k], t = (at - x[k]) / wide;
    const double t2 = t * t, t3 = t2 * t;
    return (2.0 * t3 - 3.0 * t2 + 1.0) * y[k] + (t3 - 2.0 * t2 + t) * wide * slopes[k] +
           (-2.0 * t3 + 3.0 * t2) * y[k + 1] + (t3 - t2) * wide * slopes[k + 1];
}

/// One measurement of white.
struct WhiteRow {
    std::size_t projector, surface;
    double radius, log; ///< log: ln of the light by what the room's geometry says of it
};

std::vector<WhiteRow> rowsOf(std::span<const ProjectorShots> shots, std::span<const LightPatch> patches,
                             const CameraResponses& responses, int channel) {
    std::vector<WhiteRow> rows;
    for (const ProjectorShots& shot : shots)
        for (std::size_t i = 0; i < patches.size(); ++i) {
            const double share = patches[i].shares[shot.projector];
            if (!(share > 0.0)) continue;
            const auto white = whiteOf(shot, responses, i, channel, channel);
            if (white && *white > 0.0)
                rows.push_back({shot.projector, static_cast<std::size_t>(patches[i].surface), patches[i].radius,
                                std::log(*white / share)});
        }
    return rows;
}

} // namespace

std::array<ChannelLight, 3> channelsOf(const ProjectorShots& shots, std::span<const LightPatch> patches,
                                       const CameraResponses& responses, const std::string& name) {
    std::array<ChannelLight, 3> channels;
    for (int channel = 0; channel < 3; ++channel) {
        const auto [sums, count] = summedRamp(shots, patches, responses, channel);
        if (count < kFewestPatches)
            throw CaptureRefused({Cause::surfaceUnseen,
                                  name,
                                  {},
                                  "the camera sees hardly anything that it lights without being cut off",
                                  "turn camera or projector so that it lights more of what the camera sees"});
        const double white = sums.back();
        if (!(white > kLeastWhite * darkLight(shots, patches, responses, channel)))
            throw CaptureRefused(
                {Cause::lightTooDark,
                 name,
                 {},
                 std::string("full ") + kChannelNames[channel] + " hardly shows above the light of the room",
                 "darken the room, and see that the projector is on"});
        ChannelLight& light = channels[static_cast<std::size_t>(channel)];
        double before = 0.0;
        for (std::size_t k = 0; k < sums.size(); ++k) {
            const double now = sums[k] / white;
            if (now < before - kMostFall)
                throw CaptureRefused({Cause::responseNotRising,
                                      name,
                                      {},
                                      std::string("a higher value of ") + kChannelNames[channel] +
                                          " makes less light, near " +
                                          std::to_string(std::lround(255.0 * shots.values[k])) + " of 255",
                                      "switch off its dynamic contrast, its dynamic lamp and its picture modes"});
            before = std::clamp(now, before, 1.0);
            light.above.push_back(before);
        }
        light.above.back() = 1.0;
    }
    const glm::dvec3 blacks = blacksOf(shots, patches, responses);
    for (int channel = 0; channel < 3; ++channel) channels[static_cast<std::size_t>(channel)].black = blacks[channel];
    return channels;
}

std::vector<InstalledProjector::ResponsePoint> curveOf(std::span<const double> values,
                                                       const std::array<ChannelLight, 3>& channels) {
    std::vector<double> x{0.0};
    x.insert(x.end(), values.begin(), values.end());
    std::vector<InstalledProjector::ResponsePoint> curve(kCurveSteps + 1);
    for (int channel = 0; channel < 3; ++channel) {
        std::vector<double> y{0.0};
        for (const double light : channels[static_cast<std::size_t>(channel)].above)
            y.push_back(std::pow(light, 1.0 / kStraightening));
        const std::vector<double> slopes = monotoneSlopes(x, y);
        for (int k = 0; k <= kCurveSteps; ++k) {
            const double value = static_cast<double>(k) / kCurveSteps;
            const double root = std::clamp(onCubic(x, y, slopes, value), 0.0, 1.0);
            auto& point = curve[static_cast<std::size_t>(k)];
            point.value = value;
            point.light[channel] = static_cast<float>(std::pow(root, kStraightening));
        }
        curve.front().light[channel] = 0.0F;
        curve.back().light[channel] = 1.0F;
    }
    return curve;
}

double WhiteFit::fadingOf(const LightPatch& patch, int channel) const {
    const double square = patch.radius * patch.radius;
    const glm::dvec2& by = fading[static_cast<std::size_t>(channel)];
    return std::exp(by.x * square + by.y * square * square);
}

WhiteFit fitWhites(std::span<const ProjectorShots> shots, std::span<const LightPatch> patches,
                   const CameraResponses& responses, std::size_t projectors) {
    WhiteFit fit;
    fit.gains.assign(projectors, glm::dvec3(0.0));
    fit.albedo.fill(glm::dvec3(0.0));
    for (int channel = 0; channel < 3; ++channel) {
        const std::vector<WhiteRow> rows = rowsOf(shots, patches, responses, channel);
        // Only products of gain and albedo are seen, so the first surface that was seen is 1.
        std::array<Eigen::Index, kLightSurfaces> columns;
        columns.fill(-1);
        Eigen::Index next = static_cast<Eigen::Index>(projectors) + 2;
        std::size_t first = kLightSurfaces;
        for (const WhiteRow& row : rows) first = std::min(first, row.surface);
        for (const WhiteRow& row : rows)
            if (row.surface != first && columns[row.surface] < 0) columns[row.surface] = next++;
        Eigen::MatrixXd design = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()), next);
        Eigen::VectorXd wanted(static_cast<Eigen::Index>(rows.size()));
        for (Eigen::Index i = 0; i < wanted.size(); ++i) {
            const WhiteRow& row = rows[static_cast<std::size_t>(i)];
            const double square = row.radius * row.radius;
            design(i, static_cast<Eigen::Index>(row.projector)) = 1.0;
            design(i, static_cast<Eigen::Index>(projectors)) = square;
            design(i, static_cast<Eigen::Index>(projectors) + 1) = square * square;
            if (columns[row.surface] >= 0) design(i, columns[row.surface]) = 1.0;
            wanted(i) = row.log;
        }
        Eigen::VectorXd weights = Eigen::VectorXd::Ones(wanted.size()), found;
        for (int round = 0; round < kRounds; ++round) {
            const Eigen::VectorXd roots = weights.cwiseSqrt();
            // Columns of projectors that are off are zero; the least solution leaves them so.
            found = (roots.asDiagonal() * design).completeOrthogonalDecomposition().solve(roots.cwiseProduct(wanted));
            const Eigen::VectorXd off = (wanted - design * found).cwiseAbs();
            for (Eigen::Index i = 0; i < off.size(); ++i) weights(i) = std::min(1.0, kOutlier / std::max(off(i), 1e-9));
        }
        for (const ProjectorShots& shot : shots)
            fit.gains[shot.projector][channel] = std::exp(found(static_cast<Eigen::Index>(shot.projector)));
        fit.fading[static_cast<std::size_t>(channel)] = {found(static_cast<Eigen::Index>(projectors)),
                                                         found(static_cast<Eigen::Index>(projectors) + 1)};
        for (std::size_t s = 0; s < kLightSurfaces; ++s)
            if (s == first || columns[s] >= 0) fit.albedo[s][channel] = s == first ? 1.0 : std::exp(found(columns[s]));
    }
    return fit;
}

glm::dmat3 mixingOf(std::span<const ProjectorShots> shots, std::span<const LightPatch> patches,
                    const CameraResponses& responses) {
    glm::dmat3 mixing(0.0);
    for (int channel = 0; channel < 3; ++channel) {
        glm::dvec3 sums(0.0);
        for (const ProjectorShots& shot : shots)
            for (std::size_t i = 0; i < patches.size(); ++i) {
                if (!(patches[i].shares[shot.projector] > 0.0)) continue;
                for (int camera = 0; camera < 3; ++camera)
                    sums[camera] += whiteOf(shot, responses, i, camera, channel).value_or(0.0);
            }
        mixing[channel] = sums / sums[channel]; // a column
    }
    return mixing;
}

} // namespace lumorph::light
