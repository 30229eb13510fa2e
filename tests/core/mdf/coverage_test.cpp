#include "core/mdf/coverage.h"

#include <array>
#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mdf/builder.h"
#include "core/mdf/sampling.h"
#include "core/voxels/solid.h"
#include "tests/support/cgal_oracle.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

constexpr int kCoverageLevels = 9;

// R6: what a flap passes on its way stays covered, though the solid itself has moved on.
TEST(Coverage, WhatASweepPassedStaysCovered) {
    const Rig rig = test::armRig();
    ASSERT_FALSE(rig.pathInside());
    const Coverage coverage(rig, frameOf(rig.reach(), 12), kCoverageLevels);
    CoverageScratch scratch;
    BitColumns before(coverage.frame().dimensions);
    for (int level = 0; level < kCoverageLevels; ++level) {
        BitColumns now;
        coverage.covered(State{Level{level}, Level{0}, Level{0}}, now, scratch);
        BitColumns lost = before;
        lost -= now;
        EXPECT_LE(lost.count(), before.count() / 200) << level;
        before = now;
    }
    EXPECT_GT(before.count(), coverage.body().count()) << "a sweep covers more than the beam itself holds";
}

/// A flap that stands beside a post and turns up about its edge, on its own.
Rig gateRig() {
    RigParts parts;
    parts.name = "gate";
    parts.restMesh = test::boxMesh({0.0F, 0.0F, 0.0F}, {0.0203F, 0.0107F, 0.0309F});
    const TriangleMesh flap = test::boxMesh({0.0211F, 0.0F, 0.0F}, {0.0817F, 0.0052F, 0.0309F}, 3);
    Actuator actuator;
    actuator.name = "gate";
    actuator.deformer = Hinge{{0.0211F, 0.0F, 0.0F}, {0.0F, 0.0F, 1.0F}, Angle{}, Angle::degrees(80.0)};
    for (std::size_t v = 0; v < flap.positions.size(); ++v)
        actuator.influences.push_back({static_cast<std::uint32_t>(parts.restMesh.positions.size() + v), 1.0F});
    append(parts.restMesh, flap);
    parts.actuators.push_back(std::move(actuator));
    return Rig(std::move(parts));
}

// R6: the sweep of one actuator, kept level by level, against a sweep five times as fine judged by CGAL.
TEST(Coverage, ASweptFlapAgreesWithAFineSweep) {
    const Rig rig = gateRig();
    const Coverage coverage(rig, frameOf(rig.reach(), 10), kCoverageLevels);
    const VoxelFrame& frame = coverage.frame();
    CoverageScratch scratch;
    BitColumns fine(frame.dimensions);
    std::vector<double> strokes{0.0};
    BitColumns kept;
    BitColumns afresh;
    std::size_t wrong = 0;
    for (int level = 0; level < kCoverageLevels; ++level) {
        const double from = std::max(0, level - 1) / 8.0;
        const int steps = level == 0 ? 1 : 5 * coverage.pathSteps(std::vector<double>{1.0 / 8.0});
        for (int step = 1; step <= steps; ++step) {
            strokes[0] = level == 0 ? 0.0 : from + step / (8.0 * steps);
            const test::InsideOracle inside(deformed(rig, strokes));
            for (int z = 0; z < frame.dimensions.z; ++z)
                for (int x = 0; x < frame.dimensions.x; ++x)
                    for (int y = 0; y < frame.dimensions.y; ++y)
                        if (!coverage.body().test(x, y, z) && !fine.test(x, y, z) && inside(frame.centre(x, y, z)))
                            fine.set(x, y, z);
        }
        coverage.covered(State{Level{level}}, kept, scratch);
        coverage.coveredAt(std::vector<double>{level / 8.0}, afresh, scratch);
        EXPECT_EQ(kept, afresh) << level;
        BitColumns missed = fine;
        missed -= kept;
        BitColumns extra = kept;
        extra -= fine;
        wrong += extra.count();
        EXPECT_LE(missed.count(), fine.count() / 100) << level;
    }
    EXPECT_GT(fine.count(), 1000U);
    EXPECT_LE(wrong, fine.count() / 100);
}

TEST(Coverage, ACavityInThePartThatStaysIsNotBody) {
    RigParts parts;
    parts.name = "hollow";
    parts.pathInside = true;
    parts.restMesh = test::boxMesh({0, 0, 0}, {0.1F, 0.1F, 0.1F});
    TriangleMesh cavity = test::boxMesh({0.031F, 0.031F, 0.031F}, {0.071F, 0.072F, 0.073F});
    for (glm::uvec3& t : cavity.triangles) std::swap(t.y, t.z);
    append(parts.restMesh, cavity);
    Actuator lift;
    lift.name = "lift";
    lift.deformer = Slide{{0.0F, 1.0F, 0.0F}, 0.0, 0.05};
    for (std::uint32_t v = 0; v < 8; ++v)
        if (parts.restMesh.positions[v].y > 0.05F) lift.influences.push_back({v, 1.0F});
    parts.actuators.push_back(std::move(lift));
    const Rig rig(std::move(parts));
    const VoxelFrame frame = frameOf(rig.reach(), 25);
    const Coverage coverage(rig, frame, kCoverageLevels);
    EXPECT_EQ(coverage.body(), voxelizeSolid(frame, rig.restMesh()));
    EXPECT_FALSE(coverage.body().test(12, 12, 12));
    EXPECT_TRUE(coverage.domain().test(12, 12, 12));
}

/// A hollow box in the hollow of another: each cavity is of the box around it, whichever comes first in the mesh.
TEST(Coverage, CavitiesBelongToTheSmallestShellAroundThem) {
    for (const bool innerFirst : {true, false}) {
        RigParts parts;
        parts.name = "nested";
        parts.pathInside = true;
        const auto addShell = [&](float from, float to, bool cavity) {
            TriangleMesh shell = test::boxMesh(glm::vec3(from), glm::vec3(to));
            if (cavity)
                for (glm::uvec3& t : shell.triangles) std::swap(t.y, t.z);
            append(parts.restMesh, shell);
        };
        for (const bool inner : {innerFirst, !innerFirst}) {
            const float aside = inner ? 0.0352F : 0.0F;
            addShell(aside, 0.1F - aside, false);
            addShell(aside + 0.0081F, 0.0919F - aside, true);
        }
        Actuator lift;
        lift.name = "lift";
        lift.deformer = Slide{{0.0F, 1.0F, 0.0F}, 0.0, 0.02};
        for (std::uint32_t v = 0; v < parts.restMesh.positions.size(); ++v)
            if (parts.restMesh.positions[v].y > 0.099F) lift.influences.push_back({v, 1.0F});
        parts.actuators.push_back(std::move(lift));
        const Rig rig(std::move(parts));
        const VoxelFrame frame = frameOf(rig.reach(), 30);
        const Coverage coverage(rig, frame, kCoverageLevels);
        // By plain geometry: within the walls of either box.
        const auto withinWalls = [](const glm::dvec3& p, double aside) {
            const double depth = std::min({p.x, p.y, p.z, 0.1 - p.x, 0.1 - p.y, 0.1 - p.z}) - aside;
            return depth > 0.0 && depth < 0.0081;
        };
        std::size_t wrong = 0;
        for (int z = 0; z < frame.dimensions.z; ++z)
            for (int x = 0; x < frame.dimensions.x; ++x)
                for (int y = 0; y < frame.dimensions.y; ++y) {
                    const glm::dvec3 p = frame.centre(x, y, z);
                    wrong += coverage.body().test(x, y, z) != (withinWalls(p, 0.0) || withinWalls(p, 0.0352));
                }
        EXPECT_EQ(wrong, 0U) << innerFirst;
    }
}

/// A tower whose two storeys slide up: its frame is more than two words of bits high.
Rig towerRig() {
    RigParts parts;
    parts.name = "tower";
    parts.pathInside = true;
    parts.restMesh = test::boxMesh({0.0F, 0.0F, 0.0F}, {0.0205F, 0.0713F, 0.0209F});
    const TriangleMesh core = test::boxMesh({0.0041F, 0.0012F, 0.0039F}, {0.0157F, 0.0702F, 0.0163F});
    for (const float length : {0.0611F, 0.1307F}) {
        Actuator lift;
        lift.name = "lift " + std::to_string(parts.actuators.size());
        lift.deformer = Slide{{0.0F, 1.0F, 0.0F}, 0.0, static_cast<double>(length)};
        parts.actuators.push_back(std::move(lift));
    }
    for (std::uint32_t v = 0; v < 8; ++v)
        if (parts.restMesh.positions[v].y > 0.05F) parts.actuators[0].influences.push_back({v, 1.0F});
    for (std::uint32_t v = 0; v < core.positions.size(); ++v)
        if (core.positions[v].y > 0.05F) parts.actuators[1].influences.push_back({8 + v, 1.0F});
    append(parts.restMesh, core);
    return Rig(std::move(parts));
}

// R6, R8: columns of several words are whole at every word, in coverage and background alike.
TEST(Coverage, TallFramesAgreeWithTheMeshAndTheirBackgroundWithTheMean) {
    const Rig rig = towerRig();
    BuildOptions options;
    options.resolution = 14;
    options.levels = 3;
    options.samples = 9;
    const Field field = buildField(rig, options);
    ASSERT_TRUE(field.exhaustive);
    ASSERT_GT(field.frame.dimensions.y, 128);
    const Coverage coverage(rig, field.frame, options.levels);
    CoverageScratch scratch;
    std::vector<int> counts(field.frame.voxelCount());
    std::size_t wrong = 0;
    for (const State& state : allStates(2, options.levels)) {
        BitColumns kept;
        BitColumns afresh;
        coverage.covered(state, kept, scratch);
        coverage.coveredAt(strokesOf(rig, state, options.levels), afresh, scratch);
        EXPECT_EQ(kept, afresh);
        const test::InsideOracle inside(deformed(rig, strokesOf(rig, state, options.levels)));
        for (int z = 0; z < field.frame.dimensions.z; ++z)
            for (int x = 0; x < field.frame.dimensions.x; ++x)
                for (int y = 0; y < field.frame.dimensions.y; ++y) {
                    const bool covered = inside(field.frame.centre(x, y, z)) && !field.body.test(x, y, z);
                    wrong += kept.test(x, y, z) != covered;
                    counts[field.voxelIndex(x, y, z)] += covered;
                }
    }
    EXPECT_EQ(wrong, 0U);
    std::size_t off = 0;
    for (std::size_t v = 0; v < counts.size(); ++v) off += field.background[v] != std::lround(255.0 * counts[v] / 9.0);
    EXPECT_EQ(off, 0U);
}

// The kept pieces are filled by whoever asks first; several threads may ask at once.
TEST(Coverage, ThreadsShareOne) {
    const Rig rig = test::lifterRig();
    const VoxelFrame frame = frameOf(rig.reach(), 14);
    const Coverage alone(rig, frame, kCoverageLevels);
    const Coverage shared(rig, frame, kCoverageLevels);
    std::array<std::vector<BitColumns>, 4> seen;
    {
        std::vector<std::jthread> threads;
        for (std::size_t t = 0; t < seen.size(); ++t)
            threads.emplace_back([&, t] {
                CoverageScratch scratch;
                for (int i = 0; i < 60; ++i)
                    shared.covered(State{Level{i % 9}, Level{(i / 3 + static_cast<int>(t)) % 9}, Level{i * 7 % 9}},
                                   seen[t].emplace_back(), scratch);
            });
    }
    CoverageScratch scratch;
    BitColumns expected;
    for (std::size_t t = 0; t < seen.size(); ++t)
        for (int i = 0; i < 60; ++i) {
            alone.covered(State{Level{i % 9}, Level{(i / 3 + static_cast<int>(t)) % 9}, Level{i * 7 % 9}}, expected,
                          scratch);
            ASSERT_EQ(seen[t][static_cast<std::size_t>(i)], expected) << t << " " << i;
        }
}

TEST(Coverage, RefusesLevelCountsOutOfRange) {
    const Rig rig = gateRig();
    const VoxelFrame frame = frameOf(rig.reach(), 10);
    EXPECT_THROW((void)Coverage(rig, frame, 1), InvalidInput);
    EXPECT_THROW((void)Coverage(rig, frame, kMaxLevels + 1), InvalidInput);
}

} // namespace
} // namespace lumorph
