#include "core/mdf/field_story.h"

#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mdf/builder.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

constexpr BuildOptions kSmall{.resolution = 14, .levels = 6, .samples = 16, .seed = 3, .threads = 1};

template <typename Visit> void eachVoxel(const glm::ivec3& size, Visit&& visit) {
    for (int z = 0; z < size.z; ++z)
        for (int x = 0; x < size.x; ++x)
            for (int y = 0; y < size.y; ++y) visit(glm::ivec3(x, y, z));
}

BitColumns coveredBy(const Coverage& coverage, const State& state) {
    BitColumns bits;
    CoverageScratch scratch;
    coverage.covered(state, bits, scratch);
    return bits;
}

/// Every level of every actuator, then every two actuators at all their levels, with whole grids and nothing left out.
void expectLiteralReach(const Rig& rig) {
    SCOPED_TRACE(rig.name());
    const int levels = 5;
    const Coverage coverage(rig, frameOf(rig.reach(), 12), levels);
    const glm::ivec3 size = coverage.frame().dimensions;
    const std::size_t n = rig.actuatorCount();
    BitColumns alone(size), together(size);
    for (std::size_t a = 0; a < n; ++a)
        for (int level = 0; level < levels; ++level) {
            State state(n);
            state[a] = Level{level};
            alone |= coveredBy(coverage, state);
        }
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> pairs;
    for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = a + 1; b < n; ++b) {
            BitColumns both(size);
            for (int first = 0; first < levels; ++first)
                for (int second = 0; second < levels; ++second) {
                    State state(n);
                    state[a] = Level{first};
                    state[b] = Level{second};
                    both |= coveredBy(coverage, state);
                }
            both -= alone;
            if (both.count() > 0) pairs[{a, b}] = both.count();
            together |= both;
        }
    const JointReach reach = jointReach(coverage);
    EXPECT_EQ(reach.alone, alone);
    EXPECT_EQ(reach.together, together);
    ASSERT_EQ(reach.pairs.size(), pairs.size());
    for (std::size_t k = 0; k < reach.pairs.size(); ++k) {
        const JointReach::Pair& pair = reach.pairs[k];
        EXPECT_EQ(pair.voxels, (pairs[{pair.first, pair.second}]));
        EXPECT_LE(pair.voxels, reach.pairs[k == 0 ? 0 : k - 1].voxels);
    }
}

TEST(FieldStory, JointReachIsWhatAllLevelsOfAllPairsReach) {
    expectLiteralReach(test::cushionRig());
    expectLiteralReach(test::armRig());
    expectLiteralReach(test::lifterRig());
}

TEST(FieldStory, JointReachOfTheSmallRigsIsNotEmptyWhereActuatorsShareABody) {
    const auto together = [](const Rig& rig) {
        return jointReach(Coverage(rig, frameOf(rig.reach(), 12), 5)).together.count();
    };
    EXPECT_GT(together(test::armRig()), 0U) << "one hinge after the other reaches farther";
    EXPECT_GT(together(test::cushionRig()), 0U) << "two that lift the same top lift it higher";
    EXPECT_EQ(together(test::lifterRig()), 0U) << "boxes of their own";
}

TEST(FieldStory, JointReachIsCancelled) {
    const Rig rig = test::cushionRig();
    const Coverage coverage(rig, frameOf(rig.reach(), 12), 5);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW((void)jointReach(coverage, Progress({}, stop.get_token())), Cancelled);
}

TEST(FieldStory, PlanesHoldEveryVoxelOnceAndAsItIsSeen) {
    const glm::ivec3 size(4, 3, 5);
    for (const int axis : {0, 2}) {
        std::set<std::tuple<int, int, int>> seen;
        for (int index = 0; index < size[axis]; ++index) {
            const VoxelPlane plane{axis, index};
            const glm::ivec2 extent = sizeOf(plane, size);
            for (int across = 0; across < extent.x; ++across)
                for (int up = 0; up < extent.y; ++up) {
                    const glm::ivec3 v = voxelOf(plane, size, {across, up});
                    EXPECT_EQ(v[axis], index);
                    EXPECT_EQ(v.y, up);
                    seen.insert({v.x, v.y, v.z});
                }
        }
        EXPECT_EQ(seen.size(), 60U);
    }
    EXPECT_EQ(voxelOf({2, 1}, size, {0, 0}).x, 0) << "from the front, the left is x = 0";
    EXPECT_EQ(voxelOf({0, 1}, size, {0, 0}).z, 4) << "from the right, the left is what lies in front";
    const VoxelFrame frame{{0.1F, 0.2F, -0.3F}, 0.01, size};
    for (const VoxelPlane plane : {VoxelPlane{0, 2}, VoxelPlane{2, 3}})
        eachVoxel(size, [&](const glm::ivec3& v) {
            const glm::dvec2 place = placeIn(plane, frame, frame.centre(v.x, v.y, v.z));
            const glm::ivec3 back = voxelOf(plane, size, glm::ivec2(glm::floor(place)));
            EXPECT_EQ(back[2 - plane.axis], v[2 - plane.axis]);
            EXPECT_EQ(back.y, v.y);
        });
    EXPECT_NEAR(middleOf({2, 3}, frame), frame.centre(0, 0, 3).z, 1e-9);
}

/// A box with a bar on it that is raised like a lid about a line along x or z.
Rig lidRig(bool hingeAlongX) {
    RigParts parts;
    parts.name = "lid";
    parts.restMesh = test::boxMesh({-0.05F, 0.0F, -0.05F}, {0.05F, 0.02F, 0.05F});
    const auto lid = static_cast<std::uint32_t>(parts.restMesh.positions.size());
    append(parts.restMesh, test::boxMesh({-0.04F, 0.025F, -0.04F}, {0.04F, 0.03F, 0.04F}));
    Actuator raise;
    raise.name = "raise";
    Hinge hinge;
    hinge.origin = {-0.04F, 0.025F, -0.04F};
    hinge.axis = hingeAlongX ? glm::vec3(-1.0F, 0.0F, 0.0F) : glm::vec3(0.0F, 0.0F, 1.0F);
    hinge.max = Angle::degrees(60.0);
    raise.deformer = hinge;
    for (std::uint32_t v = lid; v < parts.restMesh.positions.size(); ++v) raise.influences.push_back({v, 1.0F});
    parts.actuators.push_back(raise);
    return Rig(parts);
}

TEST(FieldStory, TheTellingPlaneCutsAcrossAHinge) {
    for (const bool alongX : {true, false}) {
        const Rig rig = lidRig(alongX);
        const Field field = buildField(rig, kSmall);
        const VoxelPlane best = tellingPlane(field, rig, 0);
        EXPECT_EQ(best.axis, alongX ? 0 : 2);
        const std::vector<Ramp> ramps = denseRamps(field, 0);
        std::map<int, int> counts;
        eachVoxel(field.frame.dimensions, [&](const glm::ivec3& v) {
            if (ramps[field.voxelIndex(v.x, v.y, v.z)].v0 != kUnchanged) ++counts[v[best.axis]];
        });
        for (const auto& [index, count] : counts) EXPECT_LE(count, counts[best.index]);
        // The lid is as wide everywhere: of planes that are as full the middle one.
        EXPECT_NEAR(best.index, 0.5 * (field.frame.dimensions[best.axis] - 1), 1.0);
        EXPECT_THROW((void)tellingPlane(field, rig, 1), InvalidInput);
    }
}

TEST(FieldStory, TheFullestPlaneHoldsTheMostVoxels) {
    BitColumns bits(glm::ivec3(6, 4, 9));
    EXPECT_EQ(fullestPlane(bits), (VoxelPlane{2, 4})) << "the middle where there are none";
    for (int y = 0; y < 4; ++y)
        for (int z = 2; z < 8; ++z) bits.set(5, y, z);
    EXPECT_EQ(fullestPlane(bits), (VoxelPlane{0, 5}));
}

struct MatchedCushion {
    Field field = buildField(test::cushionRig(), kSmall);
    Coverage coverage{test::cushionRig(), field.frame, field.levels};
    Voting voting{field};
    BitColumns target = [this] {
        BitColumns bits = coveredBy(coverage, {Level{4}, Level{1}, Level{3}});
        const glm::ivec3 size = field.frame.dimensions;
        for (int x = 0; x < size.x; ++x) bits.set(x, 0, 0); // of the body, too
        return bits;
    }();
};

TEST(FieldStory, CandidatesAreTheTargetsVoxelsByTheLevelThatFirstCoversThem) {
    const MatchedCushion cushion;
    for (std::size_t a = 0; a < cushion.field.actuators.size(); ++a) {
        const std::vector<Ramp> ramps = denseRamps(cushion.field, a);
        std::vector<std::size_t> expected(static_cast<std::size_t>(cushion.field.levels), 0);
        eachVoxel(cushion.field.frame.dimensions, [&](const glm::ivec3& v) {
            const Ramp& ramp = ramps[cushion.field.voxelIndex(v.x, v.y, v.z)];
            if (cushion.target.test(v.x, v.y, v.z) && ramp.v0 != kUnchanged) ++expected[ramp.v0];
        });
        EXPECT_EQ(candidateCounts(cushion.field, a, cushion.target), expected);
    }
    EXPECT_THROW((void)candidateCounts(cushion.field, 9, cushion.target), InvalidInput);
    EXPECT_THROW((void)candidateCounts(cushion.field, 0, BitColumns(glm::ivec3(2))), InvalidInput);
}

TEST(FieldStory, TheMatchIsVotingAndTheBestStateNearIt) {
    const MatchedCushion cushion;
    const StoryMatch match = matchStory(cushion.coverage, cushion.voting, cushion.target);
    BitColumns wanted = cushion.target;
    wanted &= cushion.coverage.domain();
    EXPECT_EQ(match.target, wanted);
    EXPECT_EQ(match.voting.state, cushion.voting.match(wanted).state());
    for (const StoryMatch::Fit* fit : {&match.voting, &match.refined}) {
        EXPECT_EQ(fit->covered, coveredBy(cushion.coverage, fit->state));
        EXPECT_NEAR(fit->quality.iou(), intersectionOverUnion(fit->covered, wanted), 1e-12);
    }
    EXPECT_GE(match.refined.quality.iou(), match.voting.quality.iou());
    // No level of any single actuator does better.
    for (std::size_t a = 0; a < match.refined.state.size(); ++a)
        for (int level = 0; level < cushion.field.levels; ++level) {
            State other = match.refined.state;
            other[a] = Level{level};
            EXPECT_LE(intersectionOverUnion(coveredBy(cushion.coverage, other), wanted),
                      match.refined.quality.iou() + 1e-12);
        }
    EXPECT_THROW((void)matchStory(cushion.coverage, cushion.voting, BitColumns(glm::ivec3(3))), InvalidInput);
}

} // namespace
} // namespace lumorph
