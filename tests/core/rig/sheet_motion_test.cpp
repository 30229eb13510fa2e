#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/rig/actuator_copies.h"
#include "core/rig/actuator_weights.h"
#include "core/rig/rig.h"
#include "tests/core/rig/small_sheet.h"
#include "tests/support/lifted_sheet.h"

namespace lumorph {
namespace {

using Strokes = std::vector<double>;

const Rig& liftedSheet() {
    static const Rig rig(test::liftedSheetParts());
    return rig;
}

Strokes randomSheetStrokes(std::size_t count, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    Strokes strokes(count);
    for (double& stroke : strokes) stroke = uniform(random);
    return strokes;
}

/// The oracle: every state of the grid by the plain product of its Lagrange polynomials.
std::vector<double> literalCoefficients(const SheetModes& modes, const Strokes& strokes) {
    std::vector<double> sums(modes.modeCount, 0.0);
    for (std::size_t state = 0; state < modes.stateCount(); ++state) {
        double weight = 1.0;
        std::size_t left = state;
        for (std::size_t axis = strokes.size(); axis-- > 0;) {
            const std::vector<float>& nodes = modes.strokes[axis];
            const std::size_t node = left % nodes.size();
            left /= nodes.size();
            for (std::size_t other = 0; other < nodes.size(); ++other)
                if (other != node)
                    weight *= (strokes[axis] - static_cast<double>(nodes[other])) /
                              (static_cast<double>(nodes[node]) - static_cast<double>(nodes[other]));
        }
        for (std::size_t k = 0; k < sums.size(); ++k)
            sums[k] += weight * static_cast<double>(modes.coefficients[state * modes.modeCount + k]);
    }
    return sums;
}

TEST(SheetModes, CoefficientsAreTheLiteralSumOverTheGrid) {
    std::mt19937 random(3);
    for (const SheetModes& modes : {liftedSheet().parts().sheet->modes, test::smallSheetParts().sheet->modes}) {
        double worst = 0.0;
        for (int state = 0; state < 200; ++state) {
            const Strokes strokes = randomSheetStrokes(modes.strokes.size(), random);
            std::vector<float> fast(modes.modeCount);
            modeCoefficients(modes, strokes, fast);
            const auto literal = literalCoefficients(modes, strokes);
            for (std::size_t k = 0; k < fast.size(); ++k)
                worst = std::max(worst, std::abs(static_cast<double>(fast[k]) - literal[k]));
        }
        EXPECT_LT(worst, 2e-6);
    }
}

TEST(SheetModes, AtTheGridTheyAreItsCoefficientsExactly) {
    const SheetModes modes = test::smallSheetParts().sheet->modes;
    std::vector<float> at(2);
    for (std::size_t state = 0; state < modes.stateCount(); ++state) {
        modeCoefficients(modes, Strokes{modes.strokes[0][state / 2], modes.strokes[1][state % 2]}, at);
        EXPECT_EQ(at[0], modes.coefficients[2 * state]);
        EXPECT_EQ(at[1], modes.coefficients[2 * state + 1]);
    }
}

// Levers that are left out of a vertex' motion may cost a micrometre each.
TEST(SheetMotion, VerticesAreWhereTheirRowIsAtTheirShareOfTheStrokes) {
    const Rig& rig = liftedSheet();
    const SheetMotion& sheet = *rig.parts().sheet;
    std::mt19937 random(5);
    double worst = 0.0;
    for (int state = 0; state < 5; ++state) {
        const Strokes strokes = randomSheetStrokes(rig.actuatorCount(), random);
        const auto positions = deformed(rig, strokes).positions;
        std::vector<std::vector<double>> bySharePart(test::kSkirtShares + 1);
        for (int part = 1; part <= test::kSkirtShares; ++part) {
            Strokes along = strokes;
            for (double& stroke : along) stroke *= static_cast<double>(static_cast<float>(part) / test::kSkirtShares);
            bySharePart[part] = literalCoefficients(sheet.modes, along);
        }
        for (std::size_t v = 0; v < positions.size(); ++v) {
            const auto [row, share] = sheet.followers[v];
            glm::dvec3 expected(rig.restMesh().positions[v]);
            if (row != SheetMotion::kNoRow)
                for (std::size_t k = 0; k < sheet.modes.modeCount; ++k)
                    expected += bySharePart[std::lround(share * test::kSkirtShares)][k] *
                                glm::dvec3(sheet.modes.modes[row * sheet.modes.modeCount + k]);
            worst = std::max(worst, glm::distance(expected, glm::dvec3(positions[v])));
        }
    }
    std::cout << "[ figures  ] farthest from the literal sum: " << 1e6 * worst << " um\n";
    EXPECT_LT(worst, 6e-6);
}

TEST(SheetMotion, ThePadAndTheBodyFollowNoLeverAndTheRimSome) {
    const Rig& rig = liftedSheet();
    std::size_t still = 0;
    std::size_t most = 0;
    for (std::uint32_t v = 0; v < rig.restMesh().positions.size(); ++v) {
        still += rig.actuatorsOf(v).empty() ? 1 : 0;
        most = std::max(most, rig.actuatorsOf(v).size());
    }
    EXPECT_GT(still, 300U);
    EXPECT_GT(most, 3U) << "levers overlap";
}

// R7: proven boxes, and how much larger than what 5^6 states reach.
TEST(SheetMotion, ReachHoldsAllStatesAndIsTight) {
    const Rig& rig = liftedSheet();
    std::vector<std::uint32_t> some;
    for (std::uint32_t v = 0; v < rig.restMesh().positions.size(); v += 23)
        if (!rig.actuatorsOf(v).empty()) some.push_back(v);
    const Rig::Subset subset = rig.subset(some);
    std::vector<glm::vec3> positions(some.size());
    std::vector<Box> seen(some.size());
    Strokes strokes(6);
    for (int state = 0; state < 15625; ++state) {
        for (int axis = 0, left = state; axis < 6; ++axis, left /= 5) strokes[axis] = 0.25 * (left % 5);
        subset.deform(strokes, positions);
        for (std::size_t k = 0; k < some.size(); ++k) seen[k].include(positions[k]);
    }
    double largest = 1.0;
    for (std::size_t k = 0; k < some.size(); ++k) {
        const Box& box = rig.reachOf(some[k]);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_LE(box.min[axis], seen[k].min[axis]);
            EXPECT_GE(box.max[axis], seen[k].max[axis]);
            const float extent = seen[k].size()[axis];
            if (extent > 1e-4F) largest = std::max(largest, static_cast<double>(box.size()[axis] / extent));
        }
    }
    std::cout << "[ figures  ] boxes of " << some.size() << " vertices: at most " << 100.0 * (largest - 1.0)
              << " % longer than what is reached\n";
    EXPECT_LT(largest, 1.1);
}

TEST(SheetMotion, AnglesOfLeversDoNotMakeAnotherSolid) {
    const RigParts parts = test::smallSheetParts();
    RigParts other = parts;
    std::get<SheetLift>(other.actuators[0].deformer).max = Angle::degrees(80.0);
    EXPECT_TRUE(deformAlike(parts, other));
    std::swap(other.actuators[0].deformer, other.actuators[1].deformer);
    EXPECT_FALSE(deformAlike(parts, other));
    other = parts;
    other.sheet->modes.coefficients.back() += 0.1F;
    EXPECT_FALSE(deformAlike(parts, other));
}

TEST(SheetMotion, WeightsOfALeverAreShownAndNotPainted) {
    RigParts parts = test::smallSheetParts();
    const auto weights = actuatorWeights(parts, 0);
    EXPECT_EQ(std::ranges::max(weights), 1.0F);
    EXPECT_EQ(std::ranges::count_if(weights, [](float w) { return w > 0.0F; }), 4);
    EXPECT_EQ(std::ranges::count(canFollow(parts, 0), true), 0);
    EXPECT_THROW(setActuatorWeights(parts, 0, weights), InvalidInput);
    EXPECT_THROW((void)mirroredActuator(parts, 0, MirrorPlane::acrossX), InvalidInput);
    Actuator slide;
    slide.name = "slide";
    slide.deformer = Slide{{1, 0, 0}, 0.0, 0.01};
    parts.actuators.push_back(slide);
    setActuatorWeights(parts, 2, std::vector<float>(parts.restMesh.positions.size(), 1.0F));
    EXPECT_EQ(parts.actuators[2].influences.size(), parts.restMesh.positions.size() - 4) << "what follows no sheet";
    EXPECT_NO_THROW(Rig{parts});
}

struct BadSheet {
    const char* name;
    const char* why; ///< part of the message
    std::function<void(RigParts&)> spoil;
};

class SheetRefusedParts : public testing::TestWithParam<BadSheet> {};

TEST_P(SheetRefusedParts, AreNamed) {
    RigParts parts = test::smallSheetParts();
    ASSERT_NO_THROW(Rig{parts});
    GetParam().spoil(parts);
    try {
        const Rig rig(std::move(parts));
        FAIL() << "accepted";
    } catch (const InvalidInput& error) {
        EXPECT_NE(error.why().find(GetParam().why), std::string::npos) << error.what();
        EXPECT_FALSE(error.remedy().empty());
    }
}

constexpr float kNotFinite = std::numeric_limits<float>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    SheetMotion, SheetRefusedParts,
    testing::Values(
        BadSheet{"NoSheet", "no sheet", [](RigParts& p) { p.sheet.reset(); }},
        BadSheet{"NoAxes", "no axes", [](RigParts& p) { p.sheet->modes.strokes.clear(); }},
        BadSheet{"ManyAxes", "more than 8",
                 [](RigParts& p) {
                     p.sheet->modes.strokes.resize(9, {0.0F, 1.0F});
                 }},
        BadSheet{"OneStroke", "fewer than 2", [](RigParts& p) { p.sheet->modes.strokes[1] = {0.0F}; }},
        BadSheet{"ManyStrokes", "more than 5",
                 [](RigParts& p) { p.sheet->modes.strokes[1] = {0, 0.1F, 0.2F, 0.3F, 0.4F, 1}; }},
        BadSheet{"FirstStroke", "from 0 to 1", [](RigParts& p) { p.sheet->modes.strokes[1][0] = 0.1F; }},
        BadSheet{"LastStroke", "from 0 to 1", [](RigParts& p) { p.sheet->modes.strokes[1][1] = 0.9F; }},
        BadSheet{"CloseStrokes", "closer than 0.01", [](RigParts& p) { p.sheet->modes.strokes[0][1] = 0.001F; }},
        BadSheet{"StrokesBackwards", "not ascending", [](RigParts& p) { p.sheet->modes.strokes[0][1] = 1.4F; }},
        BadSheet{"StrokeNaN", "not ascending", [](RigParts& p) { p.sheet->modes.strokes[0][1] = kNotFinite; }},
        BadSheet{"NoModes", "no modes", [](RigParts& p) { p.sheet->modes.modeCount = 0; }},
        BadSheet{"ManyModes", "more than 64", [](RigParts& p) { p.sheet->modes.modeCount = 65; }},
        BadSheet{"HugeGrid", "65,536",
                 [](RigParts& p) {
                     p.sheet->modes.strokes.assign(8, {0.0F, 0.2F, 0.5F, 0.8F, 1.0F});
                 }},
        BadSheet{"Coefficients", "one coefficient", [](RigParts& p) { p.sheet->modes.coefficients.pop_back(); }},
        BadSheet{"CoefficientNaN", "not finite", [](RigParts& p) { p.sheet->modes.coefficients[5] = kNotFinite; }},
        BadSheet{"RestMoves", "not 0", [](RigParts& p) { p.sheet->modes.coefficients[1] = 0.1F; }},
        BadSheet{"Displacements", "one displacement", [](RigParts& p) { p.sheet->modes.modes.pop_back(); }},
        BadSheet{"DisplacementNaN", "not finite", [](RigParts& p) { p.sheet->modes.modes[1].z = kNotFinite; }},
        BadSheet{"DisplacementFar", "beyond all measure", [](RigParts& p) { p.sheet->modes.modes[1].z = 1e7F; }},
        BadSheet{"Followers", "one row and share", [](RigParts& p) { p.sheet->followers.pop_back(); }},
        BadSheet{"Row", "does not exist", [](RigParts& p) { p.sheet->followers.back().row = 4; }},
        BadSheet{"UnusedRow", "no vertex follows",
                 [](RigParts& p) { p.sheet->modes.modes.resize(10, glm::vec3(0.0F)); }},
        BadSheet{"ShareZero", "within 0 and 1", [](RigParts& p) { p.sheet->followers[0].share = 0.0F; }},
        BadSheet{"ShareLarge", "within 0 and 1", [](RigParts& p) { p.sheet->followers[0].share = 1.1F; }},
        BadSheet{"ShareNaN", "within 0 and 1", [](RigParts& p) { p.sheet->followers[0].share = kNotFinite; }},
        BadSheet{"AxisOfNoLever", "no lever drives axis 1",
                 [](RigParts& p) { p.actuators.erase(p.actuators.begin()); }},
        BadSheet{"AxisTwice", "same axis", [](RigParts& p) { std::get<SheetLift>(p.actuators[1].deformer).axis = 1; }},
        BadSheet{"AxisOut", "no such axis", [](RigParts& p) { std::get<SheetLift>(p.actuators[1].deformer).axis = 2; }},
        BadSheet{"AxisNegative", "no such axis",
                 [](RigParts& p) { std::get<SheetLift>(p.actuators[1].deformer).axis = -1; }},
        BadSheet{"Influences", "has influences",
                 [](RigParts& p) {
                     p.actuators[0].influences = {{0, 1.0F}};
                 }},
        BadSheet{"LeverRange", "backwards",
                 [](RigParts& p) { std::get<SheetLift>(p.actuators[0].deformer).max = Angle(); }},
        BadSheet{"Skeleton", "skeleton",
                 [](RigParts& p) {
                     p.skeleton.emplace().joints.resize(1);
                     p.skeleton->vertexJoints.resize(p.restMesh.positions.size());
                     p.skeleton->vertexWeights.resize(p.restMesh.positions.size(), {1, 0, 0, 0});
                 }},
        BadSheet{"Mixed", "follow the sheet",
                 [](RigParts& p) {
                     Actuator& slide = p.actuators.emplace_back();
                     slide.name = "slide";
                     slide.deformer = Slide{{1, 0, 0}, 0.0, 0.01};
                     for (std::uint32_t v = 0; v < p.restMesh.positions.size(); ++v)
                         slide.influences.push_back({v, 0.5F});
                 }}),
    [](const auto& kind) { return std::string(kind.param.name); });

TEST(SheetMotion, PathsOfTooManySharesAreRefused) {
    RigParts parts = test::liftedSheetParts();
    for (std::size_t v = 0; v < 65; ++v) parts.sheet->followers[v].share = 0.5F + 0.001F * static_cast<float>(v);
    EXPECT_THROW(Rig{parts}, InvalidInput);
}

} // namespace
} // namespace lumorph
