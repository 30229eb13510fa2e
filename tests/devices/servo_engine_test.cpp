// Everything that may happen to a device, at random, without threads: what its board is told is decoded from the bytes
// and held against the limits exactly.

#include "devices/controllers/servo_engine.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/devices/engine_bench.h"
#include "tests/devices/wire_reader.h"
#include "tests/support/simulated_devices.h"

namespace lumorph {
namespace {

namespace in = servo_input;

struct EngineCase {
    const char* board;
    ControllerKind controller;
    int first;     ///< channel of the board's first servo
    double step;   ///< microseconds between two pulses it can be told
    double period; ///< seconds between two commands, at most
};

/// One servo as the wire tells of it.
struct HeardServo {
    std::vector<ServoSetup> setups; ///< those it may move by
    double changed = -1e9;          ///< counted time of the last change of them
    bool attached = false;
    bool inVain = false; ///< the board has let go of it by itself: it did not hear where it was sent last
    double pulse = 0.0;
    double at = 0.0;                  ///< counted time of the pulse
    std::optional<double> velocity{}; ///< mean of the last interval, microseconds a second
    double interval = 0.0;
    double rounding = 0.0; ///< of that interval's ends
    // Where a board moves by itself.
    double from = 0.0;
    Microseconds begin{0}; ///< by the engine's clock
    double takes = 0.0;

    [[nodiscard]] double greatest(double ServoSetup::*share) const {
        double most = 0.0;
        for (const ServoSetup& one : setups) most = std::max(most, one.*share * (one.pulseMax - one.pulseMin));
        return most;
    }
    [[nodiscard]] double place(Microseconds now) const {
        const double passed = 1e-6 * static_cast<double>((now - begin).count());
        if (passed < 0.0 || passed >= takes) return pulse;
        return from + (pulse - from) * passed / takes;
    }
};

class RandomSession {
public:
    static constexpr double kNoticed = 1.0; ///< seconds after which it is noticed that a board has let go
    RandomSession(const EngineCase& board, unsigned seed)
        : case_(board), random_(seed), profile_(profileOf(board)), bench_(profile_), reader_(board.controller) {
        for (const ServoSetup& servo : profile_.servos) servos_.push_back({{servo}});
        bench_.onWrite = [this](const auto& message) {
            for (const WireOrder& order : reader_.receive(message)) receive(order);
        };
        bench_.tell(in::Connect{});
    }

    void use() {
        disturb();
        const LinkPhase phase = phaseNow();
        if (phase == LinkPhase::unidentified) bench_.tell(in::Confirm{});
        if ((phase == LinkPhase::disarmed || phase == LinkPhase::stopped) && pick(12) == 0) {
            jumpAllowed_ = pick(3) == 0;
            bench_.tell(in::Arm{jumpAllowed_});
        }
        if (phase == LinkPhase::starting && pick(400) == 0) bench_.tell(in::Arm{jumpAllowed_ = true});
        if (pick(5) == 0) command();
        pass();
        compareWithBoard();
    }
    /// To rest, and all servos let go.
    void end() {
        bench_.fault([](BoardFaults& faults) { faults = {}; });
        bench_.unsent = 0;
        bench_.tell(in::Quit{});
        for (int i = 0; i < 1000 && !bench_.engine.done(); ++i) pass(5'000);
        ASSERT_TRUE(bench_.engine.done());
        for (const HeardServo& servo : servos_) ASSERT_FALSE(servo.attached);
        const TraceCheck check = checkTrace(bench_.rows);
        ASSERT_FALSE(check.difference) << "row " << check.difference->row << ": " << check.difference->text;
        replayed = check.bytesSent;
    }

    std::uint64_t orders = 0, attaches = 0, softAttaches = 0, stops = 0, reconnects = 0, replayed = 0;
    std::uint64_t comparisons = 0;
    double nearest = 0.0; ///< to the velocity limit

private:
    static DeviceProfile profileOf(const EngineCase& board) {
        DeviceProfile profile;
        profile.controller = board.controller;
        profile.address = "sim://" + std::string(board.board);
        profile.staggerSeconds = 0.05;
        profile.servos = test::unevenServos(board.first);
        return profile;
    }

    std::size_t pick(std::size_t count) { return random_() % count; }
    double number(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
    LinkPhase phaseNow() const { return bench_.engine.status().phase; }

    void disturb() {
        switch (pick(6000)) {
        case 0:
        case 1:
        case 2:
        case 3:
            stop();
            break;
        case 4:
        case 5:
            bench_.tell(in::Disarm{});
            break;
        case 6:
            bench_.fault([](BoardFaults& faults) { faults.unplugged = true; });
            break;
        case 7:
            if (pick(2) == 0) bench_.board->reboot();
            break;
        case 8:
            bench_.tell(in::Disconnect{});
            break;
        case 9:
            bench_.unsent = 1'000;
            break;
        case 10:
        case 11:
        case 12:
            bench_.clockIsAhead += Microseconds{static_cast<long>(number(-5e6, 5e6))};
            break;
        case 13:
            bench_.clockIsAhead = Microseconds{static_cast<long>(number(-1e15, 1e15))};
            break;
        case 14:
            bench_.tell(in::Released{});
            break;
        default:
            break;
        }
        if (pick(300) == 0) bench_.tell(in::Wiggle{pick(4)});
        if (pick(500) == 0) bench_.tell(in::Slow{pick(3) == 0});
        if (pick(1500) == 0) changeProfile();
        if (pick(60) == 0) {
            if (bench_.board->faults().unplugged) ++reconnects;
            bench_.fault([](BoardFaults& faults) { faults.unplugged = false; });
            bench_.unsent = 0;
            if (phaseNow() == LinkPhase::off) bench_.tell(in::Connect{});
        }
    }
    void stop() {
        bench_.tell(in::Stop{});
        ++stops;
        if (!bench_.isOpen()) return;
        for (const HeardServo& servo : servos_) ASSERT_FALSE(servo.attached) << "in the very step";
    }
    void command() {
        std::vector<double> strokes(pick(50) == 0 ? pick(6) : 3);
        for (double& stroke : strokes) stroke = number(-0.3, 1.3);
        if (pick(40) == 0 && !strokes.empty()) strokes[pick(strokes.size())] = pick(2) ? NAN : 1e30;
        bench_.tell(in::Command{strokes});
    }
    void changeProfile() {
        ServoSetup& servo = profile_.servos[pick(3)];
        if (pick(2) == 0) {
            servo.pulseMin = number(600.0, 1400.0);
            servo.pulseMax = servo.pulseMin + number(300.0, 1000.0);
        } else {
            servo.maxVelocity = number(0.3, 2.0);
            servo.maxAcceleration = number(2.0, 20.0);
        }
        for (std::size_t i = 0; i < servos_.size(); ++i) {
            if (profile_.servos[i] == servos_[i].setups.back()) continue;
            servos_[i].setups.push_back(profile_.servos[i]);
            servos_[i].changed = counted_;
            servos_[i].velocity.reset();
        }
        bench_.tell(in::Profile{profile_});
    }
    void pass(long microseconds = 0) {
        if (microseconds == 0) microseconds = pick(200) == 0 ? 90'000 : 1'000 + static_cast<long>(pick(12'000));
        // As the guard counts: whatever was not stalled, and forwards, at most 50 ms at once.
        const Microseconds now = bench_.now() + Microseconds{microseconds};
        if (bench_.unsent == 0) {
            if (now > tick_) counted_ += 1e-6 * static_cast<double>(std::min<long>((now - tick_).count(), 50'000));
            tick_ = now;
        }
        bench_.pass(microseconds);
        // By then a servo that was moving has braked, and has come back within new limits.
        for (HeardServo& servo : servos_)
            if (counted_ - servo.changed > 5.0) servo.setups = {servo.setups.back()};
    }

    void receive(const WireOrder& order) {
        const auto index = std::ranges::find(profile_.servos, order.channel, &ServoSetup::channel);
        ASSERT_NE(index, profile_.servos.end()) << "a channel of no servo";
        HeardServo& servo = servos_[static_cast<std::size_t>(index - profile_.servos.begin())];
        if (servo.attached && truthOf(order).pulse == 0.0) servo.inVain = true;
        if (!order.pulse) {
            servo.attached = false;
            return;
        }
        ++orders;
        if (servo.attached)
            follow(servo, order);
        else
            attach(servo, order);
        servo.takes = order.seconds;
        servo.begin = bench_.now();
        servo.pulse = *order.pulse;
        servo.at = counted_;
    }
    [[nodiscard]] SimulatedServo truthOf(const WireOrder& order) const {
        return bench_.board->servos().at(static_cast<std::size_t>(order.channel - case_.first));
    }
    void attach(HeardServo& servo, const WireOrder& order) {
        ++attaches;
        servo.attached = true;
        servo.velocity.reset();
        servo.from = *order.pulse;
        double low = 1e9, high = 0.0;
        // One that was given its place just before its limits were drawn in, starts there and is led back.
        const bool drawnInNow = counted_ - servo.changed < case_.period + 0.01;
        for (const ServoSetup* setup : {&servo.setups.front(), &servo.setups.back()}) {
            if (setup != &servo.setups.back() && !drawnInNow) continue;
            low = std::min(low, setup->pulseMin);
            high = std::max(high, setup->pulseMax);
        }
        ASSERT_GE(*order.pulse, low - 1e-9);
        ASSERT_LE(*order.pulse, high + 1e-9);
        const bool inVain = std::exchange(servo.inVain, false);
        if (jumpAllowed_) return;
        ++softAttaches;
        const SimulatedServo truth = truthOf(order);
        // What was on its way when it was let go; a board that moves by itself may have been in the middle of a way;
        // and one that starts anew just before a STOP tells nobody that it has.
        const double seconds = case_.period + 0.1 + servo.takes + (inVain ? kNoticed : 0.0);
        const double late = servo.greatest(&ServoSetup::maxVelocity) * seconds + 2.0 * case_.step;
        ASSERT_LE(std::abs(*order.pulse - truth.position), late) << "it jumps";
    }
    void follow(HeardServo& servo, const WireOrder& order) {
        double low = servo.pulse, high = servo.pulse;
        for (const ServoSetup& setup : servo.setups) {
            low = std::min(low, setup.pulseMin);
            high = std::max(high, setup.pulseMax);
        }
        ASSERT_GE(*order.pulse, low - 1e-9);
        ASSERT_LE(*order.pulse, high + 1e-9);
        const double limit = servo.greatest(&ServoSetup::maxVelocity);
        const double seconds = counted_ - servo.at;
        const double moved = *order.pulse - servo.pulse;
        const double rounding = errorOf(servo, servo.pulse) + errorOf(servo, *order.pulse);
        ASSERT_LE(std::abs(moved), limit * seconds + rounding + 1e-6);
        if (seconds > 0.0) {
            const double velocity = moved / seconds;
            if (servo.velocity) {
                const double change = servo.greatest(&ServoSetup::maxAcceleration) * (seconds + servo.interval);
                ASSERT_LE(std::abs(velocity - *servo.velocity),
                          change + rounding / seconds + servo.rounding / servo.interval + 1e-6)
                    << *servo.velocity << " us/s for " << servo.interval << " s, then " << velocity << " for "
                    << seconds << " s, to " << *order.pulse << " of channel " << order.channel;
            }
            if (servo.setups.size() == 1) nearest = std::max(nearest, (std::abs(moved) - case_.step) / seconds / limit);
            servo.velocity = velocity;
            servo.interval = seconds;
            servo.rounding = rounding;
        }
        servo.from = servo.place(bench_.now());
        if (order.seconds > 0.0) {
            ASSERT_LE(std::abs(*order.pulse - servo.from), limit * order.seconds + 1e-6);
        }
    }
    /// A pulse is rounded to the board's steps; at the ends of its range inwards.
    [[nodiscard]] double errorOf(const HeardServo& servo, double pulse) const {
        const bool atEnd = std::ranges::any_of(servo.setups, [&](const ServoSetup& setup) {
            return std::min(std::abs(pulse - setup.pulseMin), std::abs(pulse - setup.pulseMax)) < case_.step;
        });
        return atEnd ? case_.step : 0.5 * case_.step;
    }
    /// What the board was told is what it does: its own limits, told to it, do not stand in the way.
    void compareWithBoard() {
        if (case_.controller == ControllerKind::lewansoul || !bench_.isOpen()) return;
        const std::vector<SimulatedServo> truth = bench_.board->servos();
        for (std::size_t i = 0; i < servos_.size(); ++i) {
            const double pulse = truth.at(static_cast<std::size_t>(profile_.servos[i].channel - case_.first)).pulse;
            if (pulse == 0.0 || !servos_[i].attached) continue;
            ++comparisons;
            ASSERT_DOUBLE_EQ(pulse, servos_[i].pulse);
        }
    }

    EngineCase case_;
    std::mt19937 random_;
    DeviceProfile profile_;
    EngineBench bench_;
    WireReader reader_;
    std::vector<HeardServo> servos_;
    bool jumpAllowed_ = false;
    double counted_ = 0.0; ///< seconds, as the guard's promise counts them
    Microseconds tick_{0};
};

class ServoEngineWire : public testing::TestWithParam<EngineCase> {};

TEST_P(ServoEngineWire, BreaksNoLimitWhateverHappens) {
    std::uint64_t orders = 0, attaches = 0, soft = 0, stops = 0, reconnects = 0, replayed = 0, compared = 0;
    double nearest = 0.0;
    const std::uint64_t wanted = 1'000'000;
    for (unsigned seed = 1; orders < wanted && seed < 2000; ++seed) {
        RandomSession session(GetParam(), seed);
        for (int i = 0; i < 10'000; ++i) {
            session.use();
            ASSERT_FALSE(HasFailure()) << "seed " << seed << ", use " << i;
        }
        session.end();
        ASSERT_FALSE(HasFailure()) << "seed " << seed << ", at the end";
        orders += session.orders, attaches += session.attaches, soft += session.softAttaches;
        stops += session.stops, reconnects += session.reconnects, replayed += session.replayed;
        compared += session.comparisons;
        nearest = std::max(nearest, session.nearest);
    }
    const auto count = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
    std::printf("%s: %llu pulses on the wire, %llu starts (%llu without a jump), %llu STOPs, %llu reconnects, "
                "%llu bytes equal when run again, %.3f of the velocity limit\n",
                GetParam().board, count(orders), count(attaches), count(soft), count(stops), count(reconnects),
                count(replayed), nearest);
    EXPECT_GE(orders, wanted);
    EXPECT_GT(attaches, 200U);
    EXPECT_GT(soft, 50U);
    EXPECT_GT(stops, 50U);
    EXPECT_GT(reconnects, 10U);
    EXPECT_GT(nearest, 0.9);
    EXPECT_TRUE(compared > 50'000U || GetParam().controller == ControllerKind::lewansoul) << compared;
}

INSTANTIATE_TEST_SUITE_P(Boards, ServoEngineWire,
                         testing::Values(EngineCase{"tablet", ControllerKind::firmata, 2, 1.0, 0.05},
                                         EngineCase{"uno", ControllerKind::firmata, 2, 1.0, 0.05},
                                         EngineCase{"xarm", ControllerKind::lewansoul, 1, 2.0, 0.05},
                                         EngineCase{"maestro", ControllerKind::maestro, 0, 0.25, 0.05}),
                         [](const auto& board) { return std::string(board.param.board); });

/// How far from its horn a servo's first pulse lies, from now on.
std::optional<double> firstJump(EngineBench& bench, WireReader& reader, int channel, std::size_t servo) {
    std::optional<double> jump;
    bench.onWrite = [&](const auto& message) {
        for (const WireOrder& order : reader.receive(message))
            if (!jump && order.channel == channel && order.pulse)
                jump = std::abs(*order.pulse - bench.board->servos()[servo].position);
    };
    bench.runUntil([&] { return jump.has_value(); }, 5.0);
    bench.onWrite = nullptr;
    return jump;
}

// Over a slow line a board tells of a time when the servo was still on its way: started again by that, it would jump
// back. Whatever the moment of the STOP and of the start after it.
TEST(ServoEngine, AfterAStopAServoStartsWhereItIsNotWhereItWasReadInMotion) {
    DeviceProfile profile;
    profile.controller = ControllerKind::lewansoul;
    profile.address = "sim://xarm";
    profile.staggerSeconds = 0.05;
    profile.servos = {{.channel = 1, .maxVelocity = 1.5, .maxAcceleration = 30.0}};
    double farthest = 0.0;
    double fastest = 0.0;
    for (int round = 0; round < 40; ++round) {
        EngineBench bench(profile);
        WireReader reader(ControllerKind::lewansoul);
        bench.onWrite = [&](const auto& message) { (void)reader.receive(message); };
        ASSERT_TRUE(bench.connect());
        bench.tell(in::Command{{0.0}});
        bench.tell(in::Arm{true});
        ASSERT_TRUE(bench.reaches(LinkPhase::live));
        bench.run(2.0);
        bench.fault([](BoardFaults& faults) { faults.jitterMilliseconds = 120.0; });
        bench.tell(in::Command{{1.0}});
        bench.run(0.35 + 0.0073 * round);
        fastest = std::max(fastest, bench.board->servos()[0].fastest);
        bench.tell(in::Stop{});
        bench.run(0.005 + 0.011 * (round % 9));
        bench.tell(in::Command{{bench.engine.status().servos[0].commanded}});
        bench.tell(in::Arm{false});
        const auto jump = firstJump(bench, reader, 1, 0);
        ASSERT_TRUE(jump) << "it is known where it is";
        farthest = std::max(farthest, *jump);
    }
    std::printf("at most %.0f us from where the servo was, at up to %.0f us/s\n", farthest, fastest);
    EXPECT_GT(fastest, 1000.0);
    EXPECT_LT(farthest, 280.0);
}

// What cannot be sent any more holds nobody up for ever.
TEST(ServoEngine, ClosesThoughItsLineTakesNothing) {
    DeviceProfile profile;
    profile.address = "sim://tablet";
    profile.servos = {{.channel = 2}};
    for (const bool quits : {false, true}) {
        EngineBench bench(profile);
        ASSERT_TRUE(bench.connect());
        bench.unsent = 1'000;
        if (quits)
            bench.tell(in::Quit{});
        else
            bench.tell(in::Disconnect{});
        bench.run(0.5);
        EXPECT_TRUE(bench.isOpen()) << "what lets servos go may still leave";
        bench.run(1.5);
        EXPECT_FALSE(bench.isOpen());
        EXPECT_EQ(bench.engine.done(), quits);
    }
}

// What was sent last may never have arrived: after a silence, as after a lost link, nobody knows where servos are that
// were on their way. What stood still stands there still.
TEST(ServoEngine, ServosThatWereOnTheirWayWhenTheBoardFellSilentAreNotTakenToBeKnown) {
    DeviceProfile profile;
    profile.address = "sim://tablet";
    profile.servos = {{.channel = 2, .maxVelocity = 0.2}};
    for (const bool unplugged : {false, true})
        for (const bool moves : {true, false}) {
            EngineBench bench(profile);
            ASSERT_TRUE(bench.connect());
            bench.tell(in::Command{{0.0}});
            bench.tell(in::Arm{true});
            ASSERT_TRUE(bench.reaches(LinkPhase::live));
            bench.run(4.0);
            if (moves) bench.tell(in::Command{{1.0}});
            bench.run(1.0);
            bench.fault([&](BoardFaults& faults) { (unplugged ? faults.unplugged : faults.silent) = true; });
            bench.run(1.5);
            EXPECT_EQ(bench.engine.status().phase, LinkPhase::lost);
            bench.fault([](BoardFaults& faults) { faults = {}; });
            ASSERT_TRUE(bench.becomesReady());
            EXPECT_EQ(bench.engine.status().servos[0].known, !moves) << (unplugged ? "unplugged" : "silent");
            bench.tell(in::Arm{false});
            bench.run(1.0);
            EXPECT_EQ(bench.engine.status().waiting.empty(), !moves) << (unplugged ? "unplugged" : "silent");
        }
}

TEST(ServoEngine, PausesLongOnlyWhileTheLinkIsSwitchedOff) {
    constexpr Microseconds kShort{50'000}, kLong{500'000};
    DeviceProfile profile;
    profile.address = "sim://tablet";
    profile.servos = {{.channel = 2}};
    EngineBench bench(profile);
    EXPECT_GE(bench.engine.pause(), kLong) << "not connected yet";
    ASSERT_TRUE(bench.connect());
    EXPECT_LE(bench.engine.pause(), kShort);
    bench.fault([](BoardFaults& faults) { faults.unplugged = true; });
    bench.run(1.0);
    EXPECT_LE(bench.engine.pause(), kShort) << "it waits for the board to come back";
    bench.tell(in::Disconnect{});
    bench.run(1.0);
    EXPECT_GE(bench.engine.pause(), kLong);
}

} // namespace
} // namespace lumorph
