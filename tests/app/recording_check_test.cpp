#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/recording/recorder.h"
#include "tests/app/process.h"
#include "tests/core/temporary_folder.h"
#include "tests/devices/engine_bench.h"

namespace lumorph::test {

namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A tablet that follows three seconds of frames, as a recorder gets it.
struct RecordedShow {
    std::vector<FrameRow> frames;
    std::vector<ServoRow> servo;

    RecordedShow() {
        DeviceProfile profile;
        profile.address = "sim://tablet";
        profile.staggerSeconds = 0.05;
        profile.servos = {{.channel = 2}, {.channel = 3}};
        EngineBench bench(profile);
        EXPECT_TRUE(bench.connect());
        const Microseconds begin = bench.now();
        bench.tell(servo_input::Arm{true});
        for (int i = 0; i < 180; ++i) {
            FrameRow frame;
            frame.time = bench.now() - begin;
            frame.number = static_cast<std::uint64_t>(i);
            frame.estimated = {0.5 + std::sin(0.03 * i) / 3.0, 0.5 - std::cos(0.02 * i) / 3.0};
            frame.wanted = frame.estimated;
            bench.pass(1'000);
            if (i % 7 != 0) bench.tell(servo_input::Command{frame.estimated}); // one was overtaken now and then
            for (const long pause : {4'000, 5'000, 6'667}) bench.pass(pause);
            frames.push_back(frame);
        }
        for (const ServoTraceRow& row : bench.rows) servo.push_back({row.time - begin, row.kind, row.bytes});
    }
};

struct RecordingCheckTest : ::testing::Test {
    TemporaryFolder own;
    fs::path folder = own.path();
    std::string file = folder / "session.lumorphrec";
    RecordedShow show;

    Outcome check(std::vector<std::string> more = {}) {
        {
            Recorder recorder(file, {{"program", "test"}});
            for (const FrameRow& row : show.frames) recorder.add(row);
            for (const ServoRow& row : show.servo) recorder.add(row);
        }
        more.insert(more.begin(), {"recording", "check", file});
        Outcome outcome = lumorph(more);
        fs::remove(file);
        return outcome;
    }
    std::size_t find(const std::string& kind, int n) {
        for (std::size_t i = 0; i < show.servo.size(); ++i)
            if (show.servo[i].kind == kind && n-- == 0) return i;
        ADD_FAILURE() << "no such row";
        return 0;
    }
};

TEST_F(RecordingCheckTest, ASoundSessionIsEqualBitForBit) {
    const Outcome text = check();
    EXPECT_EQ(text.exitCode, 0) << text.err;
    EXPECT_THAT(text.out, HasSubstr("bytes: equal bit for bit"));
    EXPECT_THAT(text.out, HasSubstr("states: all 154 commands"));
    const nlohmann::json json = check({"--json"}).json();
    EXPECT_TRUE(json["equal"].get<bool>());
    EXPECT_TRUE(json["difference"].is_null());
    EXPECT_EQ(json["commandsOfFrames"], 154);
    EXPECT_GT(json["bytesSent"].get<int>(), 500);
    EXPECT_GT(json["inputs"].get<int>(), 500);
}

TEST_F(RecordingCheckTest, AChangedByteIsNamed) {
    const std::size_t row = find("sent", 40);
    show.servo[row].bytes[1] ^= 1U;
    const Outcome text = check();
    EXPECT_EQ(text.exitCode, 1);
    EXPECT_THAT(text.out, HasSubstr("bytes: different in row " + std::to_string(row)));
    EXPECT_THAT(text.err, HasSubstr("other bytes than those that were sent"));
    EXPECT_EQ(check({"--json"}).json()["difference"]["row"], row);
}

TEST_F(RecordingCheckTest, AStateThatNoFrameHadIsNamed) {
    show.frames[100].estimated[1] = std::nextafter(show.frames[100].estimated[1], 1.0);
    const Outcome text = check();
    EXPECT_EQ(text.exitCode, 1);
    EXPECT_THAT(text.out, HasSubstr("bytes: equal bit for bit"));
    EXPECT_THAT(text.out, HasSubstr("states: 153 of 154 commands"));
    EXPECT_THAT(text.err, HasSubstr("what no frame says"));
}

TEST_F(RecordingCheckTest, DamageIsRefusedByFileAndRow) {
    const std::size_t row = find("command", 10);
    show.servo[row].bytes.pop_back();
    Outcome outcome = check();
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, HasSubstr(file + ": row " + std::to_string(row) + " of the servo trace"));
    show.servo.clear();
    EXPECT_THAT(check().err, HasSubstr("holds no servo traffic"));
}

} // namespace

} // namespace lumorph::test
