#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "devices/trackers/tracker_hub.h"

// Trackers whose bodies have the same name: whom the show follows, and what the others are told.

namespace lumorph {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

constexpr glm::dvec3 kFirstPlace{0.0, 1.0, 0.0};
constexpr glm::dvec3 kSecondPlace{0.7, 1.0, 0.0};

/// Tells what it was told to tell.
class PlainTracker final : public Tracker {
public:
    explicit PlainTracker(TrackerStatus status) : status_(std::move(status)) {}
    [[nodiscard]] TrackerStatus status() const override { return status_; }

private:
    TrackerStatus status_;
};

/// A hub of trackers that are open and say what the test lets them say.
class SharedNames : public ::testing::Test {
protected:
    void SetUp() override {
        for (const char* uri : {"sim://head", "opentrack://127.0.0.1:4242"}) hub.open(uri, false);
    }
    void take(const std::string& uri, const glm::dvec3& position, std::vector<std::string> names = {"head"}) {
        clock->advance(Microseconds{5'000});
        TrackerFrame frame;
        frame.measured = frame.arrived = clock->now();
        for (const std::string& name : names) frame.bodies.push_back({1, name, true, {position, {1, 0, 0, 0}}});
        frames.at(uri)(frame);
    }
    [[nodiscard]] std::string adviceOf(const std::string& uri) const {
        for (const TrackerStatus& status : hub.status())
            if (status.address == uri) return status.advice;
        return "it is not open";
    }
    [[nodiscard]] std::optional<Pose> head() const {
        for (const PoseBoard::Entry& entry : board->entries())
            if (entry.name == "head") return entry.stream->at(clock->now(), clock->now());
        return std::nullopt;
    }

    const std::string sim = "sim://head";
    const std::string openTrack = "opentrack://127.0.0.1:4242";
    std::map<std::string, std::function<void(const TrackerFrame&)>> frames; ///< what the trackers call, by address
    std::string ownAdvice; ///< of trackers that are opened from then on
    std::shared_ptr<ManualClock> clock = std::make_shared<ManualClock>();
    std::shared_ptr<PoseBoard> board = std::make_shared<PoseBoard>();
    TrackerHub hub{board, clock, [this](const std::string& uri, TrackerOptions options) {
                       frames[uri] = options.onFrame;
                       TrackerStatus status;
                       status.address = uri;
                       status.source = uri == sim ? "a simulated head" : "opentrack from 127.0.0.1";
                       status.advice = ownAdvice;
                       return std::make_unique<PlainTracker>(status);
                   }};
};

TEST_F(SharedNames, TheSecondIsToldWhomTheShowFollowsAndWhatToDo) {
    hub.setRoles({{"head", PoseRole::head}});
    take(sim, kFirstPlace);
    EXPECT_THAT(adviceOf(openTrack), IsEmpty());
    take(openTrack, kSecondPlace);
    EXPECT_EQ(adviceOf(openTrack), "'head' of this tracker is not followed: sim://head (a simulated head) brings the "
                                   "same name and came first. Close one of the two trackers, or rename the body in "
                                   "its program.");
    EXPECT_THAT(adviceOf(sim), IsEmpty()) << "nothing is wrong with the first";
    take(sim, kFirstPlace);
    clock->advance(Microseconds{3'000'000});
    EXPECT_THAT(adviceOf(openTrack), IsEmpty()) << "it no longer sends";
}

TEST_F(SharedNames, WithoutARoleNobodyIsInTheWay) {
    take(sim, kFirstPlace);
    take(openTrack, kSecondPlace);
    EXPECT_THAT(adviceOf(openTrack), IsEmpty());
}

TEST_F(SharedNames, WhenTheFirstIsClosedTheSecondIsThereAtOnce) {
    hub.setRoles({{"head", PoseRole::head}});
    for (int i = 0; i < 10; ++i) {
        take(sim, kFirstPlace - glm::dvec3(0.005 * i, 0, 0));
        take(openTrack, kSecondPlace);
    }
    hub.close(sim);
    ASSERT_EQ(board->entries().size(), 1U);
    take(openTrack, kSecondPlace);
    ASSERT_TRUE(head());
    EXPECT_EQ(head()->position, kSecondPlace);
    EXPECT_THAT(adviceOf(openTrack), IsEmpty());
    hub.open(sim, false);
    take(sim, kFirstPlace);
    take(openTrack, kSecondPlace);
    EXPECT_LT(glm::distance(head()->position, kSecondPlace), 1e-9) << "now the other came first";
    EXPECT_THAT(adviceOf(sim), HasSubstr("opentrack://127.0.0.1:4242 (opentrack from 127.0.0.1)"));
    hub.close(sim);
    hub.close(openTrack);
    EXPECT_THAT(board->entries(), IsEmpty());
}

TEST_F(SharedNames, WhoTakesOverFromASilentOneIsNoLongerToldOfIt) {
    hub.setRoles({{"head", PoseRole::head}});
    take(sim, kFirstPlace);
    for (int i = 0; i < 60; ++i) take(openTrack, kSecondPlace);
    EXPECT_LT(glm::distance(head()->position, kSecondPlace), 1e-9);
    EXPECT_THAT(adviceOf(openTrack), IsEmpty());
    take(sim, kFirstPlace);
    EXPECT_THAT(adviceOf(sim), HasSubstr("opentrack://127.0.0.1:4242"));
}

TEST_F(SharedNames, ManyAreCountedAndTheTrackersOwnAdviceStays) {
    hub.close(openTrack);
    ownAdvice = "The sun is low.";
    hub.open(openTrack, false);
    hub.setRoles({{"hand", PoseRole::pointer}, {"head", PoseRole::head}, {"tablet", PoseRole::device}});
    take(sim, kFirstPlace, {"hand", "head", "tablet"});
    take(openTrack, kSecondPlace, {"head", "tablet", "hand", "chair"});
    EXPECT_THAT(adviceOf(openTrack),
                AllOf(StartsWith("The sun is low. 'hand' and 2 other bodies of this tracker are not followed: "),
                      HasSubstr("rename the bodies")));
}

TEST(SharedNamesInThreads, MaySendAndBeAskedAtOnceAndNothingIsMixed) {
    const auto clock = std::make_shared<SteadyClock>();
    const auto board = std::make_shared<PoseBoard>();
    TrackerHub hub(board, clock, [](const std::string& uri, const TrackerOptions&) {
        TrackerStatus status;
        status.address = uri;
        return std::make_unique<PlainTracker>(status);
    });
    hub.setRoles({{"head", PoseRole::head}});
    for (const char* uri : {"one", "other"}) hub.open(uri, false);
    std::atomic<int> sending{2};
    const auto send = [&](const std::string& uri, const glm::dvec3& position) {
        for (int i = 0; i < 5000; ++i)
            hub.take(uri, {1, clock->now(), clock->now(), {{1, "head", true, {position, {1, 0, 0, 0}}}}});
        --sending;
    };
    const std::jthread one([&] { send("one", kFirstPlace); });
    const std::jthread other([&] { send("other", kSecondPlace); });
    while (sending > 0) {
        (void)hub.status();
        for (const PoseBoard::Entry& entry : board->entries()) {
            const auto pose = entry.stream->at(clock->now(), clock->now());
            if (!pose) continue;
            const double here = glm::distance(pose->position, kFirstPlace);
            const double there = glm::distance(pose->position, kSecondPlace);
            ASSERT_LT(std::min(here, there), 1e-9) << "one of the two";
        }
    }
}

} // namespace
} // namespace lumorph
