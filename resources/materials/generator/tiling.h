#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/image.h"

/// Pictures that repeat without a seam: everything here lives on a torus of side 1.
namespace lumorph {

inline constexpr int kTextureSide = 512;

/// A number in [0, 1) for whole numbers, the same on every machine.
[[nodiscard]] float hashed(std::uint32_t x, std::uint32_t y, std::uint32_t seed);

/// Gradient noise in about [-1, 1] with so many cells in x and y to a repeat.
[[nodiscard]] float noise(glm::vec2 at, glm::ivec2 cells, std::uint32_t seed);
/// Octaves of it, each twice as fine and `gain` times as strong.
[[nodiscard]] float cloudy(glm::vec2 at, glm::ivec2 cells, int octaves, std::uint32_t seed, float gain = 0.5F);

/// The nearest two of scattered points, one in each of `cells` x `cells` squares.
struct Scatter {
    float nearest = 0.0F; ///< distance, in squares
    float second = 0.0F;
    std::uint32_t id = 0; ///< of the nearest
    glm::vec2 offset{0.0F};
};
[[nodiscard]] Scatter scattered(glm::vec2 at, int cells, std::uint32_t seed, float jitter = 1.0F);

/// Calls `see` with the id of, and the way from (in squares), all such points near by.
void forPointsAround(glm::vec2 at, int cells, std::uint32_t seed, float jitter,
                     const std::function<void(std::uint32_t, glm::vec2)>& see);

/// A number a pixel; reading wraps round.
class Heights {
public:
    explicit Heights(int side = kTextureSide) : side_(side), values_(static_cast<std::size_t>(side * side)) {}
    [[nodiscard]] int side() const noexcept { return side_; }
    [[nodiscard]] float& at(int x, int y) noexcept { return values_[index(x, y)]; }
    [[nodiscard]] float at(int x, int y) const noexcept { return values_[index(x, y)]; }
    [[nodiscard]] std::size_t index(int x, int y) const noexcept {
        const auto wrapped = [this](int i) { return static_cast<std::size_t>(((i % side_) + side_) % side_); };
        return wrapped(y) * static_cast<std::size_t>(side_) + wrapped(x);
    }
    [[nodiscard]] std::vector<float>& values() noexcept { return values_; }
    [[nodiscard]] const std::vector<float>& values() const noexcept { return values_; }

private:
    int side_;
    std::vector<float> values_;
};

/// Calls `value` with the middle of every pixel, row 0 at the top.
[[nodiscard]] Heights drawn(const std::function<float(glm::vec2)>& value);
/// Scaled and shifted to [0, 1].
void normalize(Heights& heights);
[[nodiscard]] Heights blurred(const Heights& heights, int passes);

/// sRGB in [0, 1] for every pixel.
[[nodiscard]] Image painted(const std::function<glm::vec3(int, int)>& color, int side = kTextureSide);
/// Tangent-space normals, +Y up; `strength` is how high a height of 1 is, in widths of the picture.
[[nodiscard]] Image normalsOf(const Heights& heights, float strength);

[[nodiscard]] float smooth(float from, float to, float value);

} // namespace lumorph
