#include <cmath>

#include <gtest/gtest.h>

#include "core/loop/show_program.h"
#include "core/mdf/builder.h"
#include "core/show/project_contents.h"
#include "core/show/show_player.h"
#include "tests/support/cut_tablet.h"

// A show without a window: a program, a project and a demonstration played by a clock that the test owns.

namespace lumorph::test {
namespace {

/// A tide that keys raise, felt and seen: the smallest whole application.
class TideProgram final : public ShowProgram {
public:
    ShowContent frame(const ShowMoment& moment) override {
        for (const ShowInput& input : moment.inputs)
            if (input.name == "key.up") level_ += 0.004 * input.value;
        const double height = level_ + 0.003 * std::sin(2.0 * moment.seconds);

        auto scene = std::make_shared<Scene>(defaultScene());
        SceneItem sea;
        sea.id = 2;
        sea.name = "Sea";
        sea.position.y = static_cast<float>(height);
        sea.kind = HeightItem{};
        scene->items.push_back(sea);

        const Box box = boundingBox(moment.rig->restMesh().positions);
        HeightGrid grid{{box.min.x, box.min.z}, {box.max.x, box.max.z}, 16, 12, {}};
        grid.heights.assign(16 * 12, box.max.y + static_cast<float>(height));
        return {std::move(scene), nullptr, std::move(grid), Following::matched, true, {}, {}, {}};
    }

private:
    double level_ = 0.006;
};

MatchWish tideWish() {
    static const auto field = std::make_shared<const MatchField>(buildField(test::cutTablet(), BuildOptions{}));
    MatchWish wish;
    wish.field = field;
    wish.rig = {field, &field->rig};
    wish.strokes.assign(wish.rig->actuatorCount(), 0.0);
    wish.installation = std::make_shared<const Installation>(defaultInstallation());
    wish.program = std::make_shared<TideProgram>();
    wish.inputs = std::make_shared<ShowInputs>();
    wish.driver = Driver::program;
    return wish;
}

/// Plays the tide for two seconds; a key is pressed at three frames.
std::vector<std::shared_ptr<const MatchFrame>> playTide() {
    ManualClock clock;
    ShowPlayer player(clock, tideWish());
    std::vector<std::shared_ptr<const MatchFrame>> frames;
    for (int k = 0; k < 120; ++k) {
        if (k == 30 || k == 31 || k == 60) player.wish().inputs->push({"key.up", 1.0});
        frames.push_back(player.step());
    }
    return frames;
}

TEST(ShowPlayer, PlaysAProgramThatDrivesSceneAndServos) {
    const auto frames = playTide();
    ASSERT_TRUE(frames.front()->scene);
    EXPECT_TRUE(frames.front()->programError.empty()) << frames.front()->programError;
    const auto seaAt = [&](int k) { return static_cast<double>(findItem(*frames[k]->scene, 2)->position.y); };
    for (const int k : {0, 29, 31, 119}) {
        const int keys = k < 30 ? 0 : k < 31 ? 1 : k < 60 ? 2 : 3;
        EXPECT_NEAR(seaAt(k), 0.006 + 0.004 * keys + 0.003 * std::sin(2.0 * k / 60.0), 1e-6) << k;
    }
    EXPECT_TRUE(frames.back()->matched);
    double before = 0.0, after = 0.0;
    for (const double stroke : frames[29]->wantedStrokes) before += stroke;
    for (const double stroke : frames.back()->wantedStrokes) after += stroke;
    EXPECT_GT(after, before) << "the servos follow the tide that the keys have raised";
}

TEST(ShowPlayer, GivesTheSameFramesForTheSameInputs) {
    const auto first = playTide();
    const auto second = playTide();
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t k = 0; k < first.size(); ++k) {
        EXPECT_TRUE(*first[k]->scene == *second[k]->scene) << k;
        EXPECT_EQ(first[k]->wanted, second[k]->wanted) << k;
        EXPECT_EQ(first[k]->wantedStrokes, second[k]->wantedStrokes) << k;
        EXPECT_EQ(first[k]->estimatedStrokes, second[k]->estimatedStrokes) << k;
        EXPECT_EQ(*first[k]->devicePositions, *second[k]->devicePositions) << k;
        EXPECT_EQ(first[k]->time, second[k]->time) << k;
    }
}

TEST(ShowPlayer, PlaysUntilAMomentInStepsOfAFrameAtMost) {
    ManualClock clock;
    ShowPlayer player(clock, tideWish());
    (void)player.playUntil(0.5);
    EXPECT_NEAR(player.seconds(), 0.5, 1e-9);
    EXPECT_EQ(player.frame()->number, 31U) << "the first and thirty steps";
    (void)player.playUntil(0.51);
    EXPECT_NEAR(player.seconds(), 0.51, 1e-9);
    EXPECT_EQ(player.frame()->number, 32U);
    (void)player.playUntil(0.2);
    EXPECT_NEAR(player.seconds(), 0.51, 1e-9) << "time does not run backwards";
}

TEST(ShowPlayer, AHeldFrameStandsAtItsStrokesWithoutHavingMoved) {
    MatchWish wish = tideWish();
    wish.program = nullptr;
    std::vector<double> strokes(wish.rig->actuatorCount(), 0.0);
    strokes.front() = 0.75;
    const auto frame = heldFrame(wish, strokes, 1.0);
    EXPECT_EQ(frame->estimatedStrokes, strokes);
    EXPECT_EQ(*frame->devicePositions, deformed(*wish.rig, strokes).positions);
}

TEST(ProjectContents, LeaveOutAFieldThatCannotBeReadAndSaySo) {
    Project project;
    project.rig = "resource:models/tablet.glb";
    project.field = "resource:models/tablet.glb"; // no field at all
    const ProjectContents contents = readContents(project, {});
    EXPECT_FALSE(contents.field);
    ASSERT_EQ(contents.warnings.size(), 1U);
    EXPECT_NE(contents.warnings.front().find("field"), std::string::npos);
    EXPECT_EQ(wishOf(contents).strokes.size(), contents.rig->actuatorCount());
}

} // namespace
} // namespace lumorph::test
