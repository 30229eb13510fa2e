#pragma once

#include <vector>

#include <glm/vec2.hpp>

namespace lumorph::navigation {

/// Heights of the ground in levels of detail, immutable. Places are metres from the map's north-western corner: x to
/// the east, y to the south. Between samples heights are bilinear, and between levels they blend, so that nothing jumps
/// while one comes closer.
class HeightMap {
public:
    HeightMap() = default;
    /// `heights` in rows from west to east, the rows from north to south, metres. Throws InvalidInput for fewer than
    /// two samples a side, another number of heights, a spacing that is not above 0, and heights that are not finite.
    HeightMap(glm::ivec2 samples, double spacing, std::vector<float> heights);

    [[nodiscard]] glm::ivec2 samples() const noexcept { return levels_.front().samples; }
    [[nodiscard]] double spacing() const noexcept { return levels_.front().spacing; } ///< metres between samples
    [[nodiscard]] glm::dvec2 size() const noexcept;                                   ///< metres
    [[nodiscard]] const std::vector<float>& heights() const noexcept { return levels_.front().heights; }
    [[nodiscard]] float at(glm::ivec2 sample) const noexcept { return levels_.front().at(sample.x, sample.y); }

    /// As details of about `detail` metres and more show it; beyond the map as at its rim.
    [[nodiscard]] double at(const glm::dvec2& place, double detail) const noexcept;
    /// How it rises to the east and to the south there, metres a metre.
    [[nodiscard]] glm::dvec2 slopeAt(const glm::dvec2& place, double detail) const noexcept;

    [[nodiscard]] double lowest() const noexcept { return lowest_; }
    [[nodiscard]] double highest() const noexcept { return highest_; }

private:
    struct Level {
        glm::ivec2 samples{0};
        double spacing = 1.0;
        std::vector<float> heights;
        [[nodiscard]] float at(int x, int y) const noexcept {
            return heights[static_cast<std::size_t>(y) * static_cast<std::size_t>(samples.x) +
                           static_cast<std::size_t>(x)];
        }
        [[nodiscard]] double at(const glm::dvec2& place) const noexcept;
    };
    [[nodiscard]] static Level coarser(const Level& level);

    std::vector<Level> levels_{1};
    double lowest_ = 0.0, highest_ = 0.0;
};

} // namespace lumorph::navigation
