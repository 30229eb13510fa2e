#include "core/geometry/position_index.h"

#include <bit>
#include <cmath>
#include <limits>

namespace lumorph {
namespace {

constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();

std::uint64_t hashOf(const glm::vec3& p) noexcept {
    // Adding zero makes -0 a plain 0.
    std::uint64_t hash = std::bit_cast<std::uint32_t>(p.x + 0.0F);
    for (const float value : {p.y, p.z}) {
        hash = (hash ^ (hash >> 29U)) * 0x9E3779B97F4A7C15ULL;
        hash ^= std::bit_cast<std::uint32_t>(value + 0.0F);
    }
    hash = (hash ^ (hash >> 32U)) * 0xD6E8FEB86659FD93ULL;
    return hash ^ (hash >> 32U);
}

} // namespace

std::pair<std::uint32_t, bool> PositionIndex::insert(const glm::vec3& position) {
    if (2 * (positions_.size() + 1) > slots_.size()) grow();
    const std::size_t slot = slotOf(position);
    if (slots_[slot] != kFree) return {slots_[slot], false};
    slots_[slot] = static_cast<std::uint32_t>(positions_.size());
    positions_.push_back(position);
    return {slots_[slot], true};
}

void PositionIndex::grow() {
    slots_.assign(slots_.empty() ? 64 : 2 * slots_.size(), kFree);
    for (std::size_t i = 0; i < positions_.size(); ++i) slots_[slotOf(positions_[i])] = static_cast<std::uint32_t>(i);
}

std::size_t PositionIndex::slotOf(const glm::vec3& position) const noexcept {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hashOf(position) & mask;
    while (slots_[slot] != kFree && positions_[slots_[slot]] != position) slot = (slot + 1) & mask;
    return slot;
}

std::vector<std::uint32_t> placesOf(std::span<const glm::vec3> positions) {
    PositionIndex index;
    std::vector<std::uint32_t> places;
    places.reserve(positions.size());
    // NaN equals nothing, not even itself: every position that is not finite is the same nowhere.
    for (const glm::vec3& p : positions) {
        const bool finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
        places.push_back(index.insert(finite ? p : glm::vec3(std::numeric_limits<float>::infinity())).first);
    }
    return places;
}

} // namespace lumorph
