#include "core/motion/pose_book.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"

namespace lumorph {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<std::string> kThree = {"left", "middle", "right"};

PoseBook book() {
    PoseBook made;
    keepPose(made, "open", kThree, std::vector{1.0, 0.5, 0.25});
    keepPose(made, "shut", kThree, std::vector{0.0, 0.1, 0.2});
    made.sequence.steps = {{"open"}, {"shut"}, {"open"}};
    return made;
}

TEST(PoseBook, ARigWithOtherActuatorsTakesNothingFromThePoses) {
    PoseBook poses = book();
    const std::vector<std::string> other = {"right", "new", "left"};
    const PoseSequence there = sequenceFor(poses, other);
    EXPECT_THAT(there.poses[0].strokes, ElementsAre(0.25, 0.0, 1.0)) << "by name, in the rig's order";
    EXPECT_EQ(there.steps, poses.sequence.steps);
    EXPECT_THAT(fitOf(poses, other).atRest, ElementsAre("new"));
    EXPECT_THAT(fitOf(poses, other).kept, ElementsAre("middle"));
    // A pose kept with that rig, and one taken again, leave what the first rig had.
    keepPose(poses, "wide", other, std::vector{0.9, 0.8, 0.7});
    keepPose(poses, "open", other, std::vector{0.3, 0.2, 0.1});
    EXPECT_NO_THROW(requireSound(poses));
    const PoseSequence back = sequenceFor(poses, kThree);
    EXPECT_THAT(back.poses[0].strokes, ElementsAre(0.1, 0.5, 0.3));
    EXPECT_THAT(back.poses[1].strokes, ElementsAre(0.0, 0.1, 0.2));
    EXPECT_THAT(back.poses[2].strokes, ElementsAre(0.7, 0.0, 0.9));
    EXPECT_TRUE(fitOf(poses, other).atRest.empty());
}

TEST(PoseBook, FollowsAnActuatorThatWasRenamedAndNoneThatMoved) {
    PoseBook poses = book();
    followRenames(poses, kThree, std::vector<std::string>{"left", "heart", "right"});
    EXPECT_THAT(poses.actuators, ElementsAre("left", "heart", "right"));
    followRenames(poses, std::vector<std::string>{"left", "heart", "right"},
                  std::vector<std::string>{"right", "heart", "left"});
    EXPECT_THAT(poses.actuators, ElementsAre("left", "heart", "right"));
    followRenames(poses, kThree, std::vector<std::string>{"left"});
    EXPECT_THAT(poses.actuators, ElementsAre("left", "heart", "right"));
}

TEST(PoseBook, StepsFollowTheirPose) {
    PoseBook poses = book();
    renamePose(poses, "open", "bloom");
    EXPECT_EQ(poses.sequence.steps[2].pose, "bloom");
    EXPECT_EQ(freePoseName(poses, "bloom"), "bloom 2");
    EXPECT_EQ(freePoseName(poses, "open"), "open");
    removePose(poses, "bloom");
    ASSERT_EQ(poses.sequence.steps.size(), 1U);
    EXPECT_EQ(poses.sequence.steps[0].pose, "shut");
    EXPECT_NO_THROW(requireSound(poses));
}

TEST(PoseBook, RefusesAndStaysAsItWas) {
    PoseBook poses = book();
    const PoseBook before = poses;
    EXPECT_THROW(renamePose(poses, "open", "shut"), InvalidInput);
    EXPECT_THROW(renamePose(poses, "open", ""), InvalidInput);
    EXPECT_EQ(poses, before);
    poses.actuators[1] = "left";
    EXPECT_THROW(requireSound(poses), InvalidInput);
    poses.actuators[1].clear();
    EXPECT_THROW(requireSound(poses), InvalidInput);
}

} // namespace
} // namespace lumorph
