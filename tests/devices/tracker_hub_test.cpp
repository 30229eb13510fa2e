#include "devices/trackers/tracker_hub.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <thread>

#include <QCoreApplication>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"

namespace lumorph {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

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

// --- With trackers that run

class RunningHub : public ::testing::Test {
protected:
    void SetUp() override {
        if (QCoreApplication::instance() == nullptr) {
            static int count = 1;
            static char name[] = "test";
            static char* arguments[] = {name, nullptr};
            new QCoreApplication(count, arguments); // as long as the program
        }
    }
    template <typename Condition> static bool waitFor(Condition condition) {
        for (int i = 0; i < 2000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
        return condition();
    }
};

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

} // namespace
} // namespace lumorph
