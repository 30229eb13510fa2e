#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/loop/match_loop.h"
#include "core/mdf/frame_matcher.h"
#include "core/motion/rig_motion.h"
#include "tests/core/loop/loop_fixture.h"
#include "tests/support/literal_vote.h"
#include "tests/support/not_a_number.h"

namespace lumorph {
namespace {

using test::matchFieldOf;
using test::movingTarget;
using test::stillTarget;
using test::wishFor;

constexpr double kFrame = 1.0 / 60.0;

/// The target's voxels outside the body, by the one-off functions.
BitColumns voxelsOf(const MatchFrame& frame) {
    TriangleMesh mesh = meshAt(*frame.target, frame.seconds);
    for (glm::vec3& p : mesh.positions) p = glm::vec3(frame.deviceFromTarget * glm::vec4(p, 1.0F));
    BitColumns bits = voxelizeSolid(frame.field->field.frame, mesh);
    bits -= frame.field->field.body;
    return bits;
}

BitColumns coveredBy(const MatchField& field, const State& state) {
    BitColumns bits;
    CoverageScratch scratch;
    field.coverage.covered(state, bits, scratch);
    return bits;
}

double iouOf(const MatchField& field, const State& state, const BitColumns& target) {
    return intersectionOverUnion(coveredBy(field, state), target);
}

/// A block over one half of the device.
std::shared_ptr<const MatchTarget> block() {
    return stillTarget(test::boxMesh({0.0F, 0.0F, 0.0F}, {0.06F, 0.04F, 0.05F}));
}

class MatchLoopTest : public testing::Test {
protected:
    std::shared_ptr<const MatchField> field_ = matchFieldOf(test::cushionRig());
    ManualClock clock_;
    MatchLoop loop_{clock_};
};

// R16, R18
TEST_F(MatchLoopTest, StateIsThatOfVotingAndRefinement) {
    MatchWish wish = wishFor(field_, block());
    const auto refined = loop_.step(wish, 0.0);
    ASSERT_TRUE(refined->matched);
    const BitColumns target = voxelsOf(*refined);
    const Votes votes = field_->voting.match(target);
    const Refinement expected = Refiner(field_->coverage).refine(target, votes.state(), Microseconds{0}, clock_);
    EXPECT_EQ(refined->wanted, expected.state);
    EXPECT_NEAR(refined->iouVoting, iouOf(*field_, votes.state(), target), 1e-12);
    EXPECT_NEAR(refined->iouWanted, iouOf(*field_, expected.state, target), 1e-12);
    EXPECT_EQ(refined->statesSeen, expected.statesSeen);
    EXPECT_EQ(refined->votes->targetVoxels, target.count());
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(refined->votes->actuators[i].errors, votes.actuators[i].errors);
        EXPECT_DOUBLE_EQ(refined->wantedStrokes[i], expected.state[i].index / 8.0);
    }

    wish.method = MatchMethod::voting;
    const auto voted = loop_.step(wish, kFrame);
    EXPECT_EQ(voted->wanted, votes.state());
    EXPECT_EQ(voted->statesSeen, 0);
    EXPECT_EQ(voted->iouWanted, voted->iouVoting);
}

// A stroke of a vote lies between the levels, and says more than they do.
TEST_F(MatchLoopTest, VotedStrokesAreThoseOfTheLiteralEquation) {
    int between = 0;
    for (double seconds = 0.1; seconds < 2.0; seconds += 0.3) {
        MatchWish wish = wishFor(field_, movingTarget());
        wish.method = MatchMethod::voting;
        wish.playing = false;
        wish.seek = seconds;
        MatchLoop loop(clock_);
        const auto frame = loop.step(wish, 0.0);
        const BitColumns target = voxelsOf(*frame);
        for (std::size_t i = 0; i < 3; ++i) {
            const test::LiteralVote literal = test::literalVote(field_->field, i, target);
            EXPECT_EQ(frame->wanted[i].index, literal.level);
            EXPECT_NEAR(frame->wantedStrokes[i], test::literalStroke(literal), 1e-6);
            between += std::abs(8.0 * frame->wantedStrokes[i] - literal.level) > 1e-3;
        }
    }
    EXPECT_GE(between, 3);
}

TEST_F(MatchLoopTest, FollowsAnAnimationWithoutFlicker) {
    const MatchWish wish = wishFor(field_, movingTarget());
    Refiner refiner(field_->coverage);
    State last;
    int changes = 0;
    for (int k = 0; k < 150; ++k) {
        const auto frame = loop_.step(wish, kFrame);
        const BitColumns target = voxelsOf(*frame);
        const double iou = iouOf(*field_, frame->wanted, target);
        EXPECT_NEAR(frame->iouWanted, iou, 1e-12);
        const State fresh = refiner.refine(target, field_->voting.match(target).state(), Microseconds{0}, clock_).state;
        EXPECT_GE(iou, 0.97 * iouOf(*field_, fresh, target)) << "frame " << k;
        if (!last.empty() && frame->wanted != last) {
            EXPECT_GT(iou, iouOf(*field_, last, target) + FrameMatcher::kStay);
            ++changes;
        }
        last = frame->wanted;
        EXPECT_NEAR(std::remainder(frame->seconds - k * kFrame, 2.0), 0.0, 1e-9);
    }
    EXPECT_GT(changes, 3);
}

// R17: what is reached is measured on the true volume.
TEST_F(MatchLoopTest, ReachedVolumeIsThatOfTheEstimatedStrokes) {
    const MatchWish wish = wishFor(field_, movingTarget());
    CoverageScratch scratch;
    for (int k = 0; k < 60; ++k) {
        const auto frame = loop_.step(wish, kFrame);
        BitColumns reached;
        field_->coverage.coveredAt(frame->estimatedStrokes, reached, scratch);
        EXPECT_NEAR(frame->iouEstimated, intersectionOverUnion(reached, voxelsOf(*frame)), 1e-12);
        EXPECT_EQ(*frame->devicePositions, deformed(field_->rig, frame->estimatedStrokes).positions);
    }
}

TEST_F(MatchLoopTest, ClassesAndVolumesAgreeWithEveryVoxel) {
    const MatchWish wish = wishFor(field_, movingTarget());
    for (int k = 0; k < 20; ++k) {
        const auto frame = loop_.step(wish, 0.07);
        const BitColumns target = voxelsOf(*frame);
        const BitColumns covered = coveredBy(*field_, frame->wanted);
        const BitColumns reachable = reachableVoxels(field_->field);
        const glm::ivec3 size = field_->field.frame.dimensions;
        ASSERT_EQ(frame->classes->size(), field_->field.frame.voxelCount());
        std::size_t counts[4] = {};
        std::size_t unreachable = 0;
        for (int z = 0, i = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x, ++i) {
                    const bool wanted = target.test(x, y, z);
                    const bool in = covered.test(x, y, z);
                    const int expected = wanted && in ? kVoxelMatched
                                         : wanted     ? kVoxelUnmatched
                                         : in         ? kVoxelOverfilled
                                                      : 0;
                    ASSERT_EQ((*frame->classes)[static_cast<std::size_t>(i)], expected) << x << ' ' << y << ' ' << z;
                    ++counts[expected];
                    unreachable += wanted && !reachable.test(x, y, z);
                }
        const double volume = field_->field.frame.voxelVolume();
        EXPECT_DOUBLE_EQ(frame->unmatchedVolume, static_cast<double>(counts[kVoxelUnmatched]) * volume);
        EXPECT_DOUBLE_EQ(frame->overfilledVolume, static_cast<double>(counts[kVoxelOverfilled]) * volume);
        EXPECT_DOUBLE_EQ(frame->targetVolume, static_cast<double>(target.count()) * volume);
        EXPECT_DOUBLE_EQ(frame->shareUnreachable,
                         static_cast<double>(unreachable) / static_cast<double>(target.count()));
        EXPECT_GT(counts[kVoxelMatched], 0U);
    }
}

/// A block on the device that grows and shrinks every two seconds.
std::shared_ptr<const MatchTarget> breathingBlock() {
    Model model = modelOf(test::boxMesh({0.01F, 0.0F, 0.01F}, {0.09F, 0.03F, 0.07F}), "block");
    Model::Animation animation;
    animation.name = "breathe";
    animation.channels.push_back(
        {0, Model::Path::scale, Model::Interpolation::linear, {0.0F, 1.0F, 2.0F}, {1, 0.2F, 1, 1, 1, 1, 1, 0.2F, 1}});
    model.animations.push_back(animation);
    MatchTarget target;
    target.name = "breathing";
    target.model = std::make_shared<const Model>(std::move(model));
    target.solid = makeTarget(flatten(*target.model, animation, 0.0));
    target.animation = 0;
    target.duration = 2.0;
    target.box = boxOverAnimation(*target.model, animation, 20, 10.0);
    return std::make_shared<const MatchTarget>(std::move(target));
}

// R19: the commands lead to where the target will be on arrival, within the velocity limits.
TEST_F(MatchLoopTest, ComesNearerToATargetThatMovesThanByFollowingIt) {
    MatchWish wish = wishFor(field_, breathingBlock());
    wish.budget = std::chrono::seconds(10);
    MotionModel following(motionLimits(field_->rig));
    CoverageScratch scratch;
    BitColumns covered;
    double led = 0.0, followed = 0.0;
    std::vector<double> last(3, 0.0);
    for (int k = 0; k < 240; ++k) {
        const double passed = k == 0 ? 0.0 : kFrame;
        const auto frame = loop_.step(wish, passed);
        led += frame->iouEstimated / 240;
        field_->coverage.coveredAt(following.step(frame->wantedStrokes, passed), covered, scratch);
        followed += intersectionOverUnion(covered, voxelsOf(*frame)) / 240;
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_LE(std::abs(frame->estimatedStrokes[i] - last[i]),
                      field_->rig.actuators()[i].maxVelocity * kFrame + 1e-9);
        last = frame->estimatedStrokes;
    }
    std::printf("led %.4f, followed %.4f\n", led, followed);
    EXPECT_GT(led, followed + 0.01);
    // Once the target stands still, the commands are the strokes wanted.
    wish.playing = false;
    auto frame = loop_.step(wish, kFrame);
    for (int k = 0; k < 400 && !loop_.settled(); ++k) frame = loop_.step(wish, kFrame);
    EXPECT_TRUE(loop_.settled());
    EXPECT_EQ(frame->estimatedStrokes, frame->wantedStrokes);
}

TEST_F(MatchLoopTest, WhatStandsStillIsNotWorkedOutAgain) {
    const test::TickingClock clock;
    MatchLoop loop(clock);
    MatchWish wish = wishFor(field_, block());
    wish.budget = std::chrono::seconds(10);
    auto last = loop.step(wish, 0.0);
    EXPECT_GT(last->ms.voxelize, 0.0);
    EXPECT_GT(last->ms.refine, 0.0);
    EXPECT_EQ(last->targetPositions->data(), wish.target->solid.mesh.positions.data()) << "not copied";
    for (int k = 0; k < 400; ++k) {
        const auto frame = loop.step(wish, kFrame);
        EXPECT_EQ(frame->ms.pose + frame->ms.voxelize + frame->ms.match + frame->ms.refine, 0.0);
        EXPECT_EQ(frame->targetPositions, last->targetPositions);
        EXPECT_EQ(frame->classes, last->classes);
        EXPECT_EQ(frame->votes, last->votes);
        EXPECT_EQ(frame->wanted, last->wanted);
        EXPECT_EQ(frame->devicePositions == last->devicePositions, frame->estimatedStrokes == last->estimatedStrokes);
        last = frame;
    }
    EXPECT_TRUE(loop.settled());
    EXPECT_EQ(last->estimatedStrokes, last->wantedStrokes);
    EXPECT_EQ(last->iouEstimated, last->iouWanted);

    wish.placement.translation.x += 0.01F;
    const auto moved = loop.step(wish, kFrame);
    EXPECT_GT(moved->ms.voxelize, 0.0);
    EXPECT_EQ(moved->ms.pose, 0.0);
    EXPECT_EQ(moved->targetPositions, last->targetPositions);
    EXPECT_NEAR(moved->iouWanted, iouOf(*field_, moved->wanted, voxelsOf(*moved)), 1e-12);
}

// Servos that stand still reach another share of a target that is moved.
TEST_F(MatchLoopTest, WhatIsReachedIsJudgedAnewWhenTheTargetMoves) {
    MatchWish wish = wishFor(field_, block());
    wish.driver = Driver::hand;
    wish.strokes = {0.5, 0.75, 0.25};
    for (int k = 0; k < 400; ++k) (void)loop_.step(wish, kFrame);
    CoverageScratch scratch;
    BitColumns reached;
    std::set<double> seen;
    for (const float aside : {0.0F, 0.012F, -0.03F}) {
        MatchWish moved = wish;
        moved.placement.translation.x += aside;
        const auto frame = loop_.step(moved, kFrame);
        ASSERT_EQ(frame->estimatedStrokes, wish.strokes);
        field_->coverage.coveredAt(frame->estimatedStrokes, reached, scratch);
        EXPECT_NEAR(frame->iouEstimated, intersectionOverUnion(reached, voxelsOf(*frame)), 1e-12) << aside;
        seen.insert(frame->iouEstimated);
    }
    EXPECT_EQ(seen.size(), 3U);
}

// A level is kept while it is nearly as good, but not for another target: that one is matched as if it came first.
TEST_F(MatchLoopTest, AnotherTargetIsMatchedAsIfItCameFirst) {
    const auto boxOf = [](float height) {
        return stillTarget(test::boxMesh({0.0F, 0.0F, 0.0F}, {0.08F, height, 0.06F}));
    };
    std::set<int> levels;
    for (int k = 0; k < 160; ++k) {
        MatchWish wish = wishFor(field_, boxOf(0.002F + 0.0002F * static_cast<float>(k)));
        wish.placement.scale = 0.9; // so that another height is another level
        wish.method = MatchMethod::voting;
        const auto after = loop_.step(wish, 0.0);
        EXPECT_EQ(after->wanted, MatchLoop(clock_).step(wish, 0.0)->wanted) << k;
        levels.insert(after->wanted[0].index);
    }
    EXPECT_GT(levels.size(), 2U);
}

TEST_F(MatchLoopTest, RefinementOfAStillTargetGoesOnUntilNothingHelps) {
    const test::TickingClock clock;
    MatchLoop loop(clock);
    MatchWish wish = wishFor(field_, block());
    wish.budget = Microseconds{4}; // looks at a few states only
    auto frame = loop.step(wish, 0.0);
    const BitColumns target = voxelsOf(*frame);
    const Refinement whole = Refiner(field_->coverage).refine(target, field_->voting.match(target).state(), {}, clock_);
    ASSERT_LT(frame->statesSeen, whole.statesSeen / 4);
    double iou = frame->iouWanted;
    for (int k = 0; k < 1000 && !loop.settled(); ++k) {
        frame = loop.step(wish, kFrame);
        EXPECT_GE(frame->iouWanted, iou);
        iou = frame->iouWanted;
    }
    EXPECT_TRUE(loop.settled());
    EXPECT_EQ(frame->wanted, whole.state);
}

// R19
TEST_F(MatchLoopTest, EstimateStaysWithinTheVelocityLimits) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    MatchWish wish = wishFor(field_, nullptr);
    std::vector<double> last = loop_.step(wish, 0.0)->estimatedStrokes;
    double farthest = 0.0;
    for (int k = 0; k < 2000; ++k) {
        if (random() % 7 == 0)
            for (double& stroke : wish.strokes) stroke = share(random);
        wish.stopped = random() % 10 == 0;
        const double seconds = 0.05 * share(random);
        const auto frame = loop_.step(wish, seconds);
        EXPECT_EQ(frame->wantedStrokes, wish.strokes);
        for (std::size_t i = 0; i < last.size(); ++i) {
            const double moved = std::abs(frame->estimatedStrokes[i] - last[i]);
            EXPECT_LE(moved, wish.rig->actuators()[i].maxVelocity * seconds * (1.0 + 1e-9));
            farthest = std::max(farthest, moved);
        }
        last = frame->estimatedStrokes;
    }
    EXPECT_GT(farthest, 0.005);
}

TEST_F(MatchLoopTest, StopHoldsAndGoesOnSoftly) {
    MatchWish wish = wishFor(field_, nullptr);
    wish.strokes = {1.0, 0.5, 0.8};
    for (int k = 0; k < 20; ++k) (void)loop_.step(wish, kFrame);
    const auto moving = loop_.step(wish, kFrame);
    ASSERT_GT(moving->estimatedStrokes[0], 0.01);
    ASSERT_LT(moving->estimatedStrokes[0], 0.9);
    wish.stopped = true;
    for (int k = 0; k < 60; ++k) {
        const auto frame = loop_.step(wish, kFrame);
        EXPECT_EQ(frame->estimatedStrokes, moving->estimatedStrokes);
        EXPECT_EQ(frame->devicePositions, moving->devicePositions);
        EXPECT_EQ(frame->wantedStrokes, wish.strokes);
        EXPECT_TRUE(loop_.settled());
    }
    wish.stopped = false;
    double last = moving->estimatedStrokes[0];
    double lastStep = 0.0;
    for (int k = 0; k < 10; ++k) {
        const double now = loop_.step(wish, kFrame)->estimatedStrokes[0];
        if (k == 0) {
            EXPECT_LT(now - last, 0.3 * wish.rig->actuators()[0].maxVelocity * kFrame) << "starts slowly";
        }
        EXPECT_GE(now - last, lastStep);
        lastStep = now - last;
        last = now;
    }
    for (int k = 0; k < 600; ++k) (void)loop_.step(wish, kFrame);
    EXPECT_EQ(loop_.step(wish, kFrame)->estimatedStrokes, wish.strokes);
}

TEST_F(MatchLoopTest, AnimationWrapsSeeksAndStarts) {
    MatchWish wish = wishFor(field_, movingTarget());
    const auto first = loop_.step(wish, 0.5);
    EXPECT_EQ(first->seconds, 0.0) << "a new target starts at its beginning";
    EXPECT_NEAR(loop_.step(wish, 1.5)->seconds, 1.5, 1e-12);
    const auto wrapped = loop_.step(wish, 0.75);
    EXPECT_NEAR(wrapped->seconds, 0.25, 1e-12);
    EXPECT_EQ(*wrapped->targetPositions, meshAt(*wish.target, 0.25).positions);
    EXPECT_NE(*wrapped->targetPositions, *first->targetPositions);
    EXPECT_FALSE(loop_.settled());
    wish.playing = false;
    const auto paused = loop_.step(wish, 0.3);
    EXPECT_EQ(paused->seconds, wrapped->seconds);
    EXPECT_EQ(paused->targetPositions, wrapped->targetPositions);
    wish.seek = 1.2;
    const auto sought = loop_.step(wish, 0.3);
    EXPECT_EQ(sought->seconds, 1.2);
    EXPECT_EQ(*sought->targetPositions, meshAt(*wish.target, 1.2).positions);
    wish.seek = 2.0;
    EXPECT_EQ(loop_.step(wish, 0.3)->seconds, 2.0) << "the end can be looked at";
}

TEST_F(MatchLoopTest, SpinTurnsTheTargetOnTopOfItsPlacement) {
    MatchWish wish = wishFor(field_, block());
    wish.placement.yaw = Angle::degrees(10.0);
    wish.spin = 0.5;
    (void)loop_.step(wish, 0.0);
    const auto frame = loop_.step(wish, 0.4);
    EXPECT_NEAR(frame->turned.inRadians(), 0.2, 1e-12);
    EXPECT_FALSE(loop_.settled());
    Placement turned = wish.placement;
    turned.yaw = Angle::radians(wish.placement.yaw.inRadians() + 0.2);
    const TriangleMesh expected = placed(wish.target->solid.mesh, turned);
    for (std::size_t v = 0; v < expected.positions.size(); ++v) {
        const glm::vec3 p(frame->deviceFromTarget * glm::vec4((*frame->targetPositions)[v], 1.0F));
        EXPECT_LT(glm::length(p - expected.positions[v]), 1e-6F);
    }
    EXPECT_NEAR(frame->iouWanted, iouOf(*field_, frame->wanted, voxelsOf(*frame)), 1e-12);
}

TEST_F(MatchLoopTest, HeldStateIsMeasuredAgainstTheTarget) {
    MatchWish wish = wishFor(field_, block());
    wish.driver = Driver::hand;
    wish.strokes = {0.5, 1.7, -0.25};
    const auto frame = loop_.step(wish, kFrame);
    EXPECT_EQ(frame->wantedStrokes, (std::vector<double>{0.5, 1.0, 0.0}));
    EXPECT_EQ(frame->wanted, (State{Level{4}, Level{8}, Level{0}}));
    EXPECT_TRUE(frame->matched);
    EXPECT_NEAR(frame->iouWanted, iouOf(*field_, frame->wanted, voxelsOf(*frame)), 1e-12);
    EXPECT_NEAR(frame->iouVoting, iouOf(*field_, frame->votes->state(), voxelsOf(*frame)), 1e-12);
    wish.driver = Driver::target;
    EXPECT_GE(loop_.step(wish, kFrame)->iouWanted, frame->iouVoting);
}

TEST_F(MatchLoopTest, WithoutAFieldItMovesAndDeforms) {
    MatchWish wish = wishFor(field_, block());
    wish.field = nullptr;
    wish.strokes = {0.2, 0.4, 0.6};
    (void)loop_.step(wish, 0.0);
    const auto frame = loop_.step(wish, 0.2);
    EXPECT_FALSE(frame->matched);
    EXPECT_TRUE(frame->wanted.empty());
    EXPECT_EQ(frame->votes, nullptr);
    EXPECT_GT(frame->estimatedStrokes[2], 0.0);
    EXPECT_EQ(*frame->devicePositions, deformed(*wish.rig, frame->estimatedStrokes).positions);
    EXPECT_EQ(*frame->targetPositions, wish.target->solid.mesh.positions);
}

// R42
TEST_F(MatchLoopTest, TargetBeyondTheFrameIsNotCalledAMatch) {
    MatchWish wish = wishFor(field_, block());
    wish.placement.translation.x += 10.0F;
    const auto frame = loop_.step(wish, kFrame);
    EXPECT_TRUE(frame->matched);
    EXPECT_EQ(frame->targetVolume, 0.0);
    EXPECT_EQ(frame->shareBeyondFrame, 1.0);
    EXPECT_EQ(frame->iouWanted, 0.0);
    EXPECT_EQ(frame->iouEstimated, 0.0);
    EXPECT_EQ(frame->wanted, State(3));
}

TEST_F(MatchLoopTest, ActuatorsStayWhereTheyAreInTheSameRig) {
    MatchWish wish = wishFor(field_, nullptr);
    wish.strokes = {0.7, 0.3, 0.9};
    for (int k = 0; k < 30; ++k) (void)loop_.step(wish, kFrame);
    const auto before = loop_.step(wish, kFrame);
    wish.field = nullptr;
    wish.rig = std::make_shared<const Rig>(test::cushionRig());
    EXPECT_EQ(loop_.step(wish, 0.0)->estimatedStrokes, before->estimatedStrokes);
    wish.rig = std::make_shared<const Rig>(test::lifterRig());
    ASSERT_EQ(wish.rig->actuatorCount(), 3U);
    const auto other = loop_.step(wish, 0.0);
    EXPECT_EQ(other->estimatedStrokes, std::vector<double>(3, 0.0));
    EXPECT_EQ(other->devicePositions->size(), wish.rig->restMesh().positions.size());
}

// A drag of a rig's numbers makes a new rig with every frame.
TEST_F(MatchLoopTest, ActuatorsGoOnWithoutAJumpInARigThatIsEdited) {
    MatchWish wish = wishFor(field_, nullptr);
    wish.driver = Driver::hand;
    wish.rigOrigin = wish.rig;
    wish.strokes = {1.0, 0.5, 0.8}; // all move, the renamed one too
    MatchWish still = wish;
    MatchLoop reference(clock_);
    for (int i = 0; i < 20; ++i) {
        RigParts parts = wish.rig->parts();
        parts.actuators[2].name = "renamed " + std::to_string(i);
        wish.rig = std::make_shared<const Rig>(std::move(parts));
        const auto frame = loop_.step(wish, kFrame);
        EXPECT_EQ(frame->rig, wish.rig);
        EXPECT_EQ(frame->estimatedStrokes, reference.step(still, kFrame)->estimatedStrokes) << "frame " << i;
    }
    const auto last = loop_.step(wish, 0.0);
    ASSERT_GT(last->estimatedStrokes[0], 0.1);

    // Fewer, and in another order: each goes on by its name.
    RigParts parts = wish.rig->parts();
    std::swap(parts.actuators[0], parts.actuators[1]);
    parts.actuators.pop_back();
    wish.rig = std::make_shared<const Rig>(std::move(parts));
    wish.field = nullptr;
    wish.strokes = {0.5, 1.0};
    const auto fewer = loop_.step(wish, 0.0);
    EXPECT_EQ(fewer->estimatedStrokes, (std::vector<double>{last->estimatedStrokes[1], last->estimatedStrokes[0]}));

    // Another rig with as many actuators begins at rest.
    parts = wish.rig->parts();
    for (Actuator& actuator : parts.actuators) actuator.name += " of another";
    wish.rig = std::make_shared<const Rig>(std::move(parts));
    wish.rigOrigin = wish.rig;
    EXPECT_EQ(loop_.step(wish, 0.0)->estimatedStrokes, std::vector<double>(2, 0.0));
}

TEST_F(MatchLoopTest, DanceIsLivelyAndTheSameEveryTime) {
    MatchWish wish = wishFor(field_, nullptr);
    wish.driver = Driver::dance;
    MatchLoop other(clock_);
    std::vector<double> last;
    std::vector<double> changes;
    for (int k = 0; k < 1200; ++k) {
        const auto frame = loop_.step(wish, kFrame);
        EXPECT_EQ(frame->wantedStrokes, other.step(wish, kFrame)->wantedStrokes);
        EXPECT_FALSE(loop_.settled());
        if (frame->wantedStrokes != last) changes.push_back(k * kFrame);
        last = frame->wantedStrokes;
        for (const double stroke : last) EXPECT_TRUE(stroke >= 0.0 && stroke <= 1.0);
    }
    ASSERT_GT(changes.size(), 12U);
    for (std::size_t i = 1; i < changes.size(); ++i) {
        EXPECT_GE(changes[i] - changes[i - 1], 0.6 - 1e-9);
        EXPECT_LE(changes[i] - changes[i - 1], 1.4 + kFrame + 1e-9);
    }
    wish.driver = Driver::hand;
    EXPECT_EQ(loop_.step(wish, kFrame)->wantedStrokes, wish.strokes);
}

// Each frame against the poses' own formula, written out here; STOP holds the device whatever plays.
TEST_F(MatchLoopTest, PosesPlayByHandUnderTheMotionLimits) {
    MatchWish wish = wishFor(field_, nullptr);
    wish.driver = Driver::hand;
    const std::size_t count = wish.rig->actuatorCount();
    const std::vector<double> from(count, 0.0);
    auto play = std::make_shared<PosePlay>();
    play->sequence.poses = {{"up", std::vector<double>(count, 1.0)}};
    play->sequence.steps = {{"up", 2.0, 0.5, Easing::smooth}};
    play->from = from;
    play->since = clock_.now();
    wish.posePlay = play;
    MotionModel motion(motionLimits(*wish.rig));
    for (int k = 0; k <= 150; ++k) {
        const auto frame = loop_.step(wish, k == 0 ? 0.0 : kFrame);
        const double u = std::min(1.0, 1e-6 * static_cast<double>((frame->time - play->since).count()) / 2.0);
        ASSERT_TRUE(frame->poseSeconds);
        EXPECT_NEAR(*frame->poseSeconds, 1e-6 * static_cast<double>((frame->time - play->since).count()), 1e-12);
        const std::vector<double> wanted(count, u * u * (3.0 - 2.0 * u));
        for (std::size_t a = 0; a < count; ++a) ASSERT_NEAR(frame->wantedStrokes[a], wanted[a], 1e-12);
        const auto moved = motion.step(wanted, k == 0 ? 0.0 : kFrame);
        for (std::size_t a = 0; a < count; ++a) ASSERT_NEAR(frame->estimatedStrokes[a], moved[a], 1e-9);
        if (*frame->poseSeconds < 2.5) {
            EXPECT_FALSE(loop_.settled());
        }
        clock_.advance(Microseconds(static_cast<std::int64_t>(1e6 * kFrame)));
    }
    wish.stopped = true;
    play = std::make_shared<PosePlay>(*play);
    play->since = clock_.now();
    wish.posePlay = play;
    const auto before = loop_.step(wish, 0.0)->estimatedStrokes;
    clock_.advance(Microseconds(1'000'000));
    EXPECT_EQ(loop_.step(wish, 1.0)->estimatedStrokes, before);
    wish.stopped = false;
    play->from.pop_back();
    EXPECT_THROW((void)loop_.step(wish, kFrame), InvalidInput);
    wish.driver = Driver::target;
    EXPECT_FALSE(loop_.step(wish, kFrame)->poseSeconds) << "poses are the hand's";
}

TEST_F(MatchLoopTest, ADanceDoesNotMakeUpForAPause) {
    MatchWish wish = wishFor(field_, nullptr);
    wish.driver = Driver::dance;
    (void)loop_.step(wish, kFrame);
    std::vector<double> last = loop_.step(wish, 60.0)->wantedStrokes;
    int changes = 0;
    for (int k = 0; k < 30; ++k) {
        const auto frame = loop_.step(wish, kFrame);
        changes += frame->wantedStrokes != last;
        last = frame->wantedStrokes;
    }
    EXPECT_EQ(changes, 0) << "half a second after a new pose";
}

TEST_F(MatchLoopTest, WishesThatContradictThemselvesAreRefused) {
    struct Case {
        const char* subject;
        void (*spoil)(MatchWish& wish, double& seconds);
    };
    const Case cases[] = {
        {"device", [](MatchWish& w, double&) { w.rig = nullptr; }},
        {"strokes", [](MatchWish& w, double&) { w.strokes.pop_back(); }},
        {"strokes", [](MatchWish& w, double&) { w.strokes.clear(); }},
        {"stroke", [](MatchWish& w, double&) { w.strokes[1] = kNan; }},
        {"stroke", [](MatchWish& w, double&) { w.strokes[1] = INFINITY; }},
        {"spin", [](MatchWish& w, double&) { w.spin = kNan; }},
        {"animation time", [](MatchWish& w, double&) { w.seek = kNan; }},
        {"scale of the target", [](MatchWish& w, double&) { w.placement.scale = 0.0; }},
        {"yaw of the target", [](MatchWish& w, double&) { w.placement.yaw = Angle::radians(kNan); }},
        {"position of the target", [](MatchWish& w, double&) { w.placement.translation.y = INFINITY; }},
        {"time for refinement", [](MatchWish& w, double&) { w.budget = Microseconds{0}; }},
        {"time step", [](MatchWish&, double& seconds) { seconds = -1.0; }},
        {"time step", [](MatchWish&, double& seconds) { seconds = kNan; }},
    };
    for (const Case& c : cases) {
        MatchWish wish = wishFor(field_, block());
        wish.driver = Driver::hand;
        double seconds = kFrame;
        c.spoil(wish, seconds);
        try {
            (void)loop_.step(wish, seconds);
            ADD_FAILURE() << c.subject << " was taken";
        } catch (const InvalidInput& error) {
            EXPECT_EQ(error.subject(), c.subject);
        }
    }
    EXPECT_EQ(loop_.step(wishFor(field_, block()), kFrame)->number, 1U) << "refused wishes leave nothing behind";
}

TEST(MatchField, RefusesAFieldWhoseRigIsNotThere) {
    Field field = matchFieldOf(test::cushionRig(), 8, 3)->field;
    Field other = field;
    other.actuators.pop_back();
    EXPECT_THROW(MatchField{std::move(other)}, DataError);
    field.rigGlb.clear();
    EXPECT_THROW(MatchField{std::move(field)}, DataError);
}

} // namespace
} // namespace lumorph
