#include "devices/trackers/tracker_hub.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <thread>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/devices/running_tracker.h"
#include "tests/support/not_a_number.h"

namespace lumorph {
namespace {

using ::testing::HasSubstr;

/// A hub with a clock that is turned by hand, fed as a replay would.
class TrackerHubTest : public ::testing::Test {
protected:
    void take(const std::string& name, const glm::dvec3& position, bool valid = true,
              const std::string& source = "replay") {
        clock->advance(Microseconds{10'000});
        TrackerFrame frame;
        frame.measured = frame.arrived = clock->now();
        frame.bodies = {{1, name, valid, {position, {1, 0, 0, 0}}}};
        hub.take(source, frame);
    }
    [[nodiscard]] std::optional<Pose> now(const std::string& name) const {
        for (const PoseBoard::Entry& entry : board->entries())
            if (entry.name == name) return entry.stream->at(clock->now(), clock->now());
        return std::nullopt;
    }

    std::shared_ptr<ManualClock> clock = std::make_shared<ManualClock>();
    std::shared_ptr<PoseBoard> board = std::make_shared<PoseBoard>();
    TrackerHub hub{board, clock};
};

TEST_F(TrackerHubTest, BodiesThatHaveARoleComeToTheBoard) {
    hub.setRoles({{"glasses", PoseRole::head}, {"tablet", PoseRole::device}});
    take("glasses", {1, 2, 3});
    take("somebody's hat", {4, 5, 6});
    ASSERT_EQ(board->entries().size(), 1U);
    EXPECT_EQ(board->entries()[0].name, "glasses");
    EXPECT_EQ(board->entries()[0].role, PoseRole::head);
    ASSERT_TRUE(now("glasses"));
    EXPECT_LT(glm::distance(now("glasses")->position, {1, 2, 3}), 1e-9);
    take("tablet", {0, 0, 0});
    EXPECT_EQ(board->entries()[1].role, PoseRole::device);
}

TEST_F(TrackerHubTest, RolesChangeWhilePosesCome) {
    hub.setRoles({{"glasses", PoseRole::head}});
    take("glasses", {1, 2, 3});
    hub.setRoles({{"glasses", PoseRole::pointer}});
    ASSERT_EQ(board->entries().size(), 1U);
    EXPECT_EQ(board->entries()[0].role, PoseRole::pointer);
    EXPECT_TRUE(now("glasses")) << "the pose is not lost by that";
    hub.setRoles({});
    EXPECT_TRUE(board->entries().empty());
    take("glasses", {1, 2, 3});
    EXPECT_TRUE(board->entries().empty());
    hub.setRoles({{"glasses", PoseRole::head}});
    EXPECT_EQ(hub.roles().at("glasses"), PoseRole::head);
}

TEST_F(TrackerHubTest, StreamsOfOthersOnTheBoardAreLeftAlone) {
    (void)board->stream("mouse", PoseRole::head);
    hub.setRoles({{"glasses", PoseRole::head}});
    take("glasses", {1, 2, 3});
    hub.setRoles({});
    ASSERT_EQ(board->entries().size(), 1U);
    EXPECT_EQ(board->entries()[0].name, "mouse");
}

TEST_F(TrackerHubTest, APoseThatIsNoNumberNeverComesToTheBoard) {
    hub.setRoles({{"glasses", PoseRole::head}});
    for (int i = 0; i < 5; ++i) take("glasses", {1, 2, 3});
    for (const double wrong : {kNan, std::numeric_limits<double>::infinity(), 1e30}) {
        take("glasses", {wrong, 2, 3});
        ASSERT_TRUE(now("glasses"));
        EXPECT_LT(glm::distance(now("glasses")->position, {1, 2, 3}), 1e-6);
        EXPECT_TRUE(std::isfinite(board->entries()[0].stream->latest()->pose.position.x));
    }
}

TEST_F(TrackerHubTest, ATeleportIsFollowedAndSettles) {
    hub.setRoles({{"glasses", PoseRole::head}});
    for (int i = 0; i < 20; ++i) take("glasses", {0, 0, 0});
    for (int i = 0; i < 50; ++i) take("glasses", {5, 0, 0});
    ASSERT_TRUE(now("glasses"));
    EXPECT_NEAR(now("glasses")->position.x, 5.0, 1e-3);
}

TEST_F(TrackerHubTest, ALostBodyIsLostAtOnceAndASilentOneSoon) {
    hub.setRoles({{"glasses", PoseRole::head}});
    take("glasses", {1, 2, 3});
    EXPECT_TRUE(now("glasses"));
    take("glasses", {1, 2, 3}, false);
    EXPECT_FALSE(now("glasses"));
    take("glasses", {1, 2, 3});
    EXPECT_TRUE(now("glasses"));
    clock->advance(Microseconds{200'000});
    EXPECT_TRUE(now("glasses"));
    clock->advance(Microseconds{100'000});
    EXPECT_FALSE(now("glasses")) << "nothing came for 0.3 s";
}

TEST_F(TrackerHubTest, ATimeToComeDoesNotStopWhatFollows) {
    hub.setRoles({{"glasses", PoseRole::head}});
    TrackerFrame frame;
    frame.measured = clock->now() + Microseconds{3'600'000'000};
    frame.bodies = {{1, "glasses", true, {}}};
    hub.take("replay", frame);
    for (int i = 0; i < 50; ++i) take("glasses", {1, 0, 0});
    ASSERT_TRUE(now("glasses"));
    EXPECT_NEAR(now("glasses")->position.x, 1.0, 1e-3);
}

// --- Two trackers, one name

constexpr glm::dvec3 kHere{0.0, 1.0, 0.0};
constexpr glm::dvec3 kThere{0.7, 1.0, 0.0};

TEST_F(TrackerHubTest, OfTwoThatShareANameTheFirstIsFollowed) {
    hub.setRoles({{"head", PoseRole::head}});
    for (int i = 0; i < 100; ++i) {
        take("head", kHere, true, "first");
        take("head", kThere, true, "second");
        ASSERT_TRUE(now("head"));
        ASSERT_LT(glm::distance(now("head")->position, kHere), 1e-9) << i;
    }
    EXPECT_EQ(board->entries().size(), 1U);
}

TEST_F(TrackerHubTest, TheSecondTakesOverWhenTheFirstIsStaleAndTheFirstDoesNotTakeItBack) {
    hub.setRoles({{"head", PoseRole::head}});
    for (int i = 0; i < 20; ++i) take("head", kHere - glm::dvec3(0.005 * i, 0, 0), true, "first");
    const glm::dvec3 last = kHere - glm::dvec3(0.005 * 19, 0, 0);
    for (int i = 0; i < 25; ++i) {
        take("head", kThere, true, "second");
        ASSERT_GT(glm::distance(now("head")->position, kThere), 0.5) << "after " << 10 * (i + 1) << " ms";
    }
    EXPECT_EQ(board->entries()[0].stream->latest()->pose.position, last);
    take("head", kThere, true, "second");
    ASSERT_TRUE(now("head")) << "0.26 s after the first spoke last";
    EXPECT_EQ(now("head")->position, kThere) << "at once, without a trace of the first";
    const auto pose = board->entries()[0].stream->at(clock->now() + Microseconds{100'000}, clock->now());
    EXPECT_EQ(pose->position, kThere) << "nor of its motion";
    for (int i = 0; i < 20; ++i) {
        take("head", kHere, true, "first");
        take("head", kThere, true, "second");
        ASSERT_LT(glm::distance(now("head")->position, kThere), 1e-9) << i;
    }
}

TEST_F(TrackerHubTest, AShortLossChangesNothingAndALongOneHandsOver) {
    hub.setRoles({{"head", PoseRole::head}});
    take("head", kHere, true, "first");
    for (int i = 0; i < 5; ++i) {
        take("head", kHere, false, "first");
        take("head", kThere, true, "second");
        EXPECT_FALSE(now("head")) << "lost, and nobody is put in its place";
    }
    take("head", kHere, true, "first");
    ASSERT_TRUE(now("head"));
    EXPECT_LT(glm::distance(now("head")->position, kHere), 1e-9);
    for (int i = 0; i < 20; ++i) {
        take("head", kHere, false, "first");
        take("head", kThere, true, "second");
    }
    ASSERT_TRUE(now("head"));
    EXPECT_LT(glm::distance(now("head")->position, kThere), 1e-9) << "who still says lost does not lose it";
}

// What is measured by a slower tracker is older than the last word of a quicker one that has lost the body.
TEST_F(TrackerHubTest, ALateSecondTakesOverFromAFirstThatGoesOnSayingLost) {
    hub.setRoles({{"head", PoseRole::head}});
    clock->advance(Microseconds{1'000'000});
    take("head", kHere, true, "first");
    for (int i = 0; i < 60; ++i) {
        take("head", kHere, false, "first");
        clock->advance(Microseconds{5'000});
        TrackerFrame frame;
        frame.measured = clock->now() - Microseconds{60'000};
        frame.bodies = {{1, "head", true, {kThere, {1, 0, 0, 0}}}};
        hub.take("second", frame);
    }
    ASSERT_TRUE(now("head"));
    EXPECT_LT(glm::distance(now("head")->position, kThere), 1e-9);
}

TEST_F(TrackerHubTest, ASecondThatHasNoPoseDoesNotTakeOver) {
    hub.setRoles({{"head", PoseRole::head}});
    take("head", kHere, true, "first");
    clock->advance(Microseconds{300'000});
    take("head", kThere, false, "second");
    take("head", {kNan, 0, 0}, true, "second");
    take("head", kHere, true, "first");
    ASSERT_TRUE(now("head"));
    EXPECT_LT(glm::distance(now("head")->position, kHere), 1e-9);
}

TEST_F(TrackerHubTest, TwoThatAreLateDoNotTakeTurns) {
    hub.setRoles({{"head", PoseRole::head}});
    const auto takeLate = [&](const glm::dvec3& position, const std::string& source) {
        clock->advance(Microseconds{10'000});
        TrackerFrame frame;
        frame.measured = clock->now() - Microseconds{245'000};
        frame.bodies = {{1, "head", true, {position, {1, 0, 0, 0}}}};
        hub.take(source, frame);
    };
    clock->advance(Microseconds{1'000'000});
    for (int i = 0; i < 50; ++i) {
        takeLate(kHere, "first");
        takeLate(kThere, "second");
        ASSERT_EQ(board->entries()[0].stream->latest()->pose.position, kHere) << i;
    }
}

// --- With trackers that run

/// Is asked for its status by one thread while another closes it.
class SlowTracker final : public Tracker {
public:
    struct Story {
        std::atomic<bool> asked = false, mayAnswer = false;
        std::atomic<std::thread::id> endedIn{};
    };
    explicit SlowTracker(std::shared_ptr<Story> story) : story_(std::move(story)) {}
    ~SlowTracker() override { story_->endedIn = std::this_thread::get_id(); }
    [[nodiscard]] TrackerStatus status() const override {
        story_->asked = true;
        while (!story_->mayAnswer) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return {};
    }

private:
    std::shared_ptr<Story> story_;
};

TEST(TrackerHub, ATrackerEndsWhereItIsClosedWhoeverAsksForItsStatus) {
    const auto story = std::make_shared<SlowTracker::Story>();
    TrackerHub hub(std::make_shared<PoseBoard>(), std::make_shared<ManualClock>(),
                   [&](const std::string&, const TrackerOptions&) { return std::make_unique<SlowTracker>(story); });
    hub.open("sim://head", false);
    std::thread window([&] { (void)hub.status(); });
    while (!story->asked) std::this_thread::yield();
    std::atomic<bool> closed = false;
    std::thread closing([&] {
        hub.close("sim://head");
        closed = true;
    });
    const std::thread::id there = closing.get_id();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_FALSE(closed) << "it is not over yet";
    story->mayAnswer = true;
    window.join();
    closing.join();
    EXPECT_EQ(story->endedIn.load(), there);
}

class RunningHub : public test::RunningTracker {};

TEST_F(RunningHub, ASimulatedHeadComesToTheBoardUntilItIsClosed) {
    const auto clock = std::make_shared<SteadyClock>();
    const auto board = std::make_shared<PoseBoard>();
    TrackerHub hub(board, clock);
    hub.setRoles({{"head", PoseRole::head}});
    hub.open("sim://head?rate=200", false);
    EXPECT_THROW(hub.open("sim://head?rate=200", false), InvalidInput) << "one tracker an address";
    EXPECT_THROW(hub.open("nonsense", false), InvalidInput);
    ASSERT_EQ(hub.status().size(), 1U);
    EXPECT_EQ(hub.status()[0].address, "sim://head?rate=200");
    ASSERT_TRUE(waitFor([&] { return !board->entries().empty(); }));
    EXPECT_TRUE(waitFor([&] { return board->entries()[0].stream->at(clock->now(), clock->now()).has_value(); }));
    hub.close("sim://head?rate=200");
    EXPECT_TRUE(hub.status().empty());
    EXPECT_TRUE(board->entries().empty());
    hub.close("sim://head?rate=200"); // and again: nothing happens
    hub.open("sim://head?rate=200", false);
}

TEST_F(RunningHub, OfTwoSimulatedHeadsTheSecondIsToldAndTakesOverWhenTheFirstIsClosed) {
    const auto clock = std::make_shared<SteadyClock>();
    const auto board = std::make_shared<PoseBoard>();
    TrackerHub hub(board, clock);
    hub.setRoles({{"head", PoseRole::head}});
    const auto adviceOf = [&](const std::string& uri) {
        for (const TrackerStatus& status : hub.status())
            if (status.address == uri) return status.advice;
        return std::string();
    };
    const auto isSeen = [&] {
        const auto entries = board->entries();
        return !entries.empty() && entries[0].stream->at(clock->now(), clock->now()).has_value();
    };
    hub.open("sim://head?rate=200", false);
    ASSERT_TRUE(waitFor(isSeen));
    hub.open("sim://head?rate=150", false);
    EXPECT_TRUE(waitFor([&] { return !adviceOf("sim://head?rate=150").empty(); }));
    EXPECT_THAT(adviceOf("sim://head?rate=150"), HasSubstr("sim://head?rate=200 (a simulated head)"));
    hub.close("sim://head?rate=200");
    EXPECT_TRUE(waitFor([&] { return isSeen() && adviceOf("sim://head?rate=150").empty(); }));
}

} // namespace
} // namespace lumorph
