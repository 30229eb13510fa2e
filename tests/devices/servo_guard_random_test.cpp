// A million random things done to a guard, and all bounds computed anew from the profile.

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "devices/controllers/servo_guard.h"
#include "tests/devices/guard_key.h"
#include "tests/support/not_a_number.h"

namespace lumorph {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// What one servo may do, as this test sees it: in microseconds, and knowing nothing of strokes inside the guard.
struct Oracle {
    ServoSetup setup;
    std::vector<ServoSetup> braking; ///< setups it may still brake by
    bool attached = false;
    bool jumped = false;
    bool still = true;
    double pulse = 0.0;
    double velocity = 0.0;              ///< microseconds a second
    double attachedFor = 0.0;           ///< seconds that count
    std::optional<double> knownPulse{}; ///< while detached

    [[nodiscard]] double span() const { return setup.pulseMax - setup.pulseMin; }
    [[nodiscard]] double affine(double stroke) const {
        const double way = stroke * span();
        return (setup.reversed ? setup.pulseMax - way : setup.pulseMin + way) + setup.trim;
    }
    void find(std::optional<double> at, double strokeError = 0.0) {
        knownPulse.reset();
        const double error = strokeError * span() + 1e-6;
        if (at && *at >= setup.pulseMin - error && *at <= setup.pulseMax + error)
            knownPulse = std::clamp(*at, setup.pulseMin, setup.pulseMax);
    }
    double settling = 0.5; ///< seconds after a jump
    void detach() {
        if (!attached) return;
        attached = false;
        velocity = 0.0;
        braking.clear();
        find(jumped && attachedFor < settling - 1e-9 ? std::nullopt : std::optional(pulse));
    }
};

class RandomUse {
public:
    explicit RandomUse(unsigned seed) : random_(seed), profile_(randomProfile()), guard_(testGuardKey(), profile_) {
        for (const ServoSetup& setup : profile_.servos) oracles_.push_back({setup, {}});
    }

    void use() {
        switch (pick(40)) {
        case 0:
            wantBadly();
            break;
        case 1:
            arm();
            break;
        case 2:
            if (pick(8) == 0) {
                guard_.stop();
                stopped_ = true;
                limp();
            }
            break;
        case 3:
            if (pick(8) == 0) {
                guard_.disarm();
                limp();
            }
            break;
        case 4:
            guard_.wiggle(pick(5));
            break;
        case 5:
            guard_.setSlow(pick(2) == 0);
            break;
        case 6:
            if (pick(6) == 0) change();
            break;
        case 7:
            find();
            break;
        case 8:
            pass(number(-5e6, 5e6));
            break;
        case 9:
            if (pick(20) == 0) now_ = pick(2) ? Microseconds::max() : Microseconds::min();
            break;
        case 10:
        case 11:
            want();
            break;
        default:
            advance();
            break;
        }
        step();
    }

    int moves = 0, attaches = 0, jumps = 0, changesInMotion = 0;
    double nearestToLimit = 0.0;

private:
    std::size_t pick(std::size_t count) { return random_() % count; }
    double number(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }

    ServoSetup randomSetup(int channel) {
        ServoSetup setup;
        setup.channel = channel;
        setup.pulseMin = number(500.0, 1500.0);
        setup.pulseMax = setup.pulseMin + number(100.0, 1000.0);
        setup.reversed = pick(2) == 0;
        setup.trim = pick(2) ? 0.0 : number(-0.3, 0.3) * (setup.pulseMax - setup.pulseMin);
        setup.maxVelocity = std::exp(number(std::log(0.1), std::log(10.0)));
        setup.maxAcceleration = std::exp(number(std::log(0.5), std::log(100.0)));
        return setup;
    }
    DeviceProfile randomProfile() {
        DeviceProfile profile;
        for (int i = 0; i < 3; ++i) profile.servos.push_back(randomSetup(i));
        profile.staggerSeconds = pick(3) == 0 ? 0.0 : number(0.0, 0.6);
        profile.slowShare = number(0.1, 1.0);
        return profile;
    }

    void advance() {
        static constexpr long kTops[] = {3, 1'000, 6'000, 20'000, 60'000};
        pass(number(0.0, static_cast<double>(kTops[pick(5)])));
    }
    /// A clock at the end of its range starts again.
    void pass(double microseconds) {
        constexpr Microseconds kFar{1'000'000'000'000'000};
        if (now_ > kFar || now_ < -kFar) now_ = Microseconds{0};
        now_ += Microseconds{static_cast<long>(microseconds)};
    }
    void want() {
        wanted_.resize(3);
        for (double& stroke : wanted_) stroke = pick(4) ? number(0.0, 1.0) : number(-1.0, 2.0);
        if (pick(20) == 0) wanted_[pick(3)] = pick(2) ? 1e300 : -1e300;
        EXPECT_TRUE(guard_.want(wanted_));
    }
    void wantBadly() {
        std::vector<double> strokes(pick(3) ? 3 : pick(3), 0.5);
        if (strokes.size() == 3) strokes[pick(3)] = pick(2) ? kNan : pick(2) ? kUnbounded : -kUnbounded;
        EXPECT_FALSE(guard_.want(strokes));
    }
    void arm() {
        stopped_ = disarmed_ = false;
        jumpAllowed_ = pick(2) == 0;
        guard_.arm(jumpAllowed_);
    }
    void limp() {
        disarmed_ = true;
        for (Oracle& oracle : oracles_) oracle.detach();
    }
    void find() {
        const std::size_t i = pick(4);
        const double stroke = pick(6) ? number(0.0, 1.0) : pick(2) ? kNan : number(-9.0, 9.0);
        const bool forget = pick(4) == 0;
        guard_.setKnown(i, forget ? std::nullopt : std::optional(stroke));
        if (i >= 3) return;
        Oracle& oracle = oracles_[i];
        const bool nothing = forget || !std::isfinite(stroke);
        if (oracle.attached && !nothing) return;
        oracle.detach();
        oracle.find(nothing ? std::nullopt : std::optional(oracle.affine(stroke)), 0.02);
    }
    void change() {
        DeviceProfile next = profile_;
        ServoSetup& setup = next.servos[pick(3)];
        const ServoSetup other = randomSetup(setup.channel);
        if (pick(5) == 0)
            setup.channel += 3;
        else if (pick(4) == 0)
            setup.reversed = !setup.reversed;
        else if (pick(2))
            setup = other, setup.reversed = profile_.servos[other.channel % 3].reversed;
        else
            setup.maxVelocity = other.maxVelocity, setup.maxAcceleration = other.maxAcceleration;
        if (setup.channel > 100) setup.channel -= 99;
        if (pick(10) == 0) {
            next.servos[0].trim = kNan;
            EXPECT_THROW(guard_.setProfile(next), InvalidInput);
            return;
        }
        if (pick(3) == 0) next.slowShare = number(0.1, 1.0);
        guard_.setProfile(next);
        for (std::size_t i = 0; i < 3; ++i) change(oracles_[i], next.servos[i]);
        profile_ = next;
    }
    void change(Oracle& oracle, const ServoSetup& next) {
        if (next == oracle.setup) return;
        const bool elsewhere = next.channel != oracle.setup.channel;
        if (elsewhere || next.reversed != oracle.setup.reversed) oracle.detach();
        if (oracle.attached && !oracle.still) {
            oracle.braking.push_back(oracle.setup);
            ++changesInMotion;
        }
        oracle.setup = next;
        if (!oracle.attached) oracle.find(elsewhere ? std::nullopt : oracle.knownPulse);
    }

    void step() {
        const Microseconds before = last_.value_or(now_);
        last_ = now_;
        double seconds = 0.0;
        if (now_ > before) {
            // As long double: the difference of the ends of time is no 64-bit number.
            const long double gap = static_cast<long double>(now_.count()) - static_cast<long double>(before.count());
            seconds = static_cast<double>(std::min(gap * 1e-6L, 0.05L));
        }
        const GuardedPulses pulses = guard_.step(now_);
        ASSERT_EQ(pulses.servos().size(), 3U);
        sinceAttach_ += seconds;
        int attachedNow = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const GuardedPulse& pulse = pulses.servos()[i];
            Oracle& oracle = oracles_[i];
            ASSERT_EQ(pulse.channel, oracle.setup.channel);
            ASSERT_FALSE(pulse.attached && (stopped_ || disarmed_));
            if (oracle.attached) {
                ASSERT_TRUE(pulse.attached);
                follow(oracle, pulse.microseconds, seconds);
            } else if (pulse.attached) {
                ++attachedNow;
                attach(oracle, pulse.microseconds);
            }
            if (testing::Test::HasFatalFailure()) return;
        }
        ASSERT_LE(attachedNow, 1);
    }
    void attach(Oracle& oracle, double pulse) {
        ASSERT_GE(sinceAttach_, profile_.staggerSeconds - 1e-9);
        ASSERT_GE(pulse, oracle.setup.pulseMin);
        ASSERT_LE(pulse, oracle.setup.pulseMax);
        oracle.jumped = !oracle.knownPulse;
        oracle.settling = std::max(0.5, profile_.staggerSeconds);
        if (oracle.knownPulse) {
            ASSERT_NEAR(pulse, *oracle.knownPulse, 1e-6);
        } else {
            ASSERT_TRUE(jumpAllowed_) << "nobody was asked";
            ++jumps;
        }
        sinceAttach_ = 0.0;
        oracle.attached = true;
        oracle.pulse = pulse;
        oracle.velocity = 0.0;
        oracle.still = true;
        oracle.attachedFor = 0.0;
        ++attaches;
    }
    void follow(Oracle& oracle, double pulse, double seconds) {
        double velocity = 0.0, acceleration = 0.0, low = oracle.pulse, high = oracle.pulse;
        oracle.braking.push_back(oracle.setup);
        for (const ServoSetup& setup : oracle.braking) {
            velocity = std::max(velocity, setup.maxVelocity * (setup.pulseMax - setup.pulseMin));
            acceleration = std::max(acceleration, setup.maxAcceleration * (setup.pulseMax - setup.pulseMin));
            low = std::min(low, setup.pulseMin);
            high = std::max(high, setup.pulseMax);
        }
        oracle.braking.pop_back();
        ASSERT_GE(pulse, low - 1e-9);
        ASSERT_LE(pulse, high + 1e-9);
        const double moved = pulse - oracle.pulse;
        ASSERT_LE(std::abs(moved), velocity * seconds + 1e-9);
        ASSERT_LE(std::abs(moved - oracle.velocity * seconds), acceleration * seconds * seconds + 1e-7);
        const bool justAttached = oracle.attachedFor + 1e-9 < profile_.staggerSeconds;
        ASSERT_FALSE(justAttached && std::abs(moved) > 1e-9);
        if (seconds > 0.0) {
            oracle.velocity = moved / seconds;
            oracle.still = std::abs(moved) < 1e-10;
            if (oracle.still)
                oracle.braking.clear();
            else
                ++moves, nearestToLimit = std::max(nearestToLimit, std::abs(oracle.velocity) / velocity);
        }
        oracle.attachedFor += seconds;
        oracle.pulse = pulse;
    }

    std::mt19937 random_;
    DeviceProfile profile_;
    ServoGuard guard_;
    std::vector<Oracle> oracles_;
    std::vector<double> wanted_;
    Microseconds now_{0};
    std::optional<Microseconds> last_;
    double sinceAttach_ = 1e9;
    bool stopped_ = false, disarmed_ = true, jumpAllowed_ = false;
};

TEST(ServoGuard, NeverBreaksALimitInAMillionRandomUses) {
    int moves = 0, attaches = 0, jumps = 0, changes = 0;
    double nearest = 0.0;
    for (unsigned seed = 1; seed <= 50; ++seed) {
        RandomUse use(seed);
        for (int i = 0; i < 20'000; ++i) {
            use.use();
            ASSERT_FALSE(HasFailure()) << "seed " << seed << ", use " << i;
        }
        moves += use.moves, attaches += use.attaches, jumps += use.jumps, changes += use.changesInMotion;
        nearest = std::max(nearest, use.nearestToLimit);
    }
    // It was a test of servos that move.
    EXPECT_GT(moves, 300'000);
    EXPECT_GT(attaches, 5'000);
    EXPECT_GT(attaches - jumps, 2'000);
    EXPECT_GT(jumps, 500);
    EXPECT_GT(changes, 500);
    EXPECT_GT(nearest, 0.999);
}

} // namespace
} // namespace lumorph
