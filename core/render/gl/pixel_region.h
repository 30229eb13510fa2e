#pragma once

#include <array>
#include <vector>

#include <glm/vec2.hpp>

namespace lumorph {

/// Pixels of an image, as OpenGL counts them: row 0 is the lowest, `high` is not included.
struct PixelRectangle {
    glm::ivec2 low{0};
    glm::ivec2 high{0};
    [[nodiscard]] bool empty() const noexcept { return low.x >= high.x || low.y >= high.y; }
    [[nodiscard]] double size() const noexcept { return empty() ? 0.0 : 1.0 * (high.x - low.x) * (high.y - low.y); }
};

/// The smallest rectangle that holds both.
[[nodiscard]] PixelRectangle united(const PixelRectangle& a, const PixelRectangle& b);
/// What both hold.
[[nodiscard]] PixelRectangle common(const PixelRectangle& a, const PixelRectangle& b);
/// What is left of a rectangle around another one.
[[nodiscard]] std::array<PixelRectangle, 4> around(const PixelRectangle& area, const PixelRectangle& whole);

/// The pixels between two places of an image, as calibration counts them (row 0 at the top), within its size.
[[nodiscard]] PixelRectangle pixelRectangle(const glm::dvec2& low, const glm::dvec2& high, glm::ivec2 size);

/// Parts of an image that are drawn one by one: few, none of them empty.
class PixelRegion {
public:
    PixelRegion() = default;
    explicit PixelRegion(const PixelRectangle& part) { include(part); }

    void include(const PixelRectangle& part);
    void include(const PixelRegion& other);

    [[nodiscard]] const std::vector<PixelRectangle>& parts() const noexcept { return parts_; }
    [[nodiscard]] bool empty() const noexcept { return parts_.empty(); }
    /// One rectangle that holds them all.
    [[nodiscard]] PixelRectangle bounds() const;

private:
    std::vector<PixelRectangle> parts_;
};

} // namespace lumorph
