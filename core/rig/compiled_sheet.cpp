#include "core/rig/compiled_sheet.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <utility>

#include <glm/geometric.hpp>

namespace lumorph {
namespace {

// GCC does not find this form of the sums by itself; it makes them three times as fast.
constexpr std::size_t kLanes = 4;
using Lanes [[gnu::vector_size(kLanes * sizeof(float))]] = float;

Lanes lanesAt(const float* values) noexcept {
    Lanes lanes;
    std::memcpy(&lanes, values, sizeof lanes);
    return lanes;
}

float total(const Lanes& sum) noexcept { return (sum[0] + sum[2]) + (sum[1] + sum[3]); }

} // namespace

CompiledSheet::CompiledSheet(const SheetMotion& motion, std::span<const Actuator> actuators)
    : motion_(motion), actuatorOfAxis_(motion.modes.strokes.size()) {
    for (std::size_t a = 0; a < actuators.size(); ++a)
        if (const auto* lift = std::get_if<SheetLift>(&actuators[a].deformer))
            actuatorOfAxis_[static_cast<std::size_t>(lift->axis)] = static_cast<std::uint16_t>(a);
    const std::size_t count = motion.modes.modeCount;
    padded_ = (count + kLanes - 1) / kLanes * kLanes;
    modes_.resize(motion.modes.rowCount() * 3 * padded_, 0.0F);
    for (std::size_t row = 0; row < motion.modes.rowCount(); ++row)
        for (std::size_t k = 0; k < count; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis)
                modes_[(3 * row + axis) * padded_ + k] =
                    motion.modes.modes[row * count + k][static_cast<glm::length_t>(axis)];
    std::vector<std::uint32_t> axes(motion.modes.rowCount());
    for (std::uint32_t row = 0; row < axes.size(); ++row) axes[row] = axesThatMove(row);
    std::map<std::pair<float, std::uint32_t>, std::uint16_t> known;
    for (const SheetMotion::Follower& follower : motion.followers) {
        const std::uint32_t moving = follower.row == SheetMotion::kNoRow ? 0 : axes[follower.row];
        pathOf_.push_back(kNoPath);
        if (moving == 0) continue;
        const auto next = static_cast<std::uint16_t>(paths_.size());
        const auto [at, isNew] = known.try_emplace({follower.share, moving}, next);
        if (isNew) paths_.push_back({follower.share, moving});
        pathOf_.back() = at->second;
    }
}

std::uint32_t CompiledSheet::axesThatMove(std::uint32_t row) const {
    const SheetModes& modes = motion_.modes;
    std::vector<glm::vec3> places(modes.stateCount());
    std::array<float, SheetModes::kMostModes> coefficients{};
    for (std::size_t state = 0; state < places.size(); ++state) {
        std::copy_n(modes.coefficients.data() + state * modes.modeCount, modes.modeCount, coefficients.data());
        places[state] = displacement(row, coefficients.data());
    }
    std::uint32_t axes = 0;
    std::size_t stride = 1;
    for (std::size_t axis = modes.strokes.size(); axis-- > 0;) {
        const std::size_t nodes = modes.strokes[axis].size();
        for (std::size_t state = 0; state < places.size() && (axes >> axis & 1U) == 0; ++state) {
            const std::size_t atRest = state - (state / stride) % nodes * stride;
            if (glm::distance(places[state], places[atRest]) > kSheetStill) axes |= 1U << axis;
        }
        stride *= nodes;
    }
    return axes;
}

void CompiledSheet::evaluate(std::uint16_t path, std::span<const double> strokes,
                             PathCoefficients& out) const noexcept {
    const auto [share, axes] = paths_[path];
    std::array<double, SheetModes::kMostActuators> along{};
    out.still = true;
    for (std::size_t axis = 0; axis < actuatorOfAxis_.size(); ++axis) {
        if ((axes >> axis & 1U) == 0) continue;
        along[axis] = static_cast<double>(share) * strokes[actuatorOfAxis_[axis]];
        out.still = out.still && along[axis] == 0.0;
    }
    if (out.still) return;
    modeCoefficients(motion_.modes, {along.data(), actuatorOfAxis_.size()}, out.values);
    std::fill(out.values.begin() + static_cast<std::ptrdiff_t>(motion_.modes.modeCount),
              out.values.begin() + static_cast<std::ptrdiff_t>(padded_), 0.0F);
}

glm::vec3 CompiledSheet::displacement(std::uint32_t row, const float* coefficients) const noexcept {
    const float* const x = modes_.data() + 3 * row * padded_;
    const float* const y = x + padded_;
    const float* const z = y + padded_;
    Lanes sumX{}, sumY{}, sumZ{};
    for (std::size_t k = 0; k < padded_; k += kLanes) {
        const Lanes c = lanesAt(coefficients + k);
        sumX += c * lanesAt(x + k);
        sumY += c * lanesAt(y + k);
        sumZ += c * lanesAt(z + k);
    }
    return {total(sumX), total(sumY), total(sumZ)};
}

} // namespace lumorph
