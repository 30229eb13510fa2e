#include "app/applications/ice/swell.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>

#include "app/applications/demo_items.h"
#include "app/applications/ice/pond_bed.h"

namespace lumorph::ice {
namespace {

constexpr int kColumns = 43, kRows = 31; ///< 5 mm apart
constexpr int kTaps = 6;                 ///< samples to either side
constexpr double kWidth = 2.6;           ///< of the bell by which mounds are broad, samples
constexpr double kFollows = 0.9;         ///< seconds: a mound comes up slowly, as servos do
constexpr double kRoom = 1.6;            ///< mounds fade where the device rises less than 1 / kRoom of its most
constexpr double kLarge = 450e-6;        ///< square metres of a floe that is lifted whole

std::array<float, 2 * kTaps + 1> bell() {
    std::array<float, 2 * kTaps + 1> weights{};
    float sum = 0.0F;
    for (int k = -kTaps; k <= kTaps; ++k)
        sum += weights[static_cast<std::size_t>(k + kTaps)] =
            static_cast<float>(std::exp(-0.5 * k * k / (kWidth * kWidth)));
    for (float& weight : weights) weight /= sum;
    return weights;
}

constexpr glm::dvec2 kSamples{kColumns - 1, kRows - 1};

glm::dvec2 samplePlace(int column, int row) {
    return -kPondHalf + 2.0 * kPondHalf * glm::dvec2(column, row) / kSamples;
}

/// Columns and rows between the first sample and a place.
glm::dvec2 samplesFromCorner(const glm::dvec2& place) { return (place + kPondHalf) / (2.0 * kPondHalf) * kSamples; }

} // namespace

Swell::Swell() {
    heights_ = {-kPondHalf, kPondHalf, kColumns, kRows, std::vector<float>(std::size_t{kColumns} * kRows, kSheet)};
    wanted_.assign(heights_.heights.size(), 0.0F);
    across_ = wanted_;
}

void Swell::advance(const IceCover& ice, const Bending& device, double seconds) {
    std::ranges::fill(wanted_, 0.0F);
    for (const Floe& floe : ice.floes()) {
        if (floe.fixed || ice.freezing()) continue;
        const double size = std::min(1.0, floe.area / kLarge);
        addFloe(ice, floe, kMost * size);
    }
    smooth();
    const auto follows = static_cast<float>(1.0 - std::exp(-std::clamp(seconds, 0.0, 1.0) / kFollows));
    for (std::size_t k = 0; k < wanted_.size(); ++k) {
        const int column = static_cast<int>(k) % kColumns, row = static_cast<int>(k) / kColumns;
        wanted_[k] *= static_cast<float>(std::min(1.0, kRoom * device.roomAt(samplePlace(column, row))));
        heights_.heights[k] += follows * (kSheet + wanted_[k] - heights_.heights[k]);
    }
}

void Swell::addFloe(const IceCover& ice, const Floe& floe, double lift) {
    for (const int cell : floe.cells) {
        Polygon outline = ice.sheet().cells()[static_cast<std::size_t>(cell)].outline;
        for (glm::dvec2& corner : outline) corner = placed(floe.motion.placement, corner);
        if (!outline.empty()) addCell(outline, lift);
    }
}

void Swell::addCell(const Polygon& outline, double lift) {
    glm::dvec2 min(outline.front()), max(min);
    for (const glm::dvec2& corner : outline) {
        min = glm::min(min, corner);
        max = glm::max(max, corner);
    }
    const glm::ivec2 first(glm::ceil(samplesFromCorner(min))), last(glm::floor(samplesFromCorner(max)));
    for (int row = std::max(first.y, 0); row <= std::min(last.y, kRows - 1); ++row)
        for (int column = std::max(first.x, 0); column <= std::min(last.x, kColumns - 1); ++column)
            if (holds(outline, samplePlace(column, row)))
                wanted_[static_cast<std::size_t>(row * kColumns + column)] = static_cast<float>(lift);
}

/// A bell along rows and columns; beyond the rim it goes on as at the rim.
void Swell::smooth() {
    static const auto weights = bell();
    const auto pass = [](const std::vector<float>& in, std::vector<float>& out, glm::ivec2 step) {
        for (int j = 0; j < kRows; ++j)
            for (int i = 0; i < kColumns; ++i) {
                float sum = 0.0F;
                for (int k = -kTaps; k <= kTaps; ++k) {
                    const int x = std::clamp(i + k * step.x, 0, kColumns - 1),
                              y = std::clamp(j + k * step.y, 0, kRows - 1);
                    sum +=
                        weights[static_cast<std::size_t>(k + kTaps)] * in[static_cast<std::size_t>(y * kColumns + x)];
                }
                out[static_cast<std::size_t>(j * kColumns + i)] = sum;
            }
    };
    pass(wanted_, across_, {1, 0});
    pass(across_, wanted_, {0, 1});
}

WaterLevel Swell::at(const glm::dvec2& place) const noexcept {
    constexpr double kArm = 0.008;
    const auto height = [&](const glm::dvec2& at) {
        const glm::dvec2 inside = glm::clamp(at, heights_.min, heights_.max - 1e-6);
        return lumorph::heightAt(heights_, inside) - static_cast<double>(kSheet);
    };
    const double x = height(place + glm::dvec2(kArm, 0.0)) - height(place - glm::dvec2(kArm, 0.0));
    const double z = height(place + glm::dvec2(0.0, kArm)) - height(place - glm::dvec2(0.0, kArm));
    return {height(place), glm::dvec2(x, z) / (2.0 * kArm)};
}

} // namespace lumorph::ice
