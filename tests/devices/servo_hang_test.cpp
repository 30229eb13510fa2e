// A program that was stopped, or had no processor, for some seconds: what its servos do then, and what its user is
// told.

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "devices/controllers/controller_kinds.h"
#include "tests/devices/engine_bench.h"

namespace lumorph {
namespace {

namespace in = servo_input;
using testing::HasSubstr;
using testing::Not;

struct HangCase {
    const char* board;
    ControllerKind controller;
    int first;
};

class ServoHang : public testing::TestWithParam<HangCase> {
protected:
    ServoHang() : bench_(profile()) {}
    static DeviceProfile profile() {
        DeviceProfile profile;
        profile.controller = GetParam().controller;
        profile.address = "sim://" + std::string(GetParam().board);
        profile.staggerSeconds = 0.05;
        for (int i = 0; i < 3; ++i) profile.servos.push_back({.channel = GetParam().first + i});
        return profile;
    }
    void goLive() {
        ASSERT_TRUE(bench_.connect());
        bench_.tell(in::Command{{0.2, 0.5, 0.8}});
        bench_.tell(in::Arm{true});
        ASSERT_TRUE(bench_.reaches(LinkPhase::live));
        bench_.run(4.0);
        bench_.said.clear();
    }
    [[nodiscard]] bool limp() const {
        return std::ranges::all_of(bench_.board->servos(), [](const SimulatedServo& s) { return s.pulse == 0.0; });
    }
    void expectToldOfHang() {
        EXPECT_THAT(bench_.said, HasSubstr("Lumorph itself was stuck for"));
        for (const char* untrue : {"silent", "lost", "restarted", "does not answer", "Silence", "by itself", "noisy"})
            EXPECT_THAT(bench_.said, Not(HasSubstr(untrue)));
    }

    EngineBench bench_;
};

TEST_P(ServoHang, OfThreeSecondsLetsServosGoUntilTheirUserStartsThemAgain) {
    goLive();
    bench_.tell(in::Command{{0.8, 0.5, 0.2}});
    bench_.run(0.3);
    bench_.pass(3'000'000); // no tick, and nothing is read
    bench_.tell(in::Command{{0.9, 0.9, 0.9}});
    bench_.run(2.0);
    expectToldOfHang();
    EXPECT_TRUE(limp());
    EXPECT_EQ(bench_.engine.status().phase, LinkPhase::disarmed);
    EXPECT_TRUE(bench_.engine.status().controller.answering);
    if (!bench_.engine.status().controller.traits.readsPosition) {
        for (const ServoStatus& servo : bench_.engine.status().servos) EXPECT_FALSE(servo.known);
    }
    bench_.tell(in::Arm{true});
    EXPECT_TRUE(bench_.reaches(LinkPhase::live));
    EXPECT_FALSE(bench_.engine.release() == std::nullopt);
}

// The failsafe process measures by itself, and may find a second where the engine sees a little less.
TEST_P(ServoHang, ThatTheFailsafeProcessNoticedIsToldOnce) {
    goLive();
    bench_.tell(in::Released{});
    bench_.run(0.5);
    expectToldOfHang();
    EXPECT_TRUE(limp());
    bench_.said.clear();
    bench_.tell(in::Released{});
    bench_.run(0.5);
    EXPECT_EQ(bench_.said, "");
}

TEST_P(ServoHang, OfAMomentPassesUnnoticed) {
    goLive();
    bench_.pass(300'000);
    bench_.run(1.0);
    EXPECT_EQ(bench_.said, "");
    EXPECT_EQ(bench_.engine.status().phase, LinkPhase::live);
}

// A board that is silent is told of all the same, soon after a hang too.
TEST_P(ServoHang, DoesNotHideABoardThatFallsSilent) {
    goLive();
    bench_.fault([](BoardFaults& faults) { faults.silent = true; });
    bench_.pass(3'000'000);
    bench_.run(1.5);
    EXPECT_THAT(bench_.said, HasSubstr("fallen silent"));
}

// What the failsafe process writes comes from nothing but the profile: it lets go of every servo of the board.
TEST_P(ServoHang, ReleaseAloneLetsEveryServoGo) {
    goLive();
    const std::optional<ServoRelease> release = bench_.engine.release();
    ASSERT_TRUE(release);
    ASSERT_FALSE(limp());
    // A message that was cut, as the first bytes of what is written last may be.
    const EngineBench::Bytes cut =
        GetParam().controller == ControllerKind::lewansoul ? EngineBench::Bytes{} : EngineBench::Bytes{0xE2, 0x10};
    if (!cut.empty()) bench_.board->take(cut, bench_.now());
    for (int i = 0; i < 2; ++i)
        for (const EngineBench::Bytes& message : release->messages) bench_.board->take(message, bench_.now());
    EXPECT_TRUE(limp());
    bench_.tell(in::Disarm{});
    bench_.run(5.0);
    EXPECT_EQ(bench_.engine.release(), std::nullopt) << "nothing is under power";
}

INSTANTIATE_TEST_SUITE_P(Boards, ServoHang,
                         testing::Values(HangCase{"tablet", ControllerKind::firmata, 2},
                                         HangCase{"uno", ControllerKind::firmata, 2},
                                         HangCase{"xarm", ControllerKind::lewansoul, 1},
                                         HangCase{"maestro", ControllerKind::maestro, 0}),
                         [](const auto& board) { return std::string(board.param.board); });

} // namespace
} // namespace lumorph
