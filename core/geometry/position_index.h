#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

namespace lumorph {

/// Numbers distinct positions from 0 in the order they come. Positions are the same when their
/// coordinates are exactly equal (0 and -0 are).
class PositionIndex {
public:
    /// Number of the position, and whether it is new. Positions must not hold NaN.
    std::pair<std::uint32_t, bool> insert(const glm::vec3& position);

    [[nodiscard]] std::size_t size() const noexcept { return positions_.size(); }

private:
    void grow();
    /// The slot where the position is, or would go.
    [[nodiscard]] std::size_t slotOf(const glm::vec3& position) const noexcept;

    std::vector<glm::vec3> positions_;
    std::vector<std::uint32_t> slots_; ///< open addressing; a power of two, at most half full
};

/// For every position the number of its place: equal positions have equal numbers. All that
/// are not finite share one.
[[nodiscard]] std::vector<std::uint32_t> placesOf(std::span<const glm::vec3> positions);

} // namespace lumorph
