#include "app/recording/recording.h"

#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "app/recording/recorder.h"
#include "core/base/error.h"
#include "tests/app/process.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

FrameRow someFrame(std::mt19937& random, int number) {
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    FrameRow row;
    row.time = Microseconds{16'667 * number};
    row.number = static_cast<std::uint64_t>(number);
    row.seconds = any(random);
    row.turned = any(random);
    row.sceneSeconds = any(random);
    for (int i = 0; i < 6; ++i) {
        row.levels.push_back(number + i);
        row.wanted.push_back(any(random));
        row.estimated.push_back(any(random) / 3.0);
    }
    for (int i = 0; i < 4; ++i) row.worldFromDevice[3][i] = static_cast<float>(any(random));
    if (number % 3 != 0) row.eye = glm::vec3(any(random), any(random), any(random));
    row.viewer = number % 2 == 0 ? "Ada, \"the\" first" : "";
    row.handingOver = number % 5 == 0;
    row.iou = any(random);
    return row;
}

PoseRow somePose(std::mt19937& random, int number) {
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    return {Microseconds{4'000 * number},
            Microseconds{4'000 * number - 900},
            "natnet://lab",
            "head",
            7,
            number % 4 != 0,
            {{any(random), any(random), any(random)}, glm::dquat(any(random), any(random), any(random), any(random))}};
}

struct RecordingTest : ::testing::Test {
    TemporaryFolder own;
    fs::path folder = own.path();
    fs::path file = folder / "session.lumorphrec";

    std::string textOf(const char* name) const {
        std::ifstream in(folder / "csv" / name);
        return {std::istreambuf_iterator<char>(in), {}};
    }
};

TEST_F(RecordingTest, EveryRowComesBackBitForBit) {
    std::mt19937 random(1);
    Recording wanted;
    wanted.facts = {{"program", "test"}, {"project", "{}"}};
    for (int i = 0; i < 500; ++i) wanted.frames.push_back(someFrame(random, i));
    for (int i = 0; i < 700; ++i) wanted.poses.push_back(somePose(random, i));
    wanted.events = {{Microseconds{5}, "warning", "The board restarted", "arm it again"}};
    wanted.servo = {{Microseconds{6}, "sent", {0xE9, 0x5C, 0x0B}}, {Microseconds{7}, "turn", {}}};
    {
        Recorder recorder(file, wanted.facts);
        for (const FrameRow& row : wanted.frames) recorder.add(row);
        for (const PoseRow& row : wanted.poses) recorder.add(row);
        for (const EventRow& row : wanted.events) recorder.add(row);
        for (const ServoRow& row : wanted.servo) recorder.add(row);
        EXPECT_EQ(recorder.rows(), 1203U);
        EXPECT_EQ(recorder.trouble(), "");
    }
    const Recording found = readRecording(file);
    EXPECT_EQ(found.facts, wanted.facts);
    EXPECT_TRUE(found.frames == wanted.frames);
    EXPECT_TRUE(found.poses == wanted.poses);
    EXPECT_TRUE(found.events == wanted.events);
    EXPECT_TRUE(found.servo == wanted.servo);
}

TEST_F(RecordingTest, AFrameIsShownAgainAsItWas) {
    const auto rig = std::make_shared<const Rig>(test::cushionRig());
    MatchWish like;
    like.rig = rig;
    FrameRow row;
    row.wanted = {1.0, 0.25, 0.5};
    row.estimated = {0.5, 0.125, 1.0};
    row.eye = glm::vec3(0.1F, 0.5F, 0.4F);
    row.levels = {32, 8, 16};
    const MatchFrame frame = frameOf(row, like);
    std::vector<glm::vec3> expected(rig->restMesh().positions.size());
    rig->deform(row.estimated, expected);
    EXPECT_EQ(*frame.devicePositions, expected);
    EXPECT_EQ(frame.eye, row.eye);
    EXPECT_EQ(rowOf(frame, Microseconds{0}).estimated, row.estimated);
    row.estimated.push_back(0.0);
    EXPECT_THROW((void)frameOf(row, like), InvalidInput) << "of another rig";
}

TEST_F(RecordingTest, TheFrameShownIsTheNewestNotAfter) {
    std::mt19937 random(2);
    Recording recording;
    EXPECT_EQ(frameAt(recording, 0.0), nullptr);
    for (int i = 0; i < 10; ++i) recording.frames.push_back(someFrame(random, i));
    EXPECT_EQ(frameAt(recording, -1.0)->number, 0U);
    EXPECT_EQ(frameAt(recording, 0.0334)->number, 2U);
    EXPECT_EQ(frameAt(recording, 0.0333)->number, 1U);
    EXPECT_EQ(frameAt(recording, 99.0)->number, 9U);
}

TEST_F(RecordingTest, WhatACrashLeavesCanBeRead) {
    std::mt19937 random(3);
    Recorder recorder(file, {});
    for (int i = 0; i < 50; ++i) recorder.add(someFrame(random, i));
    // The copy is what is on the disk while the program still runs.
    std::size_t found = 0;
    for (int tries = 0; tries < 100 && found < 50; ++tries) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        for (const char* suffix : {"", "-wal"})
            fs::copy_file(file.string() + suffix, (folder / "copy").string() + suffix,
                          fs::copy_options::overwrite_existing);
        found = readRecording(folder / "copy").frames.size();
    }
    EXPECT_EQ(found, 50U);
}

/// Names, sizes and bytes of a folder's files.
std::map<std::string, std::string> filesIn(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        std::ifstream in(entry.path(), std::ios::binary);
        files[entry.path().filename()] = {std::istreambuf_iterator<char>(in), {}};
    }
    return files;
}

struct UnclosedRecording : RecordingTest {
    /// Copies a recording of 50 frames as its recorder leaves it that is killed now; with its log or without.
    void copyUnclosed(const fs::path& to, bool withLog) {
        std::mt19937 random(3);
        Recorder recorder(file, {{"started", "2026-10-25T14:00:00+01:00"}});
        for (int i = 0; i < 50; ++i) recorder.add(someFrame(random, i));
        for (int tries = 0; tries < 100; ++tries) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            if (readRecording(file).frames.size() == 50U) break;
        }
        live = readRecording(file);
        fs::create_directories(to.parent_path());
        fs::copy_file(file, to);
        if (withLog) fs::copy_file(file.string() + "-wal", to.string() + "-wal");
    }
    Recording live;
};

TEST_F(UnclosedRecording, IsReadWholeAndNothingIsWritten) {
    const fs::path copy = folder / "moved #1? 100%" / "session.lumorphrec";
    copyUnclosed(copy, true);
    EXPECT_EQ(live.frames.size(), 50U);
    EXPECT_FALSE(live.closed);
    ASSERT_EQ(live.warnings.size(), 1U);
    EXPECT_THAT(live.warnings.front(), HasSubstr("still being recorded"));
    EXPECT_TRUE(readRecording(file).closed) << "the recorder has ended by now";
    EXPECT_TRUE(readRecording(file).warnings.empty());

    const auto before = filesIn(copy.parent_path());
    ASSERT_EQ(before.size(), 2U);
    const Recording found = readRecording(copy);
    EXPECT_TRUE(found.frames == live.frames);
    EXPECT_FALSE(found.closed);
    ASSERT_EQ(found.warnings.size(), 1U);
    EXPECT_THAT(found.warnings.front(), HasSubstr("was not closed"));
    EXPECT_TRUE(readFiles(copy).empty());
    EXPECT_TRUE(filesIn(copy.parent_path()) == before) << "nothing was changed, and nothing came beside it";

    const test::Outcome info = test::lumorph({"recording", "info", copy});
    EXPECT_EQ(info.exitCode, 0);
    EXPECT_THAT(info.err, HasSubstr("was not closed"));
    EXPECT_THAT(info.out, HasSubstr("begun 2026-10-25T14:00:00+01:00"));
    EXPECT_EQ(test::lumorph({"recording", "info", copy, "--json"}).json()["closed"], false);
    EXPECT_TRUE(filesIn(copy.parent_path()) == before);
}

TEST_F(UnclosedRecording, WithoutItsLogIsReadAsFarAsItGoes) {
    const fs::path alone = folder / "alone" / "session.lumorphrec";
    copyUnclosed(alone, false);
    const auto before = filesIn(alone.parent_path());
    try {
        (void)readRecording(alone);
        ADD_FAILURE() << "was read";
    } catch (const DataError& error) { // not one row had left the log
        EXPECT_THAT(error.why(), HasSubstr("its log 'session.lumorphrec-wal'"));
        EXPECT_THAT(error.why(), HasSubstr("is not beside it"));
    }
    EXPECT_TRUE(filesIn(alone.parent_path()) == before);

    // Another session, whose rows were taken over from the log before it was lost.
    const fs::path some = folder / "some.lumorphrec";
    fs::copy_file(file, some);
    sqlite3* opened = nullptr;
    sqlite3_open(some.c_str(), &opened);
    sqlite3_exec(opened, "PRAGMA journal_mode = WAL", nullptr, nullptr, nullptr);
    sqlite3_close(opened);
    ASSERT_FALSE(fs::exists(some.string() + "-wal"));
    const fs::path moved = folder / "moved" / "some.lumorphrec";
    fs::create_directories(moved.parent_path());
    fs::copy_file(some, moved);
    for (const bool emptyLog : {false, true}) {
        if (emptyLog) std::ofstream(moved.string() + "-wal").flush();
        const auto there = filesIn(moved.parent_path());
        const Recording found = readRecording(moved);
        EXPECT_TRUE(found.frames == live.frames);
        EXPECT_FALSE(found.closed);
        ASSERT_EQ(found.warnings.size(), 1U);
        EXPECT_THAT(found.warnings.front(), HasSubstr("'some.lumorphrec-wal' is not beside it"));
        EXPECT_TRUE(filesIn(moved.parent_path()) == there);
    }
}

TEST_F(RecordingTest, CsvHasAHeaderAndOneLineARow) {
    Recording recording;
    FrameRow row;
    row.time = Microseconds{1'500'000};
    row.number = 3;
    row.levels = {1, 2};
    row.wanted = {0.1, 1.0 / 3.0};
    row.estimated = {0.0, 0.5};
    row.viewer = "a,\"b\"";
    recording.frames = {row};
    recording.servo = {{Microseconds{10}, "sent", {0x0A, 0xF7}}};
    exportCsv(recording, folder / "csv");
    const std::string frames = textOf("frames.csv");
    EXPECT_THAT(frames, StartsWith("time_s,number,animation_s,turned_rad,scene_s,level_0,level_1,wanted_0,wanted_1,"
                                   "estimated_0,estimated_1,device_x_m"));
    EXPECT_THAT(frames, HasSubstr("\n1.5,3,0,0,0,1,2,0.1,0.3333333333333333,0,0.5,0,0,0,,,,\"a,\"\"b\"\"\",0,0,0\n"));
    EXPECT_EQ(textOf("servo.csv"), "time_s,kind,bytes\n1e-05,sent,0AF7\n");
}

TEST_F(RecordingTest, WhatIsNoRecordingIsRefused) {
    const auto refusal = [&]() -> std::string {
        try {
            (void)readRecording(file);
        } catch (const DataError& error) {
            return error.what();
        }
        return "read";
    };
    EXPECT_THAT(refusal(), HasSubstr("no such file"));
    std::ofstream(file) << "no database at all, but long enough to look at, twice over and over again";
    EXPECT_THAT(refusal(), HasSubstr("session.lumorphrec"));
    fs::remove(file);
    const auto database = [&](const char* sql) {
        sqlite3* opened = nullptr;
        sqlite3_open(file.c_str(), &opened);
        sqlite3_exec(opened, sql, nullptr, nullptr, nullptr);
        sqlite3_close(opened);
    };
    database("CREATE TABLE other (a)");
    EXPECT_THAT(refusal(), HasSubstr("no recording"));
    fs::remove(file);
    { const Recorder recorder(file, {}); }
    database("INSERT INTO frame (time_us, wanted, estimated) VALUES (0, x'0011', x'')");
    EXPECT_THAT(refusal(), HasSubstr("row 1 of its table 'frame' is damaged"));
    database("PRAGMA user_version = 99");
    EXPECT_THAT(refusal(), HasSubstr("newer"));
}

TEST_F(RecordingTest, TheCommandTellsWhatHappenedAndWritesTables) {
    {
        std::mt19937 random(4);
        Recorder recorder(file, {{"program", "test"}});
        for (int i = 0; i < 3; ++i) recorder.add(someFrame(random, i));
        recorder.add(EventRow{Microseconds{2'500'000}, "failure", "The cable came off", "plug it in"});
    }
    const test::Outcome text = test::lumorph({"recording", "info", file});
    EXPECT_EQ(text.exitCode, 0) << text.err;
    EXPECT_THAT(text.out, HasSubstr("3 frames"));
    EXPECT_THAT(text.out, HasSubstr("2.50 s  The cable came off; plug it in"));
    const nlohmann::json json = test::lumorph({"recording", "info", file, "--json"}).json();
    EXPECT_EQ(json["seconds"], 2.5);
    EXPECT_EQ(json["facts"]["program"], "test");
    EXPECT_EQ(test::lumorph({"recording", "export", file, "-o", folder / "csv"}).exitCode, 0);
    EXPECT_EQ(textOf("events.csv"), "time_s,kind,text,remedy\n2.5,failure,The cable came off,plug it in\n");
    const test::Outcome none = test::lumorph({"recording", "info", folder / "none"});
    EXPECT_EQ(none.exitCode, 1);
    EXPECT_THAT(none.err, HasSubstr("there is no such file"));
}

TEST_F(RecordingTest, FilesOfTheProjectComeBackAndHostileNamesAreRefused) {
    {
        Recorder recorder(file, {});
        recorder.add(FileRow{"session files/stone.glb", {0x00, 0xFF, 0x0A}});
        recorder.add(FileRow{"session files/empty.png", {}});
    }
    const std::vector<FileRow> wanted = {{"session files/empty.png", {}},
                                         {"session files/stone.glb", {0x00, 0xFF, 0x0A}}};
    EXPECT_TRUE(readFiles(file) == wanted);
    for (const char* name : {"../up.glb", "/etc/passwd", "a/../../b", "resource:models/tablet.glb"}) {
        fs::remove(file);
        {
            Recorder recorder(file, {});
            recorder.add(FileRow{name, {1}});
        }
        EXPECT_THROW((void)readFiles(file), DataError) << name;
    }
}

TEST_F(RecordingTest, RowsOfSeveralThreadsAreSortedAndServoRowsStayAsTheyCame) {
    {
        Recorder recorder(file, {});
        for (const int time : {5, 3, 9, 3}) {
            recorder.add(EventRow{Microseconds{time}, "mark", std::to_string(time), {}});
            recorder.add(ServoRow{Microseconds{time}, "sent", {static_cast<std::uint8_t>(time)}});
        }
    }
    const Recording recording = readRecording(file);
    const auto times = [](const auto& rows) {
        std::vector<std::int64_t> all;
        for (const auto& row : rows) all.push_back(row.time.count());
        return all;
    };
    EXPECT_EQ(times(recording.events), (std::vector<std::int64_t>{3, 3, 5, 9}));
    EXPECT_EQ(times(recording.servo), (std::vector<std::int64_t>{5, 3, 9, 3}));
}

TEST_F(RecordingTest, ReadingAndTablesTellHowFarTheyAreAndCanBeCancelled) {
    {
        std::mt19937 random(5);
        Recorder recorder(file, {});
        for (int i = 0; i < 5000; ++i) recorder.add(someFrame(random, i));
    }
    std::vector<double> told;
    const Progress listening([&](double fraction, std::string_view) { told.push_back(fraction); });
    const Recording recording = readRecording(file, listening);
    EXPECT_EQ(recording.frames.size(), 5000U);
    ASSERT_GE(told.size(), 4U);
    EXPECT_TRUE(std::ranges::is_sorted(told));
    EXPECT_LE(told.back(), 1.0);
    std::stop_source stop;
    const Progress stopping([&](double, std::string_view) { stop.request_stop(); }, stop.get_token());
    EXPECT_THROW((void)readRecording(file, stopping), Cancelled);
    stop = std::stop_source();
    const Progress stoppingTables([&](double, std::string_view) { stop.request_stop(); }, stop.get_token());
    EXPECT_THROW(exportCsv(recording, folder / "csv", stoppingTables), Cancelled);
    EXPECT_FALSE(fs::exists(folder / "csv" / "frames.csv")) << "whole or not at all";
}

TEST_F(RecordingTest, AFinishedFileIsWholeAndTakesNoMore) {
    std::mt19937 random(6);
    Recorder recorder(file, {});
    recorder.add(someFrame(random, 1));
    recorder.finish();
    EXPECT_FALSE(fs::exists(file.string() + "-wal"));
    recorder.add(someFrame(random, 2));
    recorder.finish();
    EXPECT_EQ(readRecording(file).frames.size(), 1U);
    // It is read without companions, so also from where nothing may be written: bytes 18 and 19 of SQLite's header
    // are 1 for a file without a write-ahead log.
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
    std::ifstream in(file, std::ios::binary);
    char header[20] = {};
    in.read(header, sizeof header);
    EXPECT_EQ(header[18], 1);
    EXPECT_EQ(header[19], 1);
}

TEST_F(RecordingTest, AnotherFileIsNotOverwritten) {
    std::ofstream(file) << "mine";
    EXPECT_THROW(const Recorder recorder(file, {}), DeviceError);
    EXPECT_EQ(fs::file_size(file), 4U);
}

} // namespace
} // namespace lumorph
