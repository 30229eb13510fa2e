#include "app/studio/document/hand_control.h"

#include <gtest/gtest.h>

#include "app/workspaces/field/actuator_scale.h"
#include "tests/support/small_rigs.h"
#include "tests/ui/event_loop.h"

namespace lumorph::studio {
namespace {

class HandControlTest : public testing::Test {
protected:
    void SetUp() override {
        StudioState state;
        state.rig.rig = std::make_shared<const Rig>(test::cushionRig());
        state.strokes.assign(state.rig.rig->actuatorCount(), 0.25);
        document_.reset(state, {});
        ASSERT_TRUE(test::eventually([&] { return loop_.frame() != nullptr; }));
    }

    struct Application {
        Application() { test::needApplication(); }
    } application_;
    StudioDocument document_;
    StudioLoop loop_{document_};
    HandControl hand_{document_, loop_};
};

TEST_F(HandControlTest, ADragIsOneStepOfUndoThatTakesTheDeviceOffItsTarget) {
    ASSERT_EQ(document_.state().matching.driver, Driver::target);
    for (const double stroke : {0.3, 0.5, 0.8}) hand_.preview(1, stroke);
    EXPECT_EQ(document_.state().strokes, (std::vector<double>{0.25, 0.8, 0.25})) << "shown while it is dragged";
    hand_.commit(1, 1.0);
    EXPECT_EQ(document_.state().matching.driver, Driver::hand);
    EXPECT_EQ(document_.state().strokes, (std::vector<double>{0.25, 1.0, 0.25}));
    EXPECT_EQ(document_.undoStack().count(), 1);
    document_.undoStack().undo();
    EXPECT_EQ(document_.state().matching.driver, Driver::target) << "taken back in the same step";
    EXPECT_EQ(document_.state().strokes, (std::vector<double>{0.25, 0.25, 0.25}));
}

TEST_F(HandControlTest, EscapeLeavesNothingBehind) {
    hand_.preview(0, 0.9);
    hand_.cancel();
    EXPECT_EQ(document_.state().matching.driver, Driver::target);
    EXPECT_EQ(document_.state().strokes[0], 0.25);
    EXPECT_EQ(document_.undoStack().count(), 0);
}

TEST_F(HandControlTest, AllMoveAtOnceAndWithinTheirRange) {
    hand_.moveAll("Random levels", {2.0, -1.0});
    EXPECT_EQ(document_.state().strokes, (std::vector<double>{1.0, 0.0, 0.0}));
    EXPECT_EQ(document_.undoStack().count(), 1);
}

TEST(ActuatorScale, TurnsStrokesIntoDegreesLengthsAndShares) {
    Actuator bend;
    Bend right;
    right.max = Angle::degrees(90.0);
    bend.deformer = right;
    EXPECT_EQ(scaleOf(bend).quantity, Quantity::angle);
    EXPECT_DOUBLE_EQ(scaleOf(bend).valueOf(0.5), Angle::degrees(45.0).inRadians());
    EXPECT_DOUBLE_EQ(scaleOf(bend).strokeOf(Angle::degrees(22.5).inRadians()), 0.25);

    Actuator slide;
    slide.deformer = Slide{{0.0F, 1.0F, 0.0F}, 0.01, -0.03};
    EXPECT_EQ(scaleOf(slide).quantity, Quantity::length);
    EXPECT_DOUBLE_EQ(scaleOf(slide).valueOf(1.0), -0.03);
    EXPECT_NEAR(scaleOf(slide).strokeOf(-0.01), 0.5, 1e-12) << "a range that runs downwards";
    EXPECT_EQ(scaleOf(slide).strokeOf(1.0), 0.0);

    slide.deformer = Slide{{0.0F, 1.0F, 0.0F}, 0.01, 0.01};
    EXPECT_EQ(scaleOf(slide).strokeOf(0.01), 0.0) << "one that cannot move";
    EXPECT_EQ(nearestLevel(0.5, 33), 16);
    EXPECT_EQ(nearestLevel(1.0, 33), 32);
}

} // namespace
} // namespace lumorph::studio
