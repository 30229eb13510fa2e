#include "devices/controllers/servo_trace.h"

#include <algorithm>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/devices/engine_bench.h"
#include "tests/support/simulated_devices.h"

namespace lumorph {
namespace {

using testing::HasSubstr;
namespace in = servo_input;

/// Soft start, commands, wiggle, slow mode, STOP, other limits, an unplug, a reboot, and the rest at the end.
std::vector<ServoTraceRow> session(const test::SimulatedDevice& where) {
    const DeviceProfile profile = test::profileOf(where);
    EngineBench bench(profile);
    EXPECT_TRUE(bench.connect()) << bench.said;
    const auto follow = [&bench](int frames) {
        for (int i = 0; i < frames; ++i) {
            const double turn = 0.05 * i;
            bench.tell(in::Command{{0.5 + 0.4 * std::sin(turn), 0.5 - 0.3 * std::sin(0.7 * turn)}});
            bench.pass(7'000 + 1'000 * (i % 19));
        }
    };
    bench.tell(in::Arm{true});
    follow(100);
    EXPECT_EQ(bench.engine.status().phase, LinkPhase::live) << bench.said;
    bench.tell(in::Stop{});
    follow(10);
    bench.tell(in::Arm{false});
    follow(250); // the careful start has caught up with it by then
    bench.tell(in::Slow{true});
    bench.run(1.0);
    bench.tell(in::Wiggle{1});
    bench.run(2.0);
    bench.tell(in::Slow{false});
    DeviceProfile narrow = profile;
    narrow.servos[0].pulseMax = 1800.0;
    bench.tell(in::Profile{narrow});
    follow(40);
    DeviceProfile wide = narrow;
    wide.servos[1].pulseMin = 700.0;
    bench.tell(in::Profile{wide});
    EXPECT_TRUE(bench.runUntil([&] {
        const LinkPhase phase = bench.engine.status().phase;
        if (phase == LinkPhase::unidentified) bench.tell(in::Confirm{});
        return phase == LinkPhase::live || phase == LinkPhase::disarmed;
    }));
    bench.tell(in::Arm{true});
    follow(40);
    bench.fault([](BoardFaults& faults) { faults.unplugged = true; });
    bench.run(0.3);
    bench.fault([](BoardFaults& faults) { faults.unplugged = false; });
    EXPECT_TRUE(bench.becomesReady()) << bench.said;
    bench.tell(in::Arm{true});
    follow(60);
    bench.board->reboot();
    bench.run(5.0); // not every controller notices
    bench.tell(in::Arm{true});
    follow(60);
    bench.tell(in::Quit{});
    EXPECT_TRUE(bench.runUntil([&] { return bench.engine.done(); }));
    return std::move(bench.rows);
}

class ServoTrace : public testing::TestWithParam<test::SimulatedDevice> {
protected:
    /// The n-th row of a kind, counted from the front.
    std::size_t find(const std::string& kind, int n) {
        for (std::size_t i = 0; i < rows_.size(); ++i)
            if (rows_[i].kind == kind && n-- == 0) return i;
        ADD_FAILURE() << "there is no such row of kind " << kind;
        return 0;
    }
    std::vector<ServoTraceRow> rows_ = session(GetParam());
};

TEST_P(ServoTrace, ASessionRunAgainSendsTheSameBytes) {
    const TraceCheck check = checkTrace(rows_);
    EXPECT_FALSE(check.difference) << check.difference->row << ": " << check.difference->text;
    EXPECT_GT(check.inputs, 1000U);
    std::uint64_t sent = 0;
    for (const ServoTraceRow& row : rows_) sent += row.kind == "sent" ? row.bytes.size() : 0;
    EXPECT_EQ(check.bytesSent, sent);
    EXPECT_GT(sent, 1000U);
    std::printf("%s: %zu rows, %llu inputs, %llu bytes sent\n", GetParam().name, rows_.size(),
                static_cast<unsigned long long>(check.inputs), static_cast<unsigned long long>(check.bytesSent));
}

TEST_P(ServoTrace, OnlyTheTimesBetweenRowsCount) {
    for (const long shift : {-1'000'000L, -999'983L, 1L, 86'400'000'017L, -7'000'000'000'000L}) {
        std::vector<ServoTraceRow> shifted = rows_;
        for (ServoTraceRow& row : shifted) row.time += Microseconds{shift};
        const TraceCheck check = checkTrace(shifted);
        EXPECT_FALSE(check.difference) << shift << ": " << check.difference->text;
    }
}

TEST_P(ServoTrace, TellsWhichByteWasChanged) {
    for (const int n : {0, 20, 50}) {
        const std::size_t row = find("sent", n);
        std::vector<ServoTraceRow> changed = rows_;
        changed[row].bytes.back() ^= 0x01U;
        const TraceCheck check = checkTrace(changed);
        ASSERT_TRUE(check.difference);
        EXPECT_EQ(check.difference->row, row);
        EXPECT_EQ(check.difference->time, rows_[row].time);
        EXPECT_THAT(check.difference->text, HasSubstr("byte " + std::to_string(rows_[row].bytes.size()) + " is"));
    }
}

TEST_P(ServoTrace, FindsAChangedCommandWhereItsBytesGoOut) {
    const std::size_t row = find("command", 359); // the last before a pause
    std::vector<ServoTraceRow> changed = rows_;
    changed[row].bytes[6] ^= 0x08U; // the second highest byte of a stroke
    const TraceCheck check = checkTrace(changed);
    ASSERT_TRUE(check.difference);
    EXPECT_GT(check.difference->row, row);
    EXPECT_LT(check.difference->time - rows_[row].time, Microseconds{300'000});
}

TEST_P(ServoTrace, FindsWhatWasLeftOutOrPutIn) {
    std::vector<ServoTraceRow> changed = rows_;
    const std::size_t row = find("sent", 30);
    changed.erase(changed.begin() + static_cast<std::ptrdiff_t>(row));
    TraceCheck check = checkTrace(changed);
    ASSERT_TRUE(check.difference);
    EXPECT_EQ(check.difference->row, row) << "where the next input came and nothing had been sent";
    EXPECT_THAT(check.difference->text, HasSubstr("and the trace nothing"));
    changed = rows_;
    changed.insert(changed.begin() + static_cast<std::ptrdiff_t>(row), changed[row]);
    check = checkTrace(changed);
    ASSERT_TRUE(check.difference);
    EXPECT_EQ(check.difference->row, row + 1);
    EXPECT_THAT(check.difference->text, HasSubstr("the machine sends nothing"));
    changed = rows_;
    changed.resize(row); // the program was killed: its last bytes are in no row
    EXPECT_FALSE(checkTrace(changed).difference);
}

TEST_P(ServoTrace, TwoDevicesInTurnAreOneTrace) {
    std::vector<ServoTraceRow> both = rows_;
    both.insert(both.end(), rows_.begin(), rows_.end());
    EXPECT_EQ(checkTrace(both).bytesSent, 2 * checkTrace(rows_).bytesSent);
    EXPECT_FALSE(checkTrace(both).difference);
}

INSTANTIATE_TEST_SUITE_P(Boards, ServoTrace, testing::ValuesIn(test::kSimulatedDevices),
                         [](const auto& board) { return std::string(board.param.name); });

const test::SimulatedDevice kTablet = test::kSimulatedDevices[0];

std::string refusal(const std::vector<ServoTraceRow>& rows) {
    try {
        (void)checkTrace(rows);
    } catch (const DataError& error) {
        EXPECT_FALSE(error.remedy().empty());
        return error.what();
    }
    return "it was taken";
}

TEST(ServoTraceRows, ComeBackAsTheyWere) {
    const DeviceProfile profile = test::profileOf(kTablet);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<ServoInput> inputs = {in::Connect{},
                                            in::Disconnect{},
                                            in::Confirm{},
                                            in::Arm{true},
                                            in::Disarm{},
                                            in::Stop{},
                                            in::Command{{0.1, -0.0, 1e308, 5e-324}},
                                            in::Command{},
                                            in::Wiggle{1U << 20U},
                                            in::Slow{true},
                                            in::Profile{profile},
                                            in::Quit{},
                                            in::Opened{"LOBOT", ""},
                                            in::Received{{0, 255}},
                                            in::Lost{{"why", "what to do"}}};
    for (const ServoInput& input : inputs) {
        const ServoTraceRow row = servo_trace::inputRow(input, Microseconds{-17});
        const auto back = servo_trace::inputsOf(row, 3);
        ASSERT_EQ(back.size(), 1U);
        EXPECT_EQ(back[0].input.index(), input.index()) << row.kind;
        EXPECT_EQ(servo_trace::inputRow(back[0].input, back[0].time), row);
    }
    const std::vector<double> strokes = {nan, std::numeric_limits<double>::infinity(), 0.1};
    const std::vector<double> back = tracedStrokes(servo_trace::inputRow(in::Command{strokes}, {}), 0);
    EXPECT_TRUE(std::isnan(back[0]) && back[1] == strokes[1] && back[2] == 0.1);
    EXPECT_EQ(servo_trace::machineProfile(servo_trace::machineRow(profile, {}), 0), profile);
    const std::vector<servo_trace::TimedTick> ticks = {{Microseconds{5}, 0},
                                                       {Microseconds{5'005}, 300},
                                                       {Microseconds{-70'000'000}, 0},
                                                       {Microseconds{1'000'000'000'000'000}, 1}};
    const auto ticksBack = servo_trace::inputsOf(servo_trace::ticksRow(ticks), 0);
    ASSERT_EQ(ticksBack.size(), ticks.size());
    for (std::size_t i = 0; i < ticks.size(); ++i) {
        EXPECT_EQ(ticksBack[i].time, ticks[i].time);
        EXPECT_EQ(std::get<in::Tick>(ticksBack[i].input).unsent, ticks[i].unsent);
    }
}

TEST(ServoTraceRows, DamagedOnesAreRefusedByTheirNumber) {
    const std::vector<ServoTraceRow> good = {servo_trace::machineRow(test::profileOf(kTablet), {})};
    const auto with = [&good](const char* kind, std::vector<std::uint8_t> bytes) {
        std::vector<ServoTraceRow> rows = good;
        rows.push_back({Microseconds{1}, kind, std::move(bytes)});
        return refusal(rows);
    };
    EXPECT_THAT(refusal({}), HasSubstr("is empty"));
    EXPECT_THAT(refusal({{{}, "connect", {}}}), HasSubstr("does not begin with its machine"));
    EXPECT_THAT(refusal({{{}, "missing", {}}}), HasSubstr("begins too late"));
    EXPECT_THAT(refusal({good[0], {Microseconds::max(), "stop", {}}}), HasSubstr("a time that no clock shows"));
    EXPECT_THAT(with("ticks", {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x7F, 0}),
                HasSubstr("row 1 of the servo trace (ticks): tells a time that no clock shows"));
    EXPECT_THAT(with("arm", {}), HasSubstr("row 1 of the servo trace (arm): is cut short"));
    EXPECT_THAT(with("arm", {2}), HasSubstr("where yes or no belongs"));
    EXPECT_THAT(with("stop", {0, 0}), HasSubstr("2 bytes too many"));
    EXPECT_THAT(with("command", std::vector<std::uint8_t>(12, 0)), HasSubstr("is cut short"));
    EXPECT_THAT(with("command", std::vector<std::uint8_t>(80'000, 0)), HasSubstr("more strokes than"));
    EXPECT_THAT(with("lost", {200, 1}), HasSubstr("in the middle of a text"));
    EXPECT_THAT(with("wiggle", std::vector<std::uint8_t>(11, 0xFF)), HasSubstr("too large"));
    EXPECT_THAT(with("ticks", {}), HasSubstr("is cut short"));
    EXPECT_THAT(with("dance", {}), HasSubstr("not known here"));
    EXPECT_THAT(with("profile", {'{', '}'}), HasSubstr("row 1 of the servo trace (profile): its profile"));
    EXPECT_THAT(with("machine", {0}), HasSubstr("is of version 0"));
}

TEST(ServoTraceRows, RandomOnesDoNoHarm) {
    std::mt19937 random(3);
    const ServoTraceRow machine = servo_trace::machineRow(test::profileOf(kTablet), {});
    int taken = 0;
    for (int i = 0; i < 2'000; ++i) {
        std::vector<ServoTraceRow> rows{machine};
        for (int k = 0; k < 30; ++k) {
            std::vector<std::uint8_t> bytes(random() % 4);
            for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random() % 4);
            const auto kind = servo_trace::kKinds[3 + random() % (servo_trace::kKinds.size() - 3)];
            const std::int64_t time = random() % 20
                                          ? static_cast<std::int64_t>(random())
                                          : static_cast<std::int64_t>((std::uint64_t{random()} << 32U) | random());
            ServoTraceRow row{Microseconds{time}, std::string(kind), bytes};
            try {
                (void)servo_trace::inputsOf(row, 0);
            } catch (const DataError&) {
                continue;
            }
            rows.push_back(row);
        }
        const TraceCheck check = checkTrace(rows); // the machine may send what the rows do not tell of
        taken += check.inputs > 1 ? 1 : 0;
    }
    EXPECT_GT(taken, 1'000);
}

TEST(ServoTraceLog, KeepsIdleHoursInLittleAndHandsTheHistoryOn) {
    ServoTraceLog log;
    const DeviceProfile profile = test::profileOf(kTablet);
    log.made(profile, Microseconds{0});
    log.took(in::Connect{}, Microseconds{1});
    for (long i = 1; i <= 20L * 3600; ++i) log.took(in::Tick{0}, Microseconds{50'000 * i});
    std::vector<ServoTraceRow> rows;
    log.setSink([&rows](const ServoTraceRow& row) { rows.push_back(row); });
    EXPECT_TRUE(rows.empty()) << "only when there is time for it";
    log.hand(10);
    EXPECT_EQ(rows.size(), 10U);
    log.took(in::Stop{}, Microseconds{3'700'000'000});
    log.hand(1'000'000);
    std::size_t bytes = 0, ticks = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        bytes += rows[i].bytes.size();
        if (rows[i].kind == "ticks") ticks += servo_trace::inputsOf(rows[i], i).size();
    }
    EXPECT_EQ(ticks, 72'000U);
    EXPECT_LT(rows.size(), 4'000U);
    EXPECT_LT(bytes, 400'000U);
    EXPECT_EQ(rows.front(), servo_trace::machineRow(profile, Microseconds{0}));
    EXPECT_EQ(rows.back(), servo_trace::inputRow(in::Stop{}, Microseconds{3'700'000'000}));
    log.setSink({});
    log.hand(1);
    log.took(in::Arm{true}, Microseconds{3'800'000'000});
    log.hand(100);
    EXPECT_EQ(rows.back().kind, "stop") << "it was ended";
}

TEST(ServoTraceLog, SaysSoWhereItsBeginningWasNotKept) {
    ServoTraceLog log(10'000);
    log.made(test::profileOf(kTablet), Microseconds{0});
    for (long i = 0; i < 1'000; ++i) log.took(in::Command{{0.5, 0.5}}, Microseconds{1000 * i});
    std::vector<ServoTraceRow> rows;
    log.setSink([&rows](const ServoTraceRow& row) { rows.push_back(row); });
    for (long i = 1'000; i < 4'000; ++i) log.took(in::Command{{0.5, 0.25}}, Microseconds{1000 * i});
    log.hand(1'000'000);
    ASSERT_GT(rows.size(), 3'000U) << "what comes from now on is all there";
    EXPECT_EQ(rows.front().kind, "missing");
    EXPECT_THAT(refusal(rows), HasSubstr("begins too late"));
    EXPECT_EQ(rows.back(), servo_trace::inputRow(in::Command{{0.5, 0.25}}, Microseconds{3'999'000}));
}

} // namespace
} // namespace lumorph
