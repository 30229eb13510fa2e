#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include <glm/gtc/matrix_transform.hpp>

#include "app/studio/calibration/chain_live.h"
#include "app/studio/document/scene_edit.h"
#include "calibration/capture/capture_camera.h"
#include "calibration/lab/check_lab.h"
#include "calibration/lab/lab_capture.h"
#include "calibration/lab/true_room.h"
#include "calibration/light/light_lab.h"
#include "calibration/servos/servo_calibration.h"
#include "calibration/stages/lab_bench.h"
#include "core/scene/measured_servos.h"
#include "devices/controllers/device_profile.h"
#include "tests/support/chain_judge.h"
#include "tests/support/light_errors.h"
#include "tests/support/long_tests.h"
#include "tests/support/truth.h"
#include "tests/ui/chain_hand.h"
#include "tests/ui/devices_window.h"
#include "tests/ui/file_dialog.h"
#include "tests/ui/table_program.h"

// The whole chain in the window by the mouse, without the lab that lives in the studio: solved from recordings, and at
// a table whose camera sees what the projector's window shows, whose servos are a simulated board's, and whose tracker
// follows hands.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;

constexpr auto kBoard = "chess:9x7:25";
constexpr std::uint32_t kSeed = 31;

/// A room with one projector of few pixels, all of it assumed.
Installation assumedRoom() {
    Installation room = defaultInstallation();
    room.projectors.resize(1);
    InstalledProjector& projector = room.projectors.front();
    projector.camera = withSize(projector.camera, {960, 540});
    projector.lens = projector.pose = {Origin::Way::assumed, "of few pixels", ""}; // not entered by anybody
    return room;
}

/// What is calibrated with, as a new user has it.
struct NothingKept {
    explicit NothingKept(const std::filesystem::path& poses) {
        studio::Settings settings; // before the window reads them
        settings.remove("calibrate");
        std::filesystem::create_directories(poses);
        settings.setValue("calibrate/saved", QString::fromStdString(poses));
    }
};

/// Projector and camera have a sequence of their own.
struct ProjectorHand {
    StudioWindow& window;

    [[nodiscard]] bool offers(const QString& words) {
        return eventually(
            [&] {
                const auto* next = window.findNow<QAbstractButton>("calibrate.card.next");
                return next && next->text().startsWith(words);
            },
            240s);
    }
    void next() {
        pass(std::chrono::milliseconds(QApplication::doubleClickInterval() + 50));
        window.click("calibrate.card.next");
    }
    [[nodiscard]] std::string story() {
        return (window.text("calibrate.card.title") + ": " + window.text("calibrate.card.text")).toStdString();
    }
};

void print(const char* way, const ShownError& shown) {
    std::printf("%s | balls %zu of %zu: mean %.2f pixels | skin mean %.2f pixels, %.2f mm | eye %.1f mm | device %.2f "
                "mm\n",
                way, shown.balls.size(), shown.judgedBalls, meanOf(shown.balls), meanOf(shown.skinPixels),
                meanOf(shown.skinMillimetres), shown.eyeMillimetres, shown.deviceMillimetres);
}

class WholeChainOfRecordings : public ::testing::Test {
protected:
    TemporaryFolder folder;
    NothingKept nothing{folder / "poses"};
    StudioWindow window{folder / "session", "scene"};
};

TEST_F(WholeChainOfRecordings, IsSolvedByTheMouseAsItWasInTheLab) {
    if (!longTests()) GTEST_SKIP() << "minutes of photographs: LUMORPH_LONG_TESTS=1";
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig && window.studio().jobs.running().empty(); }, 60s));
    const std::shared_ptr<const Rig> rig = window.state().rig.rig;
    studio::editInstallation(window.studio().document, "Assumed", [](Installation& room) { room = assumedRoom(); });
    const Installation truth = trueRoom(labTruth(assumedRoom()), rig->actuators(), kSeed);
    LabCapture boards;
    boards.room = truth;
    boards.board = kBoard;
    boards.seed = kSeed;
    LabCapturer capturer(boards);
    writeLabCapture(capturer, folder / "boards");

    ChainHand chain(window);
    chain.open();
    window.click("chain.link.pointer");
    window.click("chain.way.files");
    window.click("chain.link.projector");
    ASSERT_TRUE(chain.offers("Open it")) << chain.story();
    chain.next();
    ProjectorHand projector{window};
    window.click("calibrate.way.folder");
    ASSERT_TRUE(projector.offers("Choose a folder"));
    projector.next();
    answerFileDialog(window, "calibrate.folder.file", folder / "boards", "Choose");
    window.enter("calibrate.projector.width", "960");
    window.enter("calibrate.projector.height", "540");
    ASSERT_TRUE(projector.offers("Read the images")) << projector.story();
    projector.next();
    ASSERT_TRUE(projector.offers("Use this calibration")) << projector.story();
    window.screenshot("whole-recordings-projector", 300ms);
    projector.next();
    ASSERT_TRUE(projector.offers("Go on with the chain")) << projector.story();
    projector.next();
    ASSERT_TRUE(eventually([&] { return chain.badge("projector") == "Simulated"; })) << chain.story();

    // Whoever measures on another machine sends folders.
    LabBenchOptions options;
    options.checkPattern = "phase:16x3+1x3";
    for (const studio::ChainLink& link : studio::chainLinks()) {
        if (link.stage->hasSequence() || link.stage->isWanted) continue;
        const std::filesystem::path kept = folder / "sent" / link.key;
        const StageSite site{rig, chain.room()};
        LabBench bench(*rig, truth, kSeed, options);
        writeStageRecording(measureStage(*link.stage, site, bench).recording, kept);
        window.click(QString("chain.link.") + link.key);
        window.click("chain.file.recording");
        answerFileDialog(window, "chain.recording.file", kept / "recording.json", "Open");
        ASSERT_TRUE(chain.offers("Solve the recording")) << chain.story();
        chain.next();
        const auto solved = [&] { return chain.button() == "Use it" || chain.button() == "Go on"; };
        ASSERT_TRUE(eventually([&] { return solved() || chain.badge(link.key) == "Simulated"; }, 120s))
            << chain.story();
        window.screenshot(QString("whole-recordings-") + link.key, 300ms);
        if (chain.button() == "Use it") chain.next();
        ASSERT_TRUE(eventually([&] { return chain.badge(link.key) == "Simulated"; })) << chain.story();
    }
    EXPECT_TRUE(realParts(chain.room()).empty()) << "what a lab recorded is nowhere measured";
    const ShownError shown = shownError(rig, chain.room(), truth);
    print("by recordings", shown);
    EXPECT_GE(shown.judgedBalls, 20U);
    EXPECT_LE(meanOf(shown.balls), 1.5);
    EXPECT_LE(meanOf(shown.skinPixels), 1.5);
}

/// Before the window reads what was kept.
struct Photographed {
    TemporaryFolder saved;
    NothingKept nothing{saved / "poses"};
};

/// From nothing to a calibrated show, at a table behind sockets: by the mouse, with hands that do what the cards say.
/// Each part begins with the room that the one before left on the disk. LUMORPH_TABLE_SEED: which table (31).
class WholeChainAtTheTable : protected Photographed, public DevicesWindow {
protected:
    void SetUp() override;
    void connectServos(); ///< with the pulses of the device's own wiring
    void connectTracker();
    void measureProjector();
    void measureLight();
    void touch(const char* link, std::vector<studio::LiveStep> (*stepsOf)(const Rig&, const Installation&));
    void measureMoving(const char* link);
    void useAsMeasured(const char* link) {
        ASSERT_TRUE(eventually([&] { return chain.button() == "Use it"; }, 240s)) << link << ": " << chain.story();
        std::printf("%s: %s\n", link, chain.story().c_str());
        window.screenshot(QString("whole-table-") + link, 300ms);
        chain.next();
        const auto ends = [&] {
            if (chain.button() == "Use it as simulated") chain.next();
            return chain.badge(link) == "Simulated"; // the table is one, and says so by its devices' names
        };
        ASSERT_TRUE(eventually(ends, 10s)) << link << ": " << chain.story();
    }
    void keepAs(const char* part) {
        std::ofstream out(left(part));
        out << installationText(chain.room());
        std::fflush(stdout);
    }
    /// Opens the chain in the room that a part left.
    void goOnAfter(const char* part) {
        ASSERT_TRUE(std::filesystem::exists(left(part))) << "the part before did not end";
        const Installation room = InstallationStore::read(left(part));
        studio::editInstallation(window.studio().document, "Before", [&](Installation& into) { into = room; });
        chain.open();
        ASSERT_EQ(chain.badge("projector"), "Simulated");
        window.click("chain.link.pointer");
        window.click("chain.way.live");
        window.studio().outputs.useScreen(0, QGuiApplication::primaryScreen()->name());
        window.studio().notices.at("output").front().actions.front().run(); // the only screen: it asks
        ASSERT_TRUE(eventually([&] { return window.studio().outputs.window(0) != nullptr; }));
    }
    [[nodiscard]] std::filesystem::path left(const char* part) const {
        return std::filesystem::temp_directory_path() / ("lumorph-table-" + seed_.toStdString() + "-" + part + ".json");
    }
    [[nodiscard]] const Rig& rig() { return *window.state().rig.rig; }

    TableProgram table;
    ChainHand chain{window};

private:
    QString seed_ = qEnvironmentVariable("LUMORPH_TABLE_SEED", QString::number(kSeed));
};

void WholeChainAtTheTable::SetUp() {
    if (!longTests()) GTEST_SKIP() << "minutes of photographs, hands and servos: LUMORPH_LONG_TESTS=1";
    ASSERT_NO_FATAL_FAILURE(table.start({"--seed", seed_, "--camera-size", "960x768"}));
    setByHand(0, 0.0); // the show stands still
}

void WholeChainAtTheTable::connectServos() {
    window.window().showWorkspace("devices");
    window.studio().devices.setProfile(profileFor(rig(), firstChannel(ControllerKind::firmata)), {});
    window.studio().devices.connectTo(table.ready["servos"].toString());
    ASSERT_TRUE(offersStart()) << story();
    startServos();
}

void WholeChainAtTheTable::connectTracker() {
    window.studio().trackers.open(table.ready["tracker"].toString());
    table.does("touch dimple 1"); // the pointer is in sight
    pass(1s);
}

void WholeChainAtTheTable::measureProjector() {
    window.click("chain.link.projector");
    ASSERT_TRUE(chain.offers("Open it")) << chain.story();
    chain.next();
    ProjectorHand hand{window};
    ASSERT_NO_FATAL_FAILURE(chooseScreenAndCamera(window));
    const auto button = [&] {
        const auto* next = window.findNow<QAbstractButton>("calibrate.card.next");
        return next ? next->text() : QString();
    };
    int place = 0;
    for (int pose = 1; button() != "Use this calibration" && place < 16;) {
        const QString wanted = QString("Photograph pose %1").arg(pose);
        ASSERT_TRUE(
            eventually([&] { return button().startsWith(wanted) || button().startsWith("Photograph this"); }, 60s))
            << hand.story();
        table.does(QString("board %1").arg(++place));
        pass(1s);
        hand.next();
        const QString then = QString("Photograph pose %1").arg(pose + 1);
        const auto ends = [&] {
            return button().startsWith(then) || button().startsWith("Photograph this") ||
                   button() == "Use this calibration";
        };
        ASSERT_TRUE(eventually(ends, 240s)) << hand.story();
        std::printf("board %d: %s\n", place, hand.story().c_str());
        if (button().startsWith(then)) ++pose; // another place for one that was refused
    }
    ASSERT_TRUE(hand.offers("Use this calibration")) << hand.story();
    window.screenshot("whole-table-projector", 300ms);
    table.does("board off");
    hand.next();
    ASSERT_TRUE(hand.offers("Go on with the chain")) << hand.story();
    hand.next();
    ASSERT_TRUE(eventually([&] { return chain.badge("projector") == "Simulated"; })) << chain.story();
}

void WholeChainAtTheTable::measureLight() {
    window.click("chain.link.light");
    ASSERT_TRUE(chain.offers("Begin, with the camera")) << chain.story();
    chain.next();
    QString done;
    ASSERT_TRUE(eventually(
        [&] {
            const QString words = window.text("chain.card.text");
            if (words != done && words.startsWith("Cover the lens")) table.does("cover on");
            if (words != done && words.startsWith("Uncover the lens")) table.does("cover off");
            done = words;
            return chain.button() == "Use it" || chain.button() == "Measure again";
        },
        300s))
        << chain.story();
    useAsMeasured("light");
}

/// What a hand does for a step.
QString lineFor(const char* link, const studio::LiveStep& step, std::size_t number) {
    if (step.ends == studio::LiveStep::Ends::swung)
        return "swing dimple 9"; // not one of those that it rests in afterwards
    if (step.corner) return QString("touch corner %1").arg(number + 1);
    if (step.dot) return std::string_view(link) == "eye" ? "aim" : "touch dot";
    return "touch " + QString::fromStdString(step.name); // "dimple 2"
}

void WholeChainAtTheTable::touch(const char* link,
                                 std::vector<studio::LiveStep> (*stepsOf)(const Rig&, const Installation&)) {
    const std::vector<studio::LiveStep> steps = stepsOf(rig(), chain.room());
    window.click(QString("chain.link.") + link);
    ASSERT_TRUE(chain.offers("Begin, with the tracker")) << chain.story();
    chain.next();
    ASSERT_TRUE(chain.offers("Cancel")) << chain.story();
    const auto title = [&] { return window.text("chain.card.title"); };
    for (std::size_t k = 0; k < steps.size(); ++k) {
        ASSERT_TRUE(eventually([&] { return title() == steps[k].title; }, 10s))
            << "step " << k << ": " << chain.story() << ", not " << steps[k].title.toStdString();
        pass(300ms); // the dot is on the table
        table.does(lineFor(link, steps[k], k));
        ASSERT_TRUE(eventually([&] { return title() != steps[k].title; }, 40s)) << chain.story();
    }
    useAsMeasured(link);
}

void WholeChainAtTheTable::measureMoving(const char* link) {
    window.click(QString("chain.link.") + link);
    ASSERT_TRUE(chain.offers("Begin, hands off")) << chain.story();
    chain.next();
    ASSERT_TRUE(eventually([&] { return chain.button() != "Cancel"; }, 1200s)) << chain.story();
}

/// Beside the truth, in the camera's frame: what the world is, the first board says.
void judgeProjector(const Installation& room, const Installation& truth) {
    const auto seen = [](const Installation& of) {
        return of.cameras.front().camera.cameraFromWorld *
               glm::inverse(of.projectors.front().camera.cameraFromWorld); // camera from projector
    };
    const glm::dmat4 found = seen(room), real = seen(truth);
    const glm::dmat3 turn = glm::dmat3(found) * glm::transpose(glm::dmat3(real));
    const double millimetres = 1e3 * glm::distance(glm::dvec3(found[3]), glm::dvec3(real[3]));
    const double degrees =
        glm::degrees(std::acos(std::clamp(0.5 * (turn[0][0] + turn[1][1] + turn[2][2] - 1.0), -1.0, 1.0)));
    std::printf("projector | place %.2f mm, direction %.3f degrees, focal length %.3f %%\n", millimetres, degrees,
                100.0 * (room.projectors.front().camera.focal.x / truth.projectors.front().camera.focal.x - 1.0));
    EXPECT_LE(millimetres, 1.0);
    EXPECT_LE(degrees, 0.05);
}

/// Degrees between a measured curve and the true one, both ways.
double worstCurve(const Installation& room, const Installation& truth) {
    double worst = 0.0;
    for (std::size_t i = 0; i < room.servos.size() && i < truth.servos.size(); ++i)
        for (int k = 0; k <= 96; ++k)
            for (const double from : {0.0, 1.0})
                worst = std::max(worst, std::abs(realStroke(room.servos[i], k / 96.0, from) -
                                                 realStroke(truth.servos[i], k / 96.0, from)));
    return room.servos.size() == truth.servos.size() ? kDegreesOfUnturned * worst : kDegreesOfUnturned;
}

TEST_F(WholeChainAtTheTable, Part1ProjectorAndLight) {
    chain.open();
    window.click("chain.link.pointer");
    window.click("chain.way.live");
    ASSERT_NO_FATAL_FAILURE(measureProjector());
    judgeProjector(chain.room(), table.truth);
    keepAs("projector");
    ASSERT_NO_FATAL_FAILURE(measureLight());
    const LightErrors errors = lightErrorsOf(chain.room(), table.truth);
    std::printf("light | curve %.2f %% of white, gains %.2f %%, black %.3f %%, gains x colours %.2f %%\n",
                100.0 * errors.curve, 100.0 * errors.gain, 100.0 * errors.black, 100.0 * errors.product);
    EXPECT_LE(errors.curve, 0.005);
    keepAs("light");
}

TEST_F(WholeChainAtTheTable, Part2Touches) {
    ASSERT_NO_FATAL_FAILURE(goOnAfter("light"));
    connectTracker();
    ASSERT_NO_FATAL_FAILURE(touch("pointer", studio::pointerSteps));
    ASSERT_NO_FATAL_FAILURE(touch("tracker", studio::trackerSteps));
    ASSERT_NO_FATAL_FAILURE(touch("device", studio::deviceSteps));
    ASSERT_NO_FATAL_FAILURE(touch("eye", studio::eyeSteps));
    window.click("chain.link.delays");
    ASSERT_TRUE(chain.offers("Begin, with the camera")) << chain.story();
    chain.next();
    useAsMeasured("delays");
    std::printf("delays | light %.1f ms, truth %.1f and what screen and show take\n",
                1e3 * chain.room().predictionSeconds, 1e3 * table.truth.predictionSeconds);
    keepAs("touches");
}

TEST_F(WholeChainAtTheTable, Part3Servos) {
    ASSERT_NO_FATAL_FAILURE(connectServos());
    ASSERT_NO_FATAL_FAILURE(goOnAfter("touches"));
    connectTracker();
    ASSERT_NO_FATAL_FAILURE(measureMoving("servos"));
    useAsMeasured("servos");
    const double worst = worstCurve(chain.room(), table.truth);
    std::printf("servos | curves worst %.2f degrees\n", worst);
    EXPECT_LE(worst, 1.0);
    keepAs("servos");
}

TEST_F(WholeChainAtTheTable, Part4CheckAndShow) {
    ASSERT_NO_FATAL_FAILURE(connectServos());
    ASSERT_NO_FATAL_FAILURE(goOnAfter("servos"));
    connectTracker();
    const ShownError shown = shownError(window.state().rig.rig, chain.room(), table.truth);
    print("at the table", shown);
    EXPECT_LE(meanOf(shown.balls), 1.5);
    EXPECT_LE(meanOf(shown.skinPixels), 1.5);
    const QJsonObject latency = table.tell("latency 15");
    EXPECT_TRUE(latency["ok"].toBool());
    std::printf("motion to photon | %s\n", QJsonDocument(latency).toJson(QJsonDocument::Compact).constData());
    ASSERT_NO_FATAL_FAILURE(measureMoving("check"));
    std::printf("check: %s\n", chain.story().c_str());
    EXPECT_EQ(chain.story().find("could not be measured"), std::string::npos) << chain.story();
    window.screenshot("whole-table-check", 300ms);
    EXPECT_EQ(table.filesInCommon(), "");
}

} // namespace
} // namespace lumorph::test
