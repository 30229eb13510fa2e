#include "core/rig/sheet/sheet_solver.h"

#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/core/rig/sheet/strip_mesh.h"

namespace lumorph {
namespace {

constexpr double kLength = 0.1;
constexpr double kWidth = 0.03;
constexpr double kThickness = 1e-3;
/// Without lateral contraction a strip of any width is a beam.
constexpr SheetMaterial kBeamMaterial{"beam", 12e6, 0.0};
constexpr double kBeamStiffness = 12e6 * kWidth * kThickness * kThickness * kThickness / 12.0; // E I

/// A strip whose end x = 0 is clamped.
struct Strip {
    explicit Strip(double edgeLength, double thickness = kThickness)
        : mesh(stripMesh(kLength, kWidth, edgeLength)), layers{{kBeamMaterial, thickness}}, supports(noSupports(mesh)) {
        for (std::uint32_t k = 0; k < mesh.points.size(); ++k) {
            if (mesh.points[k].x == 0.0) supports.heldAxes[k] = SheetSupports::all;
            if (mesh.points[k].x == kLength) tip.push_back(k);
        }
        for (std::size_t k = 0; k < mesh.edges.size(); ++k)
            supports.heldDirectors[k] =
                supports.heldAxes[mesh.edges[k][0]] != 0 && supports.heldAxes[mesh.edges[k][1]] != 0;
    }

    /// The tip's place under a force upwards, spread evenly over its width.
    glm::dvec3 loaded(double force) {
        const double each = force / static_cast<double>(tip.size() - 1);
        for (const std::uint32_t k : tip) {
            const double z = mesh.points[k].y;
            supports.loads[k].y = z == 0.0 || z == kWidth ? 0.5 * each : each;
        }
        const SheetState flat = flatState(mesh);
        const SheetEquilibrium found = SheetSolver(mesh, layers, supports).solve(flat, flat.positions);
        EXPECT_TRUE(found.converged && found.stable);
        glm::dvec3 sum(0.0);
        for (const std::uint32_t k : tip) sum += found.state.positions[k] / static_cast<double>(tip.size());
        return sum;
    }

    /// The force that holds the tip's line at a height while it slides.
    double pulled(double height) {
        const SheetState flat = flatState(mesh);
        std::vector<glm::dvec3> held = flat.positions;
        for (const std::uint32_t k : tip) {
            supports.heldAxes[k] = SheetSupports::y;
            held[k].y = height;
        }
        const SheetEquilibrium found = SheetSolver(mesh, layers, supports).solve(flat, held);
        EXPECT_TRUE(found.converged && found.stable);
        double force = 0.0;
        for (const std::uint32_t k : tip) force += found.reactions[k].y;
        return force;
    }

    SheetMesh mesh;
    std::vector<SheetLayer> layers;
    SheetSupports supports;
    std::vector<std::uint32_t> tip;
};

/// A cantilever under a force that keeps its direction, at the load that turns its tip by an angle: closed form by
/// elliptic integrals (Bisshopp and Drucker 1945). With p^2 = (1 + sin angle)/2 and sin phi = 1/(p sqrt 2):
/// force L^2/(E I) = (K - F)^2, height/L = 1 - 2 (E - E(phi))/(K - F), reach/L = sqrt(2 sin angle)/(K - F).
struct Elastica {
    explicit Elastica(double angle) {
        const double p = std::sqrt(0.5 * (1.0 + std::sin(angle)));
        const double phi = std::asin(1.0 / (p * std::numbers::sqrt2));
        const double root = std::comp_ellint_1(p) - std::ellint_1(p, phi);
        force = root * root * kBeamStiffness / (kLength * kLength);
        height = kLength * (1.0 - 2.0 * (std::comp_ellint_2(p) - std::ellint_2(p, phi)) / root);
        reach = kLength * std::sqrt(2.0 * std::sin(angle)) / root;
    }
    double force;
    double height;
    double reach;
};

const Elastica kElastica(70.0 * std::numbers::pi / 180.0);

SheetState randomState(const SheetMesh& mesh) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> shift(-1e-3, 1e-3);
    SheetState state = flatState(mesh);
    for (glm::dvec3& p : state.positions) p += glm::dvec3(shift(random), 5.0 * shift(random), shift(random));
    for (std::size_t k = 0; k < mesh.edges.size(); ++k) {
        const glm::dvec3 edge = state.positions[mesh.edges[k][1]] - state.positions[mesh.edges[k][0]];
        const glm::dvec3 leaning(100.0 * shift(random), 1.0, 100.0 * shift(random));
        state.directors[k] = glm::normalize(leaning - edge * (glm::dot(edge, leaning) / glm::dot(edge, edge)));
    }
    return state;
}

/// The shape that a map of the plane into space gives the sheet, with its normals.
template <typename Map> SheetState mappedState(const SheetMesh& mesh, Map&& map) {
    SheetState state = flatState(mesh);
    for (std::size_t k = 0; k < mesh.points.size(); ++k) state.positions[k] = map(mesh.points[k]).first;
    for (std::size_t k = 0; k < mesh.edges.size(); ++k)
        state.directors[k] = map(0.5 * (mesh.points[mesh.edges[k][0]] + mesh.points[mesh.edges[k][1]])).second;
    return state;
}

} // namespace

TEST(SheetSolver, RigidMotionCostsNoEnergy) {
    const Strip strip(0.01);
    const SheetSolver solver(strip.mesh, strip.layers, strip.supports);
    const glm::dquat turn = glm::angleAxis(1.1, glm::normalize(glm::dvec3(0.3, -0.5, 0.8)));
    const SheetState moved = mappedState(strip.mesh, [&](const glm::dvec2& p) {
        return std::pair(turn * glm::dvec3(p.x, 0.0, p.y) + glm::dvec3(0.1, 0.2, 0.3),
                         turn * glm::dvec3(0.0, 1.0, 0.0));
    });
    EXPECT_LT(solver.energy(moved), 1e-18);
    for (const glm::dvec3& force : solver.gradient(moved).forces) EXPECT_LT(glm::length(force), 1e-9);
}

TEST(SheetSolver, ConstantCurvatureHasTheEnergyOfACylinder) {
    const Strip strip(0.006);
    const SheetSolver solver(strip.mesh, strip.layers, strip.supports);
    constexpr double kRadius = 0.06;
    const SheetState rolled = mappedState(strip.mesh, [](const glm::dvec2& p) {
        const double turn = p.x / kRadius;
        return std::pair(glm::dvec3(kRadius * std::sin(turn), kRadius * (1.0 - std::cos(turn)), p.y),
                         glm::dvec3(-std::sin(turn), std::cos(turn), 0.0));
    });
    const double exact = 0.5 * kBeamStiffness / (kRadius * kRadius) * kLength;
    EXPECT_NEAR(solver.energy(rolled), exact, 0.01 * exact);
    EXPECT_NEAR(std::abs(solver.strain(rolled).face), 0.5 * kThickness / kRadius, 0.05 * 0.5 * kThickness / kRadius);
}

TEST(SheetSolver, UniformStretchHasTheEnergyOfStVenantAndKirchhoff) {
    const SheetMesh mesh = stripMesh(kLength, kWidth, 0.01);
    const std::vector<SheetLayer> layers{{{"rubber", 12e6, 0.48}, kThickness}, {{"paper", 3e9, 0.3}, 1e-4, true}};
    const SheetSolver solver(mesh, layers, noSupports(mesh));
    const SheetState stretched = mappedState(mesh, [](const glm::dvec2& p) {
        return std::pair(glm::dvec3(1.1 * p.x, 0.0, p.y), glm::dvec3(0.0, 1.0, 0.0));
    });
    const double green = 0.5 * (1.1 * 1.1 - 1.0);
    const double exact = 0.5 * 12e6 / (1.0 - 0.48 * 0.48) * kThickness * green * green * kLength * kWidth;
    EXPECT_NEAR(solver.energy(stretched), exact, 1e-9 * exact);
    EXPECT_NEAR(solver.strain(stretched).middle, 0.1, 1e-9);
}

TEST(SheetSolver, GradientIsThatOfTheEnergy) {
    const SheetMesh mesh = stripMesh(0.03, 0.02, 0.01);
    const std::vector<SheetLayer> layers{{{"rubber", 12e6, 0.48}, kThickness}};
    const SheetSolver solver(mesh, layers, noSupports(mesh));
    const SheetState state = randomState(mesh);
    const SheetGradient gradient = solver.gradient(state);
    constexpr double kStep = 1e-7;
    // A director follows its edge: what matters of a perturbed one is its part perpendicular to the moved edge.
    const auto energyAt = [&](SheetState moved) {
        for (std::size_t k = 0; k < mesh.edges.size(); ++k) {
            const glm::dvec3 before = state.positions[mesh.edges[k][1]] - state.positions[mesh.edges[k][0]];
            const glm::dvec3 edge = moved.positions[mesh.edges[k][1]] - moved.positions[mesh.edges[k][0]];
            if (edge != before)
                moved.directors[k] = glm::normalize(glm::cross(edge, glm::cross(moved.directors[k], before)));
        }
        return solver.energy(moved);
    };
    for (std::size_t k = 0; k < mesh.points.size(); ++k)
        for (int axis = 0; axis < 3; ++axis) {
            SheetState up = state;
            SheetState down = state;
            up.positions[k][axis] += kStep;
            down.positions[k][axis] -= kStep;
            const double slope = (energyAt(up) - energyAt(down)) / (2.0 * kStep);
            EXPECT_NEAR(gradient.forces[k][axis], slope, 1e-5 * std::abs(slope) + 1e-5) << k << " " << axis;
        }
    for (std::size_t k = 0; k < mesh.edges.size(); ++k) {
        const auto turned = [&](double angle) {
            SheetState moved = state;
            const glm::dvec3 edge = state.positions[mesh.edges[k][1]] - state.positions[mesh.edges[k][0]];
            moved.directors[k] = glm::angleAxis(angle, glm::normalize(edge)) * state.directors[k];
            return solver.energy(moved);
        };
        const double slope = (turned(1e-6) - turned(-1e-6)) / 2e-6;
        EXPECT_NEAR(gradient.moments[k], slope, 1e-5 * std::abs(slope) + 1e-9) << k;
    }
}

TEST(SheetSolver, CantileverBendsAsABeam) {
    constexpr double kForce = 1e-5;
    const double exact = kForce * kLength * kLength * kLength / (3.0 * kBeamStiffness);
    for (const double edgeLength : {0.01, 0.005})
        EXPECT_NEAR(Strip(edgeLength).loaded(kForce).y, exact, 0.02 * exact) << edgeLength;
}

TEST(SheetSolver, ElasticaAtSeventyDegreesHasItsClosedForm) {
    for (const double edgeLength : {0.01, 0.005}) {
        const glm::dvec3 tip = Strip(edgeLength).loaded(kElastica.force);
        EXPECT_NEAR(tip.y, kElastica.height, 0.02 * kElastica.height) << edgeLength;
        EXPECT_NEAR(tip.x, kElastica.reach, 0.02 * kElastica.reach) << edgeLength;
    }
}

TEST(SheetSolver, StripPulledToAHeightNeedsTheForceOfTheElastica) {
    for (const double edgeLength : {0.01, 0.005})
        EXPECT_NEAR(Strip(edgeLength).pulled(kElastica.height), kElastica.force, 0.05 * kElastica.force) << edgeLength;
}

TEST(SheetSolver, HalfTheThicknessNeedsAnEighthOfTheForce) {
    EXPECT_NEAR(Strip(0.01, 0.5 * kThickness).pulled(kElastica.height), kElastica.force / 8.0,
                0.05 * kElastica.force / 8.0);
}

TEST(SheetSolver, LoosePaperAddsItsBendingStiffnessOnly) {
    Strip strip(0.01);
    const double alone = strip.pulled(0.01);
    strip.layers.push_back({{"paper", 240.0 * 12e6, 0.0}, 0.1 * kThickness, true});
    EXPECT_NEAR(strip.pulled(0.01), 1.24 * alone, 0.01 * alone);
}

TEST(SheetSolver, PlateUnderALineLoadSagsAsNavierComputed) {
    constexpr double kSide = 0.1;
    constexpr double kLineLoad = 1e-3; // newtons per metre, along the middle x = side/2
    constexpr SheetMaterial kRubber{"rubber", 12e6, 0.3};
    const double stiffness = kRubber.youngsModulus * kThickness * kThickness * kThickness / (12.0 * (1.0 - 0.3 * 0.3));
    double exact = 0.0;
    for (int m = 1; m < 60; m += 2)
        for (int n = 1; n < 60; n += 2) {
            const double sign = n % 4 == 1 ? 1.0 : -1.0; // sin^2(m pi/2) sin(n pi/2)
            const double load = 8.0 * kLineLoad / (kSide * n * std::numbers::pi);
            const double wave = (m * m + n * n) / (kSide * kSide);
            exact += sign * load / (stiffness * std::pow(std::numbers::pi, 4) * wave * wave);
        }
    for (const double edgeLength : {0.005, 0.0025}) {
        const SheetMesh mesh = stripMesh(kSide, kSide, edgeLength, 0.0);
        SheetSupports supports = noSupports(mesh);
        std::uint32_t middle = 0;
        for (std::uint32_t k = 0; k < mesh.points.size(); ++k) {
            const glm::dvec2& p = mesh.points[k];
            if (p.x == 0.0 || p.y == 0.0 || p.x == kSide || p.y == kSide) supports.heldAxes[k] = SheetSupports::y;
            if (p == glm::dvec2(0.0) || p == glm::dvec2(kSide, 0.0)) supports.heldAxes[k] = SheetSupports::all;
            if (std::abs(p.x - 0.5 * kSide) < 1e-9) supports.loads[k].y = kLineLoad * edgeLength;
            if (glm::distance(p, glm::dvec2(0.5 * kSide)) < 1e-9) middle = k;
        }
        const SheetState flat = flatState(mesh);
        const std::vector<SheetLayer> layers{{kRubber, kThickness}};
        const auto found = SheetSolver(mesh, layers, supports).solve(flat, flat.positions);
        EXPECT_NEAR(found.state.positions[middle].y, exact, 0.05 * exact) << edgeLength;
    }
}

TEST(SheetSolver, LayersThatCannotBeAreNamed) {
    const SheetMesh mesh = stripMesh(0.02, 0.02, 0.01);
    const auto solver = [&](std::vector<SheetLayer> layers) { return SheetSolver(mesh, layers, noSupports(mesh)); };
    EXPECT_THROW(solver({}), InvalidInput);
    EXPECT_THROW(solver({{sheetMaterial("printing paper"), 1e-4, true}}), InvalidInput);
    EXPECT_THROW(solver({{sheetMaterial("NinjaFlex"), 1.0}}), InvalidInput);
    EXPECT_THROW(solver({{{"rubber", 12e6, 0.5}, 1e-3}}), InvalidInput);
    EXPECT_THROW(solver({{{"air", 0.0, 0.3}, 1e-3}}), InvalidInput);
    EXPECT_THROW((void)sheetMaterial("wood"), InvalidInput);
}

} // namespace lumorph
