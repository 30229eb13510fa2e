#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "core/geometry/mesh_file.h"
#include "core/loop/frame_source.h"
#include "core/loop/match_thread.h"
#include "core/loop/show_program.h"
#include "core/motion/causal_split.h"
#include "tests/core/loop/scene_loop_fixture.h"

// Applications in the loop: asked once a frame, replayable by their inputs, and alone in their failure.

namespace lumorph::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A whole application: keys raise and lower a tide that servos follow, and a lamp that goes round it.
class Tide final : public ShowProgram {
public:
    ShowContent frame(const ShowMoment& moment) override {
        for (const ShowInput& input : moment.inputs) {
            if (input.name == "up") level_ += 0.003 * input.value;
            if (input.name == "level") level_ = input.value;
        }
        auto scene = std::make_shared<Scene>(emptyScene());
        scene->items = {itemOf(ItemRole::virtualOnly, LightItem{})};
        scene->items.front().position = {std::cos(moment.seconds), 1.0, std::sin(moment.seconds)};

        const Box box = boundingBox(moment.rig->restMesh().positions);
        HeightGrid grid{{box.min.x, box.min.z}, {box.max.x, box.max.z}, 24, 20, {}};
        for (int k = 0; k < 24 * 20; ++k)
            grid.heights.push_back(box.max.y + static_cast<float>(level_ + 0.002 * std::sin(k % 24 + moment.seconds)));
        return {std::move(scene), nullptr, std::move(grid), Following::matched, true, {}, {}, {}};
    }

private:
    double level_ = 0.004;
};

/// A program of a function.
class Asked final : public ShowProgram {
public:
    explicit Asked(std::function<ShowContent(const ShowMoment&)> answer) : answer_(std::move(answer)) {}
    ShowContent frame(const ShowMoment& moment) override {
        ++times;
        return answer_(moment);
    }
    int times = 0;

private:
    std::function<ShowContent(const ShowMoment&)> answer_;
};

class ShowProgramTest : public SceneLoopTest {
protected:
    MatchWish wishOf(std::shared_ptr<ShowProgram> program) const {
        MatchWish wish = wishFor(field_, nullptr);
        wish.strokes = {0.3, 0.2, 0.1};
        setSceneInRoom(wish, emptyScene());
        wish.assets = std::make_shared<const SceneAssets>();
        wish.program = std::move(program);
        wish.inputs = std::make_shared<ShowInputs>();
        wish.driver = Driver::program;
        return wish;
    }
    /// A grid over the device: `height` over the rest surface by place.
    HeightGrid gridOver(const std::function<double(double x, double z)>& height) const {
        const Box box = field_->field.frame.box();
        HeightGrid grid{{box.min.x, box.min.z}, {box.max.x, box.max.z}, 31, 23, {}};
        for (int j = 0; j < grid.rows; ++j)
            for (int i = 0; i < grid.columns; ++i)
                grid.heights.push_back(field_->field.restSurface +
                                       static_cast<float>(height(std::lerp(grid.min.x, grid.max.x, i / 30.0),
                                                                 std::lerp(grid.min.y, grid.max.y, j / 22.0))));
        return grid;
    }

    const std::shared_ptr<const MatchField> field_ = matchFieldOf(cushionRig());
};

TEST_F(ShowProgramTest, DrivesSceneAndServos) {
    const MatchWish wish = wishOf(std::make_shared<Tide>());
    const auto low = run(wish, 2.0);
    EXPECT_EQ(low->program, wish.program);
    EXPECT_TRUE(low->programError.empty());
    EXPECT_TRUE(low->matched);
    EXPECT_GT(low->iouEstimated, 0.4) << "a tide with waves that the device is too coarse for";
    ASSERT_EQ(low->scene->items.size(), 1U);
    EXPECT_NEAR(low->scene->items.front().position.x, std::cos(low->programSeconds), 1e-6);
    ASSERT_NE(low->assets, nullptr);
    EXPECT_FALSE(loop_.settled());
    wish.inputs->push({"level", 0.02});
    const auto high = run(wish, 3.0);
    EXPECT_GT(high->targetVolume, 2.0 * low->targetVolume);
    EXPECT_GT(high->estimatedStrokes[0] + high->estimatedStrokes[1] + high->estimatedStrokes[2],
              low->estimatedStrokes[0] + low->estimatedStrokes[1] + low->estimatedStrokes[2] + 0.3);
}

// What a frame says of its inputs is enough to make it again.
TEST_F(ShowProgramTest, TheSameInputsGiveTheSameFrames) {
    std::vector<std::shared_ptr<const MatchFrame>> first;
    std::mt19937 random(7);
    const MatchWish played = wishOf(std::make_shared<Tide>());
    for (int k = 0; k < 120; ++k) {
        for (auto left = random() % 3; left > 0; --left)
            played.inputs->push({random() % 2 ? "up" : "other key", random() % 2 ? 1.0 : -1.0});
        first.push_back(step(played));
    }
    ManualClock clock;
    MatchLoop loop(clock);
    const MatchWish again = wishOf(std::make_shared<Tide>());
    std::size_t inputs = 0;
    for (const auto& expected : first) {
        for (const ShowInput& input : expected->inputs) again.inputs->push(input);
        clock.advance(Microseconds(std::llround(1e6 * kFrame)));
        const auto frame = loop.step(again, kFrame);
        EXPECT_EQ(*frame->scene, *expected->scene);
        EXPECT_EQ(frame->programSeconds, expected->programSeconds);
        EXPECT_EQ(frame->inputs, expected->inputs);
        EXPECT_EQ(frame->wanted, expected->wanted);
        EXPECT_EQ(frame->wantedStrokes, expected->wantedStrokes);
        EXPECT_EQ(frame->estimatedStrokes, expected->estimatedStrokes);
        EXPECT_EQ(frame->iouEstimated, expected->iouEstimated);
        inputs += frame->inputs.size();
    }
    EXPECT_GT(inputs, 60U);
}

TEST_F(ShowProgramTest, InputsAreNeitherLostNorDoubledWhileWishesOvertakeOneAnother) {
    constexpr int kPushers = 3;
    constexpr int kEach = 1500;
    std::vector<ShowInput> received; // in the loop's thread
    std::vector<ShowInput> told;
    std::atomic<int> count = 0;
    auto program = std::make_shared<Asked>([&](const ShowMoment& moment) {
        received.insert(received.end(), moment.inputs.begin(), moment.inputs.end());
        count = static_cast<int>(received.size());
        ShowContent content;
        content.moves = false; // rests between the inputs
        return content;
    });
    const MatchWish wish = wishOf(program);
    {
        const MatchThread* running = nullptr;
        std::atomic<bool> ready = false;
        MatchThread thread(
            [&] {
                while (!ready) std::this_thread::yield();
                const auto frame = running->latest();
                told.insert(told.end(), frame->inputs.begin(), frame->inputs.end());
            },
            1000.0);
        running = &thread;
        ready = true;
        std::vector<std::jthread> pushers;
        for (int who = 0; who < kPushers; ++who)
            pushers.emplace_back([&, who] {
                for (int k = 0; k < kEach; ++k) {
                    wish.inputs->push({std::to_string(who), static_cast<double>(k)});
                    if (k % (who + 2) == 0) thread.wish(wish);
                }
            });
        pushers.clear();
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        while (count < kPushers * kEach && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    }
    ASSERT_EQ(received.size(), static_cast<std::size_t>(kPushers * kEach)) << "without another wish at the end";
    EXPECT_EQ(told, received) << "frames tell what the program was given";
    for (int who = 0; who < kPushers; ++who) {
        double next = 0.0;
        for (const ShowInput& input : received)
            if (input.name == std::to_string(who)) {
                ASSERT_EQ(input.value, next);
                next += 1.0;
            }
    }
}

TEST_F(ShowProgramTest, OneThatThrowsEndsAlone) {
    const std::function<ShowContent(const ShowMoment&)> ends[] = {[](const ShowMoment& moment) -> ShowContent {
                                                                      if (moment.seconds > 0.1)
                                                                          throw std::runtime_error("the tide is out");
                                                                      return Tide().frame(moment);
                                                                  },
                                                                  [](const ShowMoment& moment) -> ShowContent {
                                                                      if (moment.seconds > 0.1) throw 7;
                                                                      return Tide().frame(moment);
                                                                  }};
    for (const auto& end : ends) {
        MatchLoop loop(clock_);
        const auto program = std::make_shared<Asked>(end);
        MatchWish wish = wishOf(program);
        std::shared_ptr<const MatchFrame> frame;
        for (int k = 0; k < 7; ++k) frame = loop.step(wish, kFrame);
        EXPECT_TRUE(frame->programError.empty());
        EXPECT_NE(frame->scene, wish.scene);
        wish.inputs->push({"up", 1.0});
        frame = loop.step(wish, kFrame);
        EXPECT_NE(frame->programError.find("goes on without it"), std::string::npos);
        EXPECT_EQ(frame->programError.find("the tide is out") != std::string::npos, &end == &ends[0]);
        EXPECT_EQ(frame->inputs.size(), 1U) << "it was given them";
        EXPECT_EQ(frame->scene, wish.scene) << "the show goes on";
        EXPECT_EQ(frame->wantedStrokes, wish.strokes);
        const int asked = program->times;
        for (int k = 0; k < 300; ++k) frame = loop.step(wish, kFrame);
        EXPECT_EQ(program->times, asked) << "never again";
        EXPECT_FALSE(frame->programError.empty());
        EXPECT_EQ(frame->program, nullptr);
        EXPECT_TRUE(loop.settled());

        wish.program = std::make_shared<Tide>();
        frame = loop.step(wish, kFrame);
        EXPECT_TRUE(frame->programError.empty()) << "another one is asked";
        EXPECT_TRUE(frame->matched);
        wish.program = program;
        EXPECT_FALSE(loop.step(wish, kFrame)->programError.empty());
        EXPECT_EQ(program->times, asked);
    }
}

TEST_F(ShowProgramTest, WhatServosCannotFollowEndsIt) {
    const auto mesh = [](auto spoil) {
        return [spoil](ShowContent& content) {
            TriangleMesh box = boxMesh({0, 0, 0}, {0.05F, 0.02F, 0.05F});
            spoil(box);
            content.target = std::make_shared<const TriangleMesh>(std::move(box));
        };
    };
    struct Case {
        const char* why;
        std::function<void(ShowContent&)> spoil;
    };
    const Case cases[] = {
        {"heights for", [](ShowContent& c) { std::get<HeightGrid>(c.target).heights.pop_back(); }},
        {"infinite", [](ShowContent& c) { std::get<HeightGrid>(c.target).heights[3] = HUGE_VALF; }},
        {"rectangle", [](ShowContent& c) { std::get<HeightGrid>(c.target).max.x = kNan; }},
        {"not closed", mesh([](TriangleMesh& m) { m.triangles.pop_back(); })},
        {"not finite", mesh([](TriangleMesh& m) { m.positions[2].y = kNan; })},
        {"0 triangles", mesh([](TriangleMesh& m) { m.triangles.clear(); })},
        {"", mesh([](TriangleMesh& m) { m.triangles[0].x = 1'000'000; })},
        {"triangles, not 1 to", mesh([](TriangleMesh& m) { m.triangles.resize(kMaxTriangles + 1); })},
        {"mesh is missing", [](ShowContent& c) { c.target = std::shared_ptr<const TriangleMesh>(); }},
        {"voxels are missing", [](ShowContent& c) { c.target = std::shared_ptr<const BitColumns>(); }},
        {"frame", [](ShowContent& c) { c.target = std::make_shared<const BitColumns>(glm::ivec3(3, 4, 5)); }},
        {"", [](ShowContent& c) {
             auto scene = std::make_shared<Scene>(*c.scene);
             scene->items.front().position.x = kNan;
             c.scene = scene;
         }}};
    for (const Case& c : cases)
        for (const Following following : {Following::matched, Following::split}) {
            MatchLoop loop(clock_);
            const auto program = std::make_shared<Asked>([&](const ShowMoment& moment) {
                ShowContent content = Tide().frame(moment);
                content.following = following;
                c.spoil(content);
                return content;
            });
            const MatchWish wish = wishOf(program);
            const auto frame = loop.step(wish, kFrame);
            EXPECT_NE(frame->programError, "") << c.why;
            EXPECT_NE(frame->programError.find(c.why), std::string::npos) << frame->programError;
            EXPECT_EQ(frame->wantedStrokes, wish.strokes);
            EXPECT_FALSE(frame->matched);
        }
}

// A height grid, its voxels and its solid are one target.
TEST_F(ShowProgramTest, HeightsReachTheIouOfTheirVoxels) {
    const VoxelFrame& frame = field_->field.frame;
    const HeightGrid slope = gridOver([](double x, double z) { return 0.007 + 0.06 * x - 0.03 * z; });
    auto voxels = std::make_shared<BitColumns>(frame.dimensions);
    for (int z = 0; z < frame.dimensions.z; ++z)
        for (int x = 0; x < frame.dimensions.x; ++x)
            for (int y = 0; y < frame.dimensions.y; ++y) {
                const glm::dvec3 c = frame.centre(x, y, z);
                const double rest = static_cast<double>(field_->field.restSurface);
                if (c.y > rest && c.y < rest + 0.007 + 0.06 * c.x - 0.03 * c.z) voxels->set(x, y, z);
            }
    BitColumns domain = *voxels;
    domain -= field_->field.body;
    const auto reached = [&](auto target) {
        MatchLoop loop(clock_);
        const auto program = std::make_shared<Asked>([&](const ShowMoment&) {
            ShowContent content;
            content.target = target;
            content.moves = false;
            return content;
        });
        const MatchWish wish = wishOf(program);
        std::shared_ptr<const MatchFrame> last;
        for (int k = 0; k < 600 && !loop.settled(); ++k) last = loop.step(wish, kFrame);
        EXPECT_TRUE(loop.settled());
        return last;
    };
    const auto byHeights = reached(slope);
    const auto byVoxels = reached(std::shared_ptr<const BitColumns>(voxels));
    EXPECT_EQ(byHeights->wanted, byVoxels->wanted);
    EXPECT_EQ(byHeights->iouWanted, byVoxels->iouWanted);
    EXPECT_EQ(byHeights->iouEstimated, byVoxels->iouEstimated);
    EXPECT_NEAR(byHeights->targetVolume, static_cast<double>(domain.count()) * frame.voxelVolume(), 1e-12);
    BitColumns covered;
    CoverageScratch scratch;
    field_->coverage.covered(byHeights->wanted, covered, scratch);
    EXPECT_NEAR(byHeights->iouWanted, intersectionOverUnion(covered, domain), 1e-12);
    EXPECT_GT(byHeights->iouWanted, 0.6);
}

TEST_F(ShowProgramTest, AMeshIsMatchedAsTheSameTargetIs) {
    const auto target = stillTarget(boxMesh({-0.02F, 0.0F, -0.02F}, {0.02F, 0.01F, 0.02F}));
    MatchWish plain = wishFor(field_, target);
    const auto mesh = std::make_shared<const TriangleMesh>(placed(target->solid.mesh, plain.placement));
    MatchLoop bare(clock_);
    const auto expected = bare.step(plain, kFrame);
    const auto frame = step(wishOf(std::make_shared<Asked>([&](const ShowMoment&) {
        ShowContent content;
        content.target = mesh;
        return content;
    })));
    EXPECT_EQ(frame->wanted, expected->wanted);
    EXPECT_EQ(frame->iouWanted, expected->iouWanted);
    EXPECT_EQ(frame->targetVolume, expected->targetVolume);
    EXPECT_EQ(frame->shareUnreachable, expected->shareUnreachable);
}

TEST_F(ShowProgramTest, ASplitIsTheCausalOne) {
    const auto wave = [](double t) {
        return [t](double x, double z) { return 0.008 + 0.006 * std::sin(30.0 * x + 9.0 * z - 5.0 * t); };
    };
    const auto program = std::make_shared<Asked>([&](const ShowMoment& moment) {
        ShowContent content;
        content.target = gridOver(wave(moment.seconds));
        content.following = Following::split;
        content.moves = moment.seconds < 1.0;
        return content;
    });
    MatchWish wish = wishOf(program);
    CausalSplit split(cushionRig());
    std::vector<float> heights(split.points().size());
    double t = 0.0;
    for (int k = 0; k < 60; ++k, t += kFrame) {
        const HeightGrid grid = gridOver(wave(t));
        for (std::size_t p = 0; p < heights.size(); ++p)
            heights[p] = static_cast<float>(heightAt(grid, glm::dvec2(split.points()[p])));
        const std::vector<double> expected = split.strokes(heights, k == 0 ? 0.0 : kFrame);
        const auto frame = step(wish);
        ASSERT_EQ(frame->splitStrokes, expected) << k;
        EXPECT_EQ(frame->wantedStrokes, expected);
        EXPECT_FALSE(frame->matched);
    }
    // Without a field as well.
    wish.field = nullptr;
    EXPECT_FALSE(step(wish)->splitStrokes.empty());
    wish.driver = Driver::hand;
    const auto held = step(wish);
    EXPECT_TRUE(held->splitStrokes.empty());
    EXPECT_EQ(held->wantedStrokes, wish.strokes);
}

TEST_F(ShowProgramTest, AStillSplitComesToRestWhereItsWishIs) {
    double level = 0.002;
    const auto program = std::make_shared<Asked>([&](const ShowMoment&) {
        ShowContent content;
        content.target = gridOver([&](double, double) { return level; });
        content.following = Following::split;
        content.moves = false;
        return content;
    });
    const MatchWish wish = wishOf(program);
    (void)step(wish);
    level = 0.012;
    auto frame = step(wish, 0.0);
    EXPECT_FALSE(loop_.settled()) << "the smoothed wish has yet to follow";
    for (int k = 0; k < 900 && !loop_.settled(); ++k) frame = step(wish);
    ASSERT_TRUE(loop_.settled());
    CausalSplit anew(cushionRig());
    const HeightGrid grid = gridOver([](double, double) { return 0.012; });
    std::vector<float> heights;
    for (const glm::vec2& at : anew.points()) heights.push_back(static_cast<float>(heightAt(grid, glm::dvec2(at))));
    const std::vector<double> goal = anew.strokes(heights, 0.0);
    for (std::size_t i = 0; i < goal.size(); ++i) EXPECT_NEAR(frame->estimatedStrokes[i], goal[i], 0.02);
}

class Still final : public FrameSource {
public:
    std::shared_ptr<const MatchFrame> frame(const MatchWish& wish, Microseconds) override {
        auto made = std::make_shared<MatchFrame>();
        made->estimatedStrokes.assign(wish.rig->actuatorCount(), 0.5);
        return made;
    }
    bool moves() const override { return false; }
};

TEST_F(ShowProgramTest, IsNotAskedWhileAnotherShows) {
    const auto program = std::make_shared<Asked>([](const ShowMoment& moment) { return Tide().frame(moment); });
    MatchWish wish = wishOf(program);
    (void)step(wish);
    wish.source = std::make_shared<Still>();
    wish.driver = Driver::recording;
    wish.inputs->push({"up", 1.0});
    for (int k = 0; k < 5; ++k) (void)step(wish);
    EXPECT_EQ(program->times, 1);
    wish.driver = Driver::program;
    EXPECT_EQ(step(wish)->inputs.size(), 1U) << "what waited is not lost";
    MatchWish none = wish;
    none.program = nullptr;
    none.driver = Driver::hand;
    EXPECT_EQ(step(none)->program, nullptr);
    EXPECT_EQ(program->times, 2);
    EXPECT_EQ(step(wish)->programSeconds, 0.0) << "begun anew";
}

TEST_F(ShowProgramTest, ShowsLightWhileAnotherMovesTheServos) {
    MatchWish wish = wishOf(std::make_shared<Tide>());
    wish.driver = Driver::hand;
    const auto held = step(wish);
    EXPECT_EQ(held->wantedStrokes, wish.strokes);
    EXPECT_EQ(held->scene->items.size(), 1U);
    EXPECT_FALSE(held->matched);
    wish.target = stillTarget(boxMesh({0, 0, 0}, {0.06F, 0.006F, 0.05F}));
    wish.placement = fitPlacement(field_->field, wish.target->box);
    wish.driver = Driver::target;
    const auto matched = step(wish);
    MatchLoop bare(clock_);
    MatchWish plain = wish;
    plain.program = nullptr;
    EXPECT_EQ(matched->wanted, bare.step(plain, kFrame)->wanted);
    // Back and forth between two targets, each is judged by its own voxels.
    wish.driver = Driver::program;
    const auto tide = step(wish);
    wish.driver = Driver::target;
    const auto back = step(wish);
    EXPECT_NE(tide->targetVolume, back->targetVolume);
    EXPECT_EQ(back->targetVolume, matched->targetVolume);
    EXPECT_EQ(back->iouWanted, bare.step(plain, kFrame)->iouWanted);
    wish.field = nullptr;
    wish.driver = Driver::program;
    EXPECT_EQ(step(wish)->wantedStrokes, wish.strokes) << "nothing can be matched without a field";
}

TEST_F(ShowProgramTest, SeesPosesStrokesAndTime) {
    std::vector<double> seconds;
    const auto board = std::make_shared<PoseBoard>();
    const auto program = std::make_shared<Asked>([&](const ShowMoment& moment) {
        seconds.push_back(moment.seconds);
        EXPECT_EQ(moment.strokes.size(), moment.rig->actuatorCount());
        EXPECT_EQ(moment.field, field_);
        if (moment.seconds == 0.0) {
            EXPECT_EQ(moment.step, 0.0);
            EXPECT_TRUE(moment.bodies.empty());
        } else {
            EXPECT_EQ(moment.bodies.size(), 2U);
            for (const ShowBody& body : moment.bodies) {
                EXPECT_EQ(body.role, body.name == "hand" ? PoseRole::pointer : PoseRole::device);
                EXPECT_NEAR(body.pose.position.x, body.name == "hand" ? 0.25 : 0.5, 1e-9);
            }
            EXPECT_NEAR(moment.worldFromDevice[3].x, 0.5F, 1e-6F);
        }
        ShowContent content;
        content.moves = false;
        return content;
    });
    MatchWish wish = wishOf(program);
    wish.strokes.assign(3, 0.0);
    (void)step(wish);
    EXPECT_TRUE(loop_.settled());
    wish.poses = board;
    for (int k = 0; k < 3; ++k) {
        clock_.advance(Microseconds(10'000));
        (void)board->stream("hand", PoseRole::pointer)->push({clock_.now(), true, {{0.25, 0, 0}, {1, 0, 0, 0}}});
        (void)board->stream("box", PoseRole::device)->push({clock_.now(), true, {{0.5, 0, 0}, {1, 0, 0, 0}}});
        (void)loop_.step(wish, 0.01);
    }
    ASSERT_EQ(seconds.size(), 4U);
    EXPECT_DOUBLE_EQ(seconds.back(), 0.03);
    EXPECT_FALSE(loop_.settled()) << "somebody is there";
}

TEST_F(ShowProgramTest, WritesInTheLanguageOfTheNewestWish) {
    std::vector<Language> asked;
    const auto program = std::make_shared<Asked>([&](const ShowMoment& moment) {
        asked.push_back(moment.language);
        return ShowContent{};
    });
    MatchWish wish = wishOf(program);
    wish.strokes.assign(3, 0.0);
    (void)step(wish);
    wish.language = Language::german;
    (void)step(wish);
    EXPECT_EQ(asked, (std::vector{Language::english, Language::german}));
}

} // namespace
} // namespace lumorph::test
