#include "core/rig/sheet_modes.h"

#include <array>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace lumorph {
namespace {

double firstAt(double a, double b, double c) { return a * (1.0 - 2.0 * a) * (0.5 - b) * (c * c * c - c + 0.2); }
double secondAt(double a, double b, double c) { return a * a * b * c; }

/// Two modes over three levers of 3, 2 and 4 strokes, whose coefficients are the polynomials above.
SheetModes polynomialModes() {
    SheetModes modes;
    modes.strokes = {{0.0F, 0.5F, 1.0F}, {0.0F, 1.0F}, {0.0F, 0.25F, 0.75F, 1.0F}};
    modes.modeCount = 2;
    for (const float a : modes.strokes[0])
        for (const float b : modes.strokes[1])
            for (const float c : modes.strokes[2])
                for (const auto& value : {firstAt, secondAt})
                    modes.coefficients.push_back(static_cast<float>(value(double{a}, double{b}, double{c})));
    modes.modes = {{0.0F, 1.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 2.0F, 0.0F}, {0.0F, 0.0F, 3.0F}};
    return modes;
}

TEST(SheetModes, InterpolatePolynomialsOfTheGridsOrderExactly) {
    const SheetModes modes = polynomialModes();
    for (const std::array<double, 3>& s :
         {std::array{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}, {0.3, 0.8, 0.45}, {0.77, 0.21, 0.93}}) {
        const auto first = static_cast<float>(firstAt(s[0], s[1], s[2]));
        const auto second = static_cast<float>(secondAt(s[0], s[1], s[2]));
        EXPECT_LT(glm::distance(rowDisplacement(modes, 0, s), glm::vec3(second, first, 0.0F)), 1e-6F);
        EXPECT_LT(glm::distance(rowDisplacement(modes, 1, s), glm::vec3(0.0F, 2.0F * first, 3.0F * second)), 1e-6F);
    }
}

} // namespace
} // namespace lumorph
