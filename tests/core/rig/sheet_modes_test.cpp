#include "core/rig/sheet_modes.h"

#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"

namespace lumorph {
namespace {

/// Two modes over three actuators of 3, 2 and 4 levels, whose coefficients are these polynomials.
double firstAt(double a, double b, double c) { return (1.0 + a - 2.0 * a * a) * (0.5 - b) * (c * c * c - c + 0.2); }
double secondAt(double a, double b, double c) { return a * a * b * c; }

SheetModes::Parts polynomialParts() {
    SheetModes::Parts parts;
    parts.levels = {3, 2, 4};
    parts.rest = {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}};
    parts.modes = {{0.0F, 1.0F, 0.0F}, {0.0F, 2.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 3.0F}};
    for (const double a : {0.0, 0.5, 1.0})
        for (const double b : {0.0, 1.0})
            for (const double c : {0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0}) {
                parts.coefficients.push_back(static_cast<float>(firstAt(a, b, c)));
                parts.coefficients.push_back(static_cast<float>(secondAt(a, b, c)));
            }
    return parts;
}

TEST(SheetModes, InterpolatePolynomialsOfTheGridsOrderExactly) {
    const SheetModes modes(polynomialParts());
    for (const std::array<double, 3>& s :
         {std::array{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}, {0.3, 0.8, 0.45}, {0.77, 0.21, 0.93}}) {
        std::array<glm::vec3, 2> out{};
        modes.deform(s, out);
        const auto first = static_cast<float>(firstAt(s[0], s[1], s[2]));
        const auto second = static_cast<float>(secondAt(s[0], s[1], s[2]));
        EXPECT_LT(glm::distance(out[0], glm::vec3(second, first, 0.0F)), 1e-6F);
        EXPECT_LT(glm::distance(out[1], glm::vec3(1.0F, 2.0F * first, 3.0F * second)), 1e-6F);
    }
}

TEST(SheetModes, GiveListedVerticesAsTheyGiveAll) {
    const SheetModes modes(polynomialParts());
    const std::array strokes{0.3, 0.6, 0.9};
    std::array<glm::vec3, 2> all{};
    modes.deform(strokes, all);
    const std::array<std::uint32_t, 3> vertices{1, 0, 1};
    std::array<glm::vec3, 3> listed{};
    modes.deform(strokes, vertices, listed);
    for (std::size_t k = 0; k < vertices.size(); ++k) EXPECT_LT(glm::distance(listed[k], all[vertices[k]]), 1e-6F);
}

TEST(SheetModes, PartsThatDoNotFitAreRefused) {
    const auto refused = [](auto&& change) {
        SheetModes::Parts parts = polynomialParts();
        change(parts);
        EXPECT_THROW(SheetModes{std::move(parts)}, InvalidInput);
    };
    refused([](SheetModes::Parts& parts) { parts.coefficients.pop_back(); });
    refused([](SheetModes::Parts& parts) { parts.modes.pop_back(); });
    refused([](SheetModes::Parts& parts) { parts.levels = {3, 2, 9}; });
    refused([](SheetModes::Parts& parts) { parts.levels.clear(); });
    refused([](SheetModes::Parts& parts) { parts.rest.clear(); });
}

} // namespace
} // namespace lumorph
