#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <thread>

#include <QAbstractButton>
#include <QComboBox>
#include <QLineEdit>
#include <gmock/gmock.h>

#include "app/recording/recorder.h"
#include "app/recording/recording.h"
#include "app/studio/recording/servo_proof.h"
#include "core/motion/rig_motion.h"
#include "tests/ui/stall_watch.h"
#include "tests/ui/studio_window.h"

// Recording and replay as their user has them: what counts is that what was seen comes back bit for bit.

namespace lumorph::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using ::testing::HasSubstr;

/// What the loop gave out, in its own thread.
class FrameTap {
public:
    explicit FrameTap(studio::StudioLoop& loop) : loop_(loop) {
        id_ = loop.addTap([this](const MatchFrame& frame) {
            const std::scoped_lock lock(mutex_);
            rows_.push_back(rowOf(frame, Microseconds{0}));
        });
    }
    ~FrameTap() { loop_.removeTap(id_); }
    [[nodiscard]] std::vector<FrameRow> take() {
        const std::scoped_lock lock(mutex_);
        return std::exchange(rows_, {});
    }

private:
    studio::StudioLoop& loop_;
    int id_ = 0;
    std::mutex mutex_;
    std::vector<FrameRow> rows_;
};

/// The row without the time at which it was shown.
FrameRow timeless(FrameRow row) {
    row.time = Microseconds{0};
    return row;
}

const FrameRow* rowNumbered(const std::vector<FrameRow>& rows, std::uint64_t number) {
    const auto found = std::ranges::find(rows, number, &FrameRow::number);
    return found == rows.end() ? nullptr : &*found;
}

class RecordingWindow : public ::testing::Test {
protected:
    RecordingWindow() : window_(std::make_unique<StudioWindow>(folder_ / "session", "devices")) {
        setPlaying(studio(), true);
        studio().settings.setValue("record/folder", QString::fromStdString((folder_ / "").string()));
        fs::remove_all(studio().settings.folder() / "devices");
    }
    ~RecordingWindow() override {
        if (window_) studio().settings.setValue("record/folder", {});
    }

    [[nodiscard]] StudioWindow& window() { return *window_; }
    [[nodiscard]] studio::Studio& studio() { return window_->studio(); }
    [[nodiscard]] bool starts() {
        window().click("bar.record");
        return eventually([&] { return studio().recorder.phase() == studio::RecordingService::Phase::recording; });
    }
    /// Stops it and reads what there is.
    [[nodiscard]] Recording stopped() {
        bool complete = false;
        const auto heard =
            QObject::connect(&studio().recorder, &studio::RecordingService::finished, [&complete] { complete = true; });
        window().click("bar.record");
        EXPECT_TRUE(eventually([&] { return complete; }));
        QObject::disconnect(heard);
        return readRecording(studio().recorder.file());
    }
    /// A short one of the demo as it plays.
    [[nodiscard]] Recording recorded(std::chrono::milliseconds time) {
        EXPECT_TRUE(starts());
        pass(time);
        return stopped();
    }
    [[nodiscard]] bool replays(const fs::path& file) {
        studio().replay.open(file);
        return eventually([&] { return studio().replay.recording() != nullptr; });
    }
    [[nodiscard]] std::string noticeAt(const QString& place) {
        const auto notices = studio().notices.at(place);
        if (notices.empty()) return {};
        const auto& notice = notices.front();
        return (notice.subject + ": " + notice.why + "; " + notice.remedy).toStdString();
    }
    void actOnNotice(const QString& place, const QString& action) {
        const auto notices = studio().notices.at(place);
        ASSERT_FALSE(notices.empty());
        for (const auto& one : notices.front().actions)
            if (one.text == action) return one.run();
        FAIL() << "it does not offer: " << action.toStdString();
    }
    /// A board that a busy machine keeps waiting may be lost once, and is started again by its user alone.
    void goLive() {
        studio().devices.connectTo("sim://tablet");
        ASSERT_TRUE(eventually([&] {
            const LinkStatus& link = studio().devices.status();
            if (link.phase == LinkPhase::disarmed) studio().devices.start(true);
            return link.phase == LinkPhase::live && link.waiting.empty() &&
                   std::ranges::all_of(link.servos, &ServoStatus::attached);
        })) << "phase "
            << static_cast<int>(phase());
    }
    [[nodiscard]] LinkPhase phase() { return studio().devices.status().phase; }

    /// What the servos' machines are told from now on; it outlives the window, however a test ends.
    void trace() {
        studio().devices.setTrace([this](const ServoTraceRow& row) {
            const std::scoped_lock lock(mutex_);
            traced_.push_back(row);
        });
    }
    [[nodiscard]] std::vector<ServoTraceRow> traced() {
        studio().devices.setTrace({});
        const std::scoped_lock lock(mutex_);
        return traced_;
    }

    TemporaryFolder folder_;
    std::mutex mutex_;
    std::vector<ServoTraceRow> traced_;
    std::unique_ptr<StudioWindow> window_;
};

TEST_F(RecordingWindow, ASessionWithServosAndStopComesBackBitForBit) {
    goLive();
    FrameTap tap(studio().loop);
    ASSERT_TRUE(starts());
    pass(2s);
    window().screenshot("recording");
    window().click("stop");
    EXPECT_TRUE(eventually([&] { return phase() == LinkPhase::stopped; }));
    pass(500ms);
    window().click("resume");
    ASSERT_TRUE(eventually([&] { return studio().devices.status().phase == LinkPhase::stopped; }));
    window().hold("start.hold");
    EXPECT_TRUE(eventually([&] { return phase() == LinkPhase::live; }));
    pass(2s);
    const std::vector<FrameRow> given = tap.take();
    const Recording recording = stopped();

    ASSERT_GT(recording.frames.size(), 60U);
    std::size_t same = 0;
    for (const FrameRow& row : given) {
        if (row.number < recording.frames[1].number || row.number > recording.frames.back().number) continue;
        const FrameRow* kept = rowNumbered(recording.frames, row.number);
        ASSERT_NE(kept, nullptr) << "frame " << row.number;
        ASSERT_TRUE(timeless(*kept) == timeless(row)) << "frame " << row.number;
        ++same;
    }
    EXPECT_GT(same, 60U);
    for (std::size_t i = 2; i < recording.frames.size(); ++i)
        ASSERT_EQ(recording.frames[i].number, recording.frames[i - 1].number + 1) << "no frame is left out";
    EXPECT_TRUE(std::ranges::any_of(recording.events, [](const EventRow& row) { return row.text == "STOP"; }));
    EXPECT_THAT(recording.facts.at("profile"), HasSubstr("servos"));

    const studio::ServoProof proof = studio::proveServos(recording.servo);
    EXPECT_EQ(proof.difference.toStdString(), "");
    std::uint64_t sent = 0;
    for (const ServoRow& row : recording.servo)
        if (row.kind == "sent") sent += row.bytes.size();
    EXPECT_GT(sent, 500U);
    EXPECT_EQ(proof.bytes, sent);

    // The same again for the eyes alone.
    const auto commanded = [&] {
        std::vector<double> strokes;
        for (const ServoStatus& servo : studio().devices.status().servos) strokes.push_back(servo.wanted);
        return strokes;
    };
    ASSERT_TRUE(replays(studio().recorder.file()));
    ASSERT_TRUE(eventually([&] { return studio().replay.position() > 0.1; }));
    pass(100ms);
    const std::vector<double> still = commanded();
    EXPECT_TRUE(eventually([&] { return studio().replay.position() > 1.5; }));
    EXPECT_EQ(commanded(), still) << "a replay only shows";
    EXPECT_EQ(phase(), LinkPhase::live);
    EXPECT_FALSE(studio().replay.drivesServos());
    EXPECT_EQ(window().text("replay.what"), "A recording is shown; servos stay still");

    // And for the servos too, once their user has agreed: first slowly to where it stands.
    window().click("replay.playButton");
    studio().replay.seek(0.0);
    window().click("replay.driveButton");
    ASSERT_NE(window().find<QDialog>("dialog.start"), nullptr);
    EXPECT_EQ(window().text("start.title"), "Drive the servos by the recording?");
    window().screenshot("replay-drive");
    QTest::mouseClick(window().find<QWidget>("start.hold"), Qt::LeftButton);
    pass(300ms);
    EXPECT_FALSE(studio().replay.drivesServos()) << "a click is not enough";
    trace();
    const Microseconds agreed = SteadyClock().now();
    window().hold("start.hold");
    ASSERT_TRUE(studio().replay.drivesServos());
    EXPECT_TRUE(eventually([&] { return studio().devices.testing(); }));
    EXPECT_TRUE(eventually([&] { return !studio().devices.testing(); }));
    const std::vector<double>& first = recording.frames.front().estimated;
    EXPECT_TRUE(eventually([&] { return commanded() == first; }));
    const std::vector<ServoTraceRow> way = traced();
    std::vector<double> before;
    for (std::size_t i = 0; i < way.size(); ++i) {
        if (way[i].kind != "command" || way[i].time < agreed) continue; // the link tells of all since it was made
        const std::vector<double> told = tracedStrokes(way[i], i);
        for (std::size_t k = 0; k < before.size(); ++k)
            EXPECT_LE(std::abs(told[k] - before[k]), 0.25 * 0.1 + 1e-9) << "a quarter of a stroke a second";
        before = told;
    }
    {
        const std::scoped_lock lock(mutex_);
        traced_.clear();
    }
    trace();
    (void)tap.take();
    window().click("replay.playButton");
    EXPECT_TRUE(eventually([&] { return studio().replay.position() > 2.0; }));
    window().screenshot("replay");
    const auto& shown = studio().loop.frame();
    const FrameRow* row = rowNumbered(recording.frames, shown->number);
    ASSERT_NE(row, nullptr);
    EXPECT_EQ(shown->estimatedStrokes, row->estimated);
    EXPECT_EQ(shown->worldFromDevice, row->worldFromDevice);
    EXPECT_TRUE(eventually([&] { return !studio().replay.playing(); })) << "it ends";
    const std::vector<FrameRow> again = tap.take();
    ASSERT_GT(again.size(), 100U);
    for (const FrameRow& one : again) {
        const FrameRow* kept = rowNumbered(recording.frames, one.number);
        ASSERT_NE(kept, nullptr);
        ASSERT_TRUE(timeless(one) == timeless(*kept)) << "frame " << one.number;
    }
    EXPECT_TRUE(std::ranges::is_sorted(again, {}, &FrameRow::number));
    const auto& last = recording.frames.back().estimated;
    EXPECT_TRUE(eventually([&] {
        const auto& servos = studio().devices.status().servos;
        for (std::size_t k = 0; k < servos.size(); ++k)
            if (std::abs(servos[k].commanded - last[k]) > 1e-3) return false;
        return !servos.empty();
    })) << "the servos stand where they stood";
    const std::vector<ServoTraceRow> rows = traced();
    std::size_t commands = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].kind != "command") continue;
        const std::vector<double> told = tracedStrokes(rows[i], i);
        commands += std::ranges::any_of(again, [&](const FrameRow& one) { return one.estimated == told; }) ? 1 : 0;
    }
    EXPECT_GT(commands, 60U) << "the link was told the recorded strokes, bit for bit";
}

TEST_F(RecordingWindow, ATrackedHeadIsRecordedAndALiveOneDoesNotDisturbTheReplay) {
    studio().trackers.open("sim://head?rate=60");
    ASSERT_TRUE(eventually([&] { return studio().loop.frame()->viewer == "head"; }));
    const Recording recording = recorded(2s);
    EXPECT_GT(recording.poses.size(), 60U);
    EXPECT_TRUE(std::ranges::all_of(recording.poses, [](const PoseRow& row) {
        return row.source == "sim://head?rate=60" && row.name == "head" && row.measured <= row.time;
    }));
    FrameTap tap(studio().loop);
    ASSERT_TRUE(replays(studio().recorder.file()));
    // A live frame that was under way when the file was open is still shown.
    ASSERT_TRUE(eventually([&] { return rowNumbered(recording.frames, studio().loop.frame()->number) != nullptr; }));
    (void)tap.take();
    EXPECT_TRUE(eventually([&] { return studio().replay.position() > 1.0; }));
    for (const FrameRow& row : tap.take()) {
        const FrameRow* kept = rowNumbered(recording.frames, row.number);
        ASSERT_NE(kept, nullptr) << "a live frame between the recorded ones";
        ASSERT_EQ(row.eye, kept->eye);
        ASSERT_EQ(row.viewer, kept->viewer);
    }
    studio().replay.close();
    EXPECT_TRUE(eventually([&] {
        const FrameRow* kept = rowNumbered(recording.frames, studio().loop.frame()->number);
        return studio().loop.frame()->viewer == "head" && (!kept || kept->eye != studio().loop.frame()->eye);
    })) << "the live head is followed again";
}

TEST_F(RecordingWindow, TheWayBackToTheLiveShowHasNoJump) {
    const Recording recording = recorded(1s);
    ASSERT_TRUE(replays(studio().recorder.file()));
    pass(300ms);
    studio().document.change("By hand", [](studio::StudioState& state) {
        state.matching.driver = Driver::hand;
        state.strokes.assign(state.rig.rig->actuatorCount(), 1.0);
    });
    EXPECT_EQ(studio().driver.driver(), Driver::hand) << "who takes the servos has them";
    EXPECT_EQ(studio().replay.recording(), nullptr);
    pass(200ms);
    ASSERT_EQ(window().text("bar.driver.back").left(7), "Back to");
    window().click("bar.driver.back");
    ASSERT_EQ(studio().driver.driver(), Driver::recording);
    ASSERT_TRUE(eventually([&] { return rowNumbered(recording.frames, studio().loop.frame()->number) != nullptr; }));
    FrameTap tap(studio().loop);
    studio().replay.seek(0.0);
    studio().replay.setPlaying(false);
    const FrameRow& first = recording.frames.front();
    ASSERT_TRUE(eventually([&] { return studio().loop.frame()->number == first.number; }));
    studio().replay.close();
    EXPECT_TRUE(eventually([&] { return studio().loop.frame()->estimatedStrokes.front() > 0.99; }));
    const std::vector<FrameRow> rows = tap.take();
    const std::vector<MotionLimits> limits = motionLimits(*window().state().rig.rig);
    auto at = std::ranges::find_if(rows, [&](const FrameRow& row) { return row.estimated == first.estimated; });
    ASSERT_NE(at, rows.end());
    for (++at; at != rows.end(); ++at) {
        const double seconds = 1e-6 * static_cast<double>((at->time - (at - 1)->time).count());
        for (std::size_t k = 0; k < limits.size(); ++k)
            ASSERT_LE(std::abs(at->estimated[k] - (at - 1)->estimated[k]), limits[k].maxVelocity * seconds + 0.02);
    }
}

TEST_F(RecordingWindow, MarksAreTicksAndTablesAreWritten) {
    ASSERT_TRUE(starts());
    pass(500ms);
    window().command("Mark this moment");
    auto* text = window().find<QLineEdit>("mark.text");
    ASSERT_NE(text, nullptr);
    QTest::keyClicks(text, "she looks up");
    pass(300ms);
    window().screenshot("recording-mark");
    QTest::keyClick(text, Qt::Key_Return);
    const Recording recording = stopped();
    const auto mark = std::ranges::find(recording.events, "mark", &EventRow::kind);
    ASSERT_NE(mark, recording.events.end());
    EXPECT_EQ(mark->text, "she looks up");
    EXPECT_LT(mark->time, recording.frames.back().time - 200ms) << "of when it was asked for";
    actOnNotice("record", "Replay");
    ASSERT_TRUE(eventually([&] { return studio().replay.recording() != nullptr; }));
    EXPECT_TRUE(window().find<QWidget>("replay.bar")->isVisible());
    EXPECT_TRUE(eventually([&] { return window().text("status.loop") == "Replay"; }));
    // Speed, pause and scrubbing.
    auto* speed = window().find<QComboBox>("replay.speed");
    ASSERT_NE(speed, nullptr);
    window().click("replay.playButton");
    EXPECT_FALSE(studio().replay.playing());
    auto* scrub = window().find<QWidget>("replay.scrub");
    QTest::mouseClick(scrub, Qt::LeftButton, {}, QPoint(scrub->width() / 2, scrub->height() / 2));
    EXPECT_NEAR(studio().replay.position(), studio().replay.duration() / 2.0, 0.2 * studio().replay.duration());
    EXPECT_TRUE(eventually(
        [&] { return studio().loop.frame()->number == frameAt(recording, studio().replay.position())->number; }));
    studio().replay.exportTables(folder_ / "tables");
    EXPECT_TRUE(eventually([&] { return noticeAt("replay").find("frames.csv") != std::string::npos; }));
    EXPECT_GT(fs::file_size(folder_ / "tables" / "frames.csv"), 1000U);
    studio().replay.verify();
    EXPECT_TRUE(eventually([&] { return noticeAt("replay").find("Verified") != std::string::npos; }));
    EXPECT_THAT(noticeAt("replay"), HasSubstr("No servos were connected"));
    window().click("replay.live");
    EXPECT_EQ(studio().replay.recording(), nullptr);
    EXPECT_EQ(window().findNow<QWidget>("replay.bar"), nullptr);
}

TEST_F(RecordingWindow, ADiskThatFillsEndsItAndTheShowGoesOn) {
    ASSERT_TRUE(starts());
    pass(700ms);
    studio().recorder.setRoom([](const fs::path&) { return std::int64_t{400'000'000}; });
    EXPECT_TRUE(eventually([&] { return studio().recorder.phase() == studio::RecordingService::Phase::idle; }));
    EXPECT_TRUE(eventually([&] { return noticeAt("record").find("less than 500 MB") != std::string::npos; }));
    EXPECT_THAT(noticeAt("record"), HasSubstr(studio().recorder.file().filename().string()));
    EXPECT_TRUE(eventually([&] { return !fs::exists(studio().recorder.file().string() + "-wal"); }));
    EXPECT_GT(readRecording(studio().recorder.file()).frames.size(), 20U);
    const auto number = studio().loop.frame()->number;
    EXPECT_TRUE(eventually([&] { return studio().loop.frame()->number > number + 10; }));
}

TEST_F(RecordingWindow, WhereItCannotWriteItSaysSoAndRecordsElsewhere) {
    const fs::path file = folder_ / "a file";
    { std::ofstream(file) << "no folder"; }
    studio().recorder.start(file / "below" / "session.lumorphrec");
    EXPECT_TRUE(eventually([&] { return !noticeAt("record").empty(); }));
    EXPECT_THAT(noticeAt("record"), HasSubstr("choose a folder"));
    EXPECT_EQ(studio().recorder.phase(), studio::RecordingService::Phase::idle);
    actOnNotice("record", "Record elsewhere...");
    auto* dialog = window().find<QDialog>("dialog.record");
    ASSERT_NE(dialog, nullptr);
    dialog->close();
}

TEST_F(RecordingWindow, AFileThatIsTakenAwayIsTold) {
    ASSERT_TRUE(starts());
    fs::remove(studio().recorder.file());
    EXPECT_TRUE(eventually([&] { return studio().recorder.phase() == studio::RecordingService::Phase::idle; }));
    EXPECT_TRUE(eventually([&] { return noticeAt("record").find("taken away") != std::string::npos; }));
}

TEST_F(RecordingWindow, ClosingTheStudioCompletesTheFile) {
    ASSERT_TRUE(starts());
    pass(700ms);
    const fs::path file = studio().recorder.file();
    EXPECT_THAT(file.filename().string(), ::testing::MatchesRegex("Session 20..-..-.. ..\\...\\....lumorphrec"));
    window_.reset();
    EXPECT_FALSE(fs::exists(file.string() + "-wal"));
    EXPECT_GT(readRecording(file).frames.size(), 20U);
}

TEST_F(RecordingWindow, TheProjectItWasMadeWithIsOfferedAndComesBack) {
    const Recording recording = recorded(500ms);
    const fs::path file = studio().recorder.file();
    const auto name = window().state().target.target->name;
    ASSERT_TRUE(replays(file));
    EXPECT_EQ(noticeAt("replay"), "") << "of the very same project there is nothing to say";
    studio().project.newProject();
    ASSERT_TRUE(eventually([&] { return !window().state().target.target; }));
    window().drop(file, window().find<QWidget>("topBar"));
    ASSERT_TRUE(eventually([&] { return !noticeAt("replay").empty(); }));
    EXPECT_THAT(noticeAt("replay"), HasSubstr("another project"));
    EXPECT_NE(studio().replay.recording(), nullptr) << "the device is the same, so it is shown";
    actOnNotice("replay", "Open its project");
    EXPECT_TRUE(eventually([&] { return window().state().target.target != nullptr; }));
    EXPECT_EQ(window().state().target.target->name, name);
    EXPECT_NE(studio().replay.recording(), nullptr);
    fs::remove_all(studio().document.file().parent_path());
}

TEST_F(RecordingWindow, AnHourIsOpenedWithoutHoldingTheWindowUp) {
    const fs::path file = folder_ / "hour.lumorphrec";
    {
        Recorder recorder(file, {{"program", "test"}});
        FrameRow row;
        row.wanted = row.estimated = std::vector<double>(6, 0.0);
        row.levels = std::vector<int>(6, 0);
        for (int i = 0; i < 216'000; ++i) {
            row.number = static_cast<std::uint64_t>(i);
            row.time = Microseconds{16'667LL * i};
            row.estimated[0] = (i % 100) / 100.0;
            recorder.add(row);
        }
    }
    StallWatch watch;
    (void)watch.takeLongest();
    const auto asked = std::chrono::steady_clock::now();
    ASSERT_TRUE(replays(file));
    const double took = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - asked).count();
    studio().replay.seek(1800.0);
    studio().replay.setPlaying(false);
    EXPECT_TRUE(eventually([&] { return studio().loop.frame()->number == 107'997; })) << studio().loop.frame()->number;
    studio().replay.close();
    pass(1500ms);
    const double longest = watch.takeLongest();
    std::printf("an hour: read in %.0f ms, the window waited at most %.0f ms\n", took, longest);
    EXPECT_LT(longest, std::max(100.0, took / 3.0)) << "a busy machine makes both longer";
    studio().replay.open(file);
    EXPECT_TRUE(eventually([&] { return !studio().jobs.running().empty(); }));
    studio().jobs.cancel(studio().jobs.running().front().id);
    pass(1s);
    EXPECT_EQ(studio().replay.recording(), nullptr) << "it was cancelled";
}

} // namespace
} // namespace lumorph::test
