#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include <QComboBox>
#include <gtest/gtest.h>

#include "app/studio/devices/hand_watch.h"
#include "app/studio/devices/held_servos.h"
#include "app/workspaces/devices/device_words.h"
#include "tests/ui/devices_window.h"

// Slow near hands: by a tracked hand, and by a servo that does not follow.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;
using studio::HandSense;
using studio::HandWatch;
using studio::HeldServos;

constexpr Microseconds kTick{50'000};

/// A link whose one servo is told and read.
LinkStatus linkWith(double commanded, std::optional<double> readBack, bool attached = true) {
    LinkStatus link;
    link.phase = LinkPhase::live;
    ServoStatus servo;
    servo.commanded = commanded;
    servo.readBack = readBack;
    servo.attached = attached;
    link.servos = {servo};
    return link;
}

/// Seconds until it is said to be held, when `told` and `read` are its strokes by time; negative: never.
template <typename Told, typename Read> double heldAfter(Told told, Read read, double seconds) {
    HeldServos servos;
    for (Microseconds now{1'000'000}; now < Microseconds{1'000'000} + Microseconds(std::llround(1e6 * seconds));
         now += kTick) {
        const double t = 1e-6 * static_cast<double>((now - Microseconds{1'000'000}).count());
        servos.look(linkWith(told(t), read(t)), now);
        if (!servos.held().empty()) return t;
    }
    return -1.0;
}

TEST(HeldServosTest, AServoThatStaysBehindIsHeldAndOneThatFollowsIsNot) {
    const auto wave = [](double t) { return 0.5 + 0.4 * std::sin(2.0 * std::numbers::pi * t / 3.0); };
    const auto late = [&](double t) { return wave(t - 0.4); }; // the wire, the way, and the next reading
    const auto jump = [](double t) { return t < 1.0 ? 0.2 : 0.8; };
    const auto stuck = [](double) { return 0.2; };
    EXPECT_LT(heldAfter(wave, late, 60.0), 0.0) << "it follows, as late as it is";
    EXPECT_LT(heldAfter(
                  stuck, [](double) { return 0.27; }, 60.0),
              0.0)
        << "an arm's weight";
    // Told at 1 s; it should have arrived 0.6 s later, and 0.3 s are waited.
    const double after = heldAfter(jump, stuck, 5.0);
    EXPECT_GE(after, 1.0 + 0.6 + 0.3 - 1e-9);
    EXPECT_LE(after, 1.0 + 0.6 + 0.3 + 0.1);
    EXPECT_GT(heldAfter(wave, stuck, 10.0), 0.0) << "while it moves, too";
    EXPECT_LT(heldAfter(
                  jump, [](double) { return std::optional<double>(); }, 5.0),
              0.0)
        << "nobody reads it";
    EXPECT_LT(heldAfter(
                  jump, [](double t) { return t > 1.2 && t < 1.4 ? 0.2
                                              : t < 1.4          ? 0.2
                                                                 : 0.8; }, 5.0),
              0.0);
}

TEST(HeldServosTest, ItIsFreeTwoSecondsAfterItFollowsAgainOrAtOnceWhereItIsLimp) {
    HeldServos servos;
    Microseconds now{0};
    const auto run = [&](const LinkStatus& link, double seconds) {
        const Microseconds end = now + Microseconds(std::llround(1e6 * seconds));
        for (; now < end; now += kTick) servos.look(link, now);
    };
    run(linkWith(0.8, 0.2), 2.0);
    ASSERT_EQ(servos.held(), std::vector<std::size_t>{0});
    run(linkWith(0.8, 0.79), 1.9);
    EXPECT_FALSE(servos.held().empty());
    run(linkWith(0.8, 0.79), 0.3);
    EXPECT_TRUE(servos.held().empty());
    run(linkWith(0.8, 0.2), 2.0);
    ASSERT_FALSE(servos.held().empty());
    run(linkWith(0.8, 0.2, false), 0.05);
    EXPECT_TRUE(servos.held().empty()) << "a limp servo may be where it likes";
}

TEST(HeldServosTest, AShowThatComesByWhereItIsHeldDoesNotFreeIt) {
    HeldServos servos;
    bool held = false;
    for (Microseconds now{0}; now < Microseconds{60'000'000}; now += kTick) {
        const double t = 1e-6 * static_cast<double>(now.count());
        servos.look(linkWith(0.5 + 0.4 * std::sin(2.0 * std::numbers::pi * t / 8.0), 0.5), now);
        EXPECT_GE(servos.held().size(), held ? 1U : 0U) << t;
        held = held || !servos.held().empty();
    }
    EXPECT_TRUE(held);
}

class HandWatchTest : public ::testing::Test {
protected:
    HandWatchTest() {
        watch.setPoses(poses);
        MatchFrame frame;
        frame.devicePositions = std::make_shared<const std::vector<glm::vec3>>(
            std::vector<glm::vec3>{{-0.1F, 0.0F, -0.1F}, {0.1F, 0.02F, 0.1F}});
        frame.worldFromDevice[3] = {1.0F, 0.0F, 0.0F, 1.0F};
        watch.follow(frame);
    }
    /// The hand stays so high over the device for a while; nothing: the tracker does not see it. Near at the end?
    bool hold(std::optional<double> metres, double seconds) {
        bool near = false;
        for (Microseconds end = now + Microseconds(std::llround(1e6 * seconds)); now < end; now += kTick) {
            if (metres) (void)hand->push({now, true, {{1.0, 0.02 + *metres, 0.0}, {1, 0, 0, 0}}});
            near = watch.look(now);
        }
        return near;
    }

    std::shared_ptr<PoseBoard> poses = std::make_shared<PoseBoard>();
    std::shared_ptr<PoseStream> hand = poses->stream("hand", PoseRole::pointer);
    HandWatch watch;
    Microseconds now{10'000'000};
};

TEST_F(HandWatchTest, AHandIsNearFromTheLimitUntilItHasBeenAwayForAWhile) {
    EXPECT_FALSE(hold(0.11, 1.0));
    ASSERT_TRUE(watch.distance());
    EXPECT_NEAR(*watch.distance(), 0.11, 1e-3);
    EXPECT_TRUE(hold(0.06, 1.0));
    EXPECT_TRUE(hold(0.115, 2.0)) << "a hand that trembles at the limit does not switch to and fro";
    EXPECT_TRUE(hold(0.3, 0.3));
    EXPECT_FALSE(hold(0.3, 0.5));
}

TEST_F(HandWatchTest, AHandThatIsLostWhereItWasNearCountsForTwoSeconds) {
    EXPECT_FALSE(hold(std::nullopt, 1.0));
    EXPECT_FALSE(watch.distance()) << "nobody senses hands, and none is said to be far";
    EXPECT_TRUE(hold(0.05, 1.0));
    EXPECT_TRUE(hold(std::nullopt, 1.5));
    EXPECT_FALSE(watch.distance());
    EXPECT_FALSE(hold(std::nullopt, 1.0));
}

TEST_F(HandWatchTest, ALimitOfZeroHeedsNoHand) {
    watch.setLimit(0.0);
    EXPECT_FALSE(hold(0.0, 1.0));
    watch.setLimit(0.4);
    EXPECT_TRUE(hold(0.3, 1.0));
}

TEST(DeviceWordsOfHands, SayWhatSensesHandsAndThatNothingDoes) {
    const QStringList servos{"left", "middle", "right"};
    const struct {
        HandSense hands;
        const char* words;
    } rows[] = {
        {{}, "Hands are not sensed"},
        {{{}, false, {}, true}, "Hands are not tracked; a servo that is held is felt"},
        {{0.434, false, {}, false}, "A hand is tracked 43 cm away"},
        {{0.06, true, {}, false}, "Slow: a hand is tracked 6 cm away"},
        {{{}, true, {}, false}, "Slow: a hand was near when it was seen last"},
        {{0.06, true, {1}, true}, "Slow: servo 2 (middle) is held, or stuck"},
        {{{}, false, {0, 2}, true}, "Slow: servos 1 and 3 are held, or stuck"},
    };
    for (const auto& row : rows) EXPECT_EQ(studio::handsText(row.hands, servos).toStdString(), row.words);
    const std::vector<LinkEvent> held = studio::handEvents({}, {{}, false, {2}, true}, Microseconds{5});
    ASSERT_EQ(held.size(), 1U);
    EXPECT_EQ(held.front().text, "Servo 3 is held or stuck: all servos are slow.");
    EXPECT_EQ(held.front().kind, LinkEvent::Kind::warning);
}

/// The greatest speed of a servo's pulse while it goes its whole way, microseconds a second.
class PulseSpeed {
public:
    void see(double pulse) {
        const auto now = std::chrono::steady_clock::now();
        if (begun_ && now - at_ < 100ms) return; // the wire's steps
        if (begun_)
            fastest_ = std::max(fastest_, std::abs(pulse - pulse_) / std::chrono::duration<double>(now - at_).count());
        begun_ = true;
        at_ = now;
        pulse_ = pulse;
    }
    [[nodiscard]] double fastest() const { return fastest_; }

private:
    bool begun_ = false;
    std::chrono::steady_clock::time_point at_;
    double pulse_ = 0.0;
    double fastest_ = 0.0;
};

using DevicesWindowHands = DevicesWindow;

TEST_F(DevicesWindowHands, AHandThatIsTrackedNearMakesServosSlowAndIsTold) {
    goLive();
    EXPECT_EQ(window.text("devices.hands"), "Hands are not sensed");
    const auto poses = std::make_shared<PoseBoard>();
    const auto hand = poses->stream("hand", PoseRole::pointer);
    window.studio().devices.setPoses(poses);
    double height = 0.5;
    const auto track = [&] {
        const studio::StudioLoop& loop = window.studio().loop;
        const glm::vec3 top = glm::vec3(loop.frame()->worldFromDevice[3]) + glm::vec3(0.0F, 0.2F, 0.0F);
        (void)hand->push({SteadyClock().now(), true, {glm::dvec3(top) + glm::dvec3(0.0, height, 0.0), {1, 0, 0, 0}}});
    };
    const auto says = [&](const QString& words) {
        return eventually([&] {
            track();
            return window.text("devices.hands").contains(words);
        });
    };
    EXPECT_TRUE(says("A hand is tracked")) << window.text("devices.hands").toStdString();
    EXPECT_FALSE(window.studio().devices.status().slow);
    height = -0.15; // 5 cm over its origin: inside it, or nearly
    EXPECT_TRUE(says("Slow: a hand is tracked")) << window.text("devices.hands").toStdString();
    EXPECT_TRUE(eventually([&] {
        track();
        return window.studio().devices.status().slow;
    }));
    EXPECT_TRUE(logs("A hand is near: servos are slow."));
    EXPECT_FALSE(window.studio().devices.slow()) << "the user's own switch stays as it is";
    window.screenshot("devices-hand-near");
    const DeviceProfile& profile = window.studio().devices.profile();
    const ServoSetup& setup = profile.servos[0];
    PulseSpeed speed;
    setByHand(0, 1.0);
    EXPECT_TRUE(eventually([&] {
        track();
        speed.see(servoOf(0).pulse);
        return servoOf(0).pulse >= setup.pulseMax - 2.0;
    }));
    const double allowed = profile.slowShare * setup.maxVelocity * (setup.pulseMax - setup.pulseMin);
    EXPECT_LE(speed.fastest(), 1.3 * allowed);
    height = 0.5;
    EXPECT_TRUE(says("A hand is tracked"));
    EXPECT_TRUE(eventually([&] {
        track();
        return !window.studio().devices.status().slow;
    }));
    EXPECT_TRUE(logs("No hand is near any more"));
}

TEST_F(DevicesWindowHands, AServoThatIsHeldMakesAllSlowAndIsTold) {
    use("xarm");
    goLiveByAddress();
    EXPECT_TRUE(eventually([&] { return window.text("devices.hands").contains("a servo that is held is felt"); }));
    showSimulator();
    const int channel = window.studio().devices.profile().servos[2].channel;
    auto* held = window.find<QComboBox>("sim.held");
    ASSERT_NE(held, nullptr);
    const int row = held->findText("channel " + QString::number(channel));
    ASSERT_GT(row, 0);
    held->setCurrentIndex(row);
    emit held->activated(row);
    setByHand(2, 1.0);
    EXPECT_TRUE(eventually([&] { return window.studio().devices.status().slow; }));
    EXPECT_TRUE(eventually([&] { return window.text("devices.hands").startsWith("Slow: servo 3 ("); }))
        << window.text("devices.hands").toStdString();
    EXPECT_TRUE(logs("Servo 3 is held or stuck: all servos are slow."));
    EXPECT_TRUE(tells("Servo 3 is held or stuck"));
    EXPECT_TRUE(allDriven()) << "it is no STOP";
    window.screenshot("devices-held");
    held->setCurrentIndex(0);
    emit held->activated(0);
    EXPECT_TRUE(eventually([&] { return !window.studio().devices.status().slow; }));
    EXPECT_TRUE(logs("All servos follow again"));
    EXPECT_TRUE(eventually([&] { return std::abs(servoOf(2).position - servoOf(2).pulse) < 5.0; }));
}

} // namespace
} // namespace lumorph::test
