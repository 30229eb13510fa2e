#pragma once

#include <array>

#include <QImage>
#include <QSize>

namespace lumorph::studio {

/// What a projector shows instead of the scene, to be set up by.
enum class TestPattern {
    none,
    checkerboard, ///< of single pixels: grey where anything scales
    grid,         ///< lines every 40 pixels, diagonals, a frame of one pixel at the very edge
    ramp,         ///< grey from black to white, all 256 steps
    white,
    black,
};
inline constexpr std::array kTestPatterns{TestPattern::none, TestPattern::checkerboard, TestPattern::grid,
                                          TestPattern::ramp, TestPattern::white,        TestPattern::black};

[[nodiscard]] QString nameOf(TestPattern pattern);

/// The pattern in a projector's pixels, RGB32. `none` is black.
[[nodiscard]] QImage testPattern(TestPattern pattern, QSize size);
/// The number of a projector, as large as fits, so that one sees on the table which is which.
[[nodiscard]] QImage numberPicture(int number, QSize size);

} // namespace lumorph::studio
