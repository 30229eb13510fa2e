#include <cstdio>
#include <fstream>

#include <QAbstractButton>
#include <QAction>
#include <QLabel>
#include <QRegularExpression>
#include <glm/gtc/quaternion.hpp>

#include "app/studio/calibration/chain.h"
#include "app/studio/calibration/chain_files.h"
#include "app/studio/document/scene_edit.h"
#include "app/workspaces/calibrate/error_map_view.h"
#include "calibration/lab/lab_lens.h"
#include "calibration/lab/moved_room.h"
#include "calibration/lab/registration_lab.h"
#include "calibration/lab/true_room.h"
#include "calibration/stages/lab_bench.h"
#include "calibration/verify/verify_lab.h"
#include "tests/support/chain_judge.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/long_tests.h"
#include "tests/support/truth.h"
#include "tests/ui/chain_hand.h"
#include "tests/ui/file_dialog.h"
#include "tests/ui/studio_window.h"

// From boxes to a calibrated show in the window, by the mouse: each link is measured in the lab, shown, and used.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;

void writePoses(std::ostream& out, const PoseTrack& track, double later) {
    for (const TimedPose& at : track.poses) {
        const auto& [p, q] = std::tie(at.pose.position, at.pose.rotation);
        out << at.seconds + later << ',' << p.x << ',' << p.y << ',' << p.z << ',' << q.x << ',' << q.y << ',' << q.z
            << ',' << q.w << '\n';
    }
}

/// Swings, and rests in other dimples with ways between them, as a tracker records them.
void writePointer(const PointerCapture& capture, const std::filesystem::path& swings,
                  const std::filesystem::path& rests) {
    std::ofstream first(swings), second(rests);
    first.precision(12);
    second.precision(12);
    writePoses(first, capture.swings, 0.0);
    double now = 0.0;
    for (const std::vector<Touch>& dimple : capture.fresh)
        for (const Touch& touch : dimple) {
            const std::vector<TimedPose>& poses = touch.pointer.poses;
            writePoses(second, touch.pointer, now - poses.front().seconds);
            now += poses.back().seconds - poses.front().seconds;
            PoseTrack away; // lifted
            for (int k = 1; k <= 20; ++k) {
                TimedPose at = poses.back();
                at.seconds = k / 60.0;
                at.pose.position += glm::dvec3(0.0, 0.01 * k, 0.0);
                away.poses.push_back(at);
            }
            writePoses(second, away, now);
            now += 0.4;
        }
}

class Chain : public ::testing::Test, protected ChainHand {
protected:
    Chain() : ChainHand(window) { open(); }

    /// Servos whose lag is shown as a figure.
    [[nodiscard]] QStringList lagFigures() {
        QStringList names;
        for (const QLabel* label :
             window.window().findChildren<QLabel*>(QRegularExpression("^chain\\.figure\\..*: lag$")))
            names << label->accessibleName().chopped(5);
        return names;
    }
    /// Projector and camera by their own sequence, from the chain and back.
    void measureProjector();
    /// The rest, one after the other; STOP while the servos are measured.
    void measureUntilStop();

    studio::ErrorPlan map; ///< that it shows
    TemporaryFolder folder;
    struct AsNew { // what is calibrated with
        explicit AsNew(const std::filesystem::path& poses) {
            studio::Settings settings; // before the window reads them
            for (const char* key : {"calibrate/way", "calibrate/lab/board", "calibrate/lab/poses"})
                settings.remove(key);
            std::filesystem::create_directories(poses);
            settings.setValue("calibrate/saved", QString::fromStdString(poses));
        }
    } asNew{folder / "poses"};
    StudioWindow window{folder / "session", "scene"};
};

/// Of the map's places where the device stands, which is where the window promises something: how far beside them the
/// light of the room's projector truly falls, as a share of what the map predicts there.
std::vector<double> sharesOfPlan(const studio::ErrorPlan& plan, const Installation& room, const Installation& truth) {
    const LabLens believed = lensOf(room.projectors.front().camera, "calibrated projector");
    const LabLens lamp = lensOf(truth.projectors.front().camera, "true projector");
    std::vector<double> shares;
    for (const bool raised : {false, true})
        for (int row = 0; row < studio::ErrorPlan::kRows; ++row)
            for (int column = 0; column < studio::ErrorPlan::kColumns; ++column) {
                const glm::dvec2 at = plan.placeOf(column, row);
                const double predicted =
                    (raised ? plan.device : plan.table)[std::size_t(row * studio::ErrorPlan::kColumns + column)];
                if (!std::isfinite(predicted) ||
                    std::max(std::abs(at.x), std::abs(at.y)) > 0.5 * studio::ErrorPlan::kMiddle)
                    continue;
                const glm::dvec3 place(at.x, raised ? plan.height : 0.0, at.y);
                const auto pixel = imageOf(believed, place);
                const auto ray = pixel ? rayThrough(lamp, *pixel) : std::nullopt;
                if (!ray) continue;
                const glm::dvec3 fell = lamp.position + (place.y - lamp.position.y) / ray->y * *ray;
                shares.push_back(1e3 * glm::distance(fell, place) / predicted);
            }
    return shares;
}

void Chain::measureProjector() {
    const auto calibrateButton = [this] {
        const auto* next = window.findNow<QAbstractButton>("calibrate.card.next");
        return next ? next->text() : QString();
    };
    const auto calibrateOffers = [&](const QString& words) {
        return eventually([&] { return calibrateButton().startsWith(words); }, 480s);
    };
    const auto press = [this] {
        pass(std::chrono::milliseconds(QApplication::doubleClickInterval() + 50));
        window.click("calibrate.card.next");
    };
    window.click("chain.rest");
    EXPECT_EQ(window.text("chain.card.title"), "Projector and camera") << "it begins with what all builds on";
    ASSERT_TRUE(offers("Open it")) << story();
    next();
    ASSERT_TRUE(calibrateOffers("Photograph pose 1"));
    window.click("calibrate.rest");
    ASSERT_TRUE(calibrateOffers("Use this calibration")) << window.text("calibrate.card.text").toStdString();
    press();
    ASSERT_TRUE(eventually([&] { return room().projectors.front().lens.way == Origin::Way::simulated; }));
    window.click("calibrate.show.map");
    const auto* view = window.find<studio::ErrorMapView>("calibrate.map");
    ASSERT_TRUE(view && eventually([&] { return view->plan().has_value(); }));
    window.screenshot("chain-map");
    map = *view->plan();
    ASSERT_TRUE(calibrateOffers("Go on with the chain"));
    press();
    ASSERT_TRUE(eventually([&] { return badge("projector") == "Simulated"; })) << story();
}

void Chain::measureUntilStop() {
    SoundMixer& mixer = window.studio().sound.mixer();
    mixer.setBoard(std::make_shared<const SoundBoard>(SoundBoard::synthesised()));
    window.click("chain.rest");
    EXPECT_TRUE(mixer.silent()) << "light moves nothing";
    ASSERT_TRUE(eventually([&] { return badge("servos") == "Running"; }, 120s)) << story();
    EXPECT_EQ(window.text("chain.warning"), "Hands off: the servos move");
    EXPECT_FALSE(mixer.silent()) << "that is to be heard";
    std::vector<std::int16_t> heard(2 * kSoundRate / 5);
    mixer.mix(heard);
    EXPECT_GT(std::ranges::max(heard), 5000);
    window.screenshot("chain-servos");
    // STOP ends it, and nothing of it is kept.
    window.studio().loop.stop();
    EXPECT_TRUE(eventually([&] { return badge("servos") == "Next"; }));
    EXPECT_TRUE(room().servos.empty());
    window.studio().loop.resume();
}

TEST_F(Chain, EachLinkIsMeasuredShownAndUsed) {
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig && window.studio().jobs.running().empty(); }, 60s));
    window.screenshot("chain");
    window.click("chain.link.tracker");
    EXPECT_EQ(badge("tracker"), "Later") << "the pointer comes first";
    window.click("chain.link.pointer");
    ASSERT_TRUE(offers("Measure in the lab")) << story();
    next();
    ASSERT_TRUE(offers("Use it")) << story();
    window.screenshot("chain-pointer");
    EXPECT_EQ(room().origins.pointer.way, Origin::Way::assumed) << "nothing is used before one says so";
    next();
    ASSERT_TRUE(eventually([&] { return badge("pointer") == "Simulated"; })) << story();
    EXPECT_EQ(room().origins.pointer.way, Origin::Way::simulated);
    EXPECT_GT(glm::length(room().pointerTip), 0.1F) << "the lab's pointer is long";
    window.studio().document.undoStack().undo();
    EXPECT_EQ(room().origins.pointer.way, Origin::Way::assumed);
    EXPECT_EQ(badge("pointer"), "To be used") << "undo gives it back to be used";
    window.studio().document.undoStack().redo();
    EXPECT_EQ(badge("pointer"), "Simulated");
}

TEST_F(Chain, TwoProjectorsAndOneInAMirrorAreCalibratedByTheMouse) {
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig && window.studio().jobs.running().empty(); }, 60s));
    EXPECT_FALSE(window.findNow<QWidget>("chain.link.room")) << "one projector is not several";
    studio::editInstallation(window.studio().document, "A projector of few pixels", [](Installation& edited) {
        InstalledProjector& first = edited.projectors.front();
        first.lens = first.pose = {Origin::Way::assumed, "of few pixels", ""}; // not entered by anybody
        first.camera = withSize(first.camera, {400, 225});
        edited.projectors.push_back(first);
        edited.projectors.back().name = "Side";
    });
    ASSERT_TRUE(eventually([&] { return badge("room") == "Next"; })) << badge("room").toStdString();
    EXPECT_EQ(badge("projector"), "Optional");
    EXPECT_EQ(badge("light"), "Later");
    const auto lightBeside = [&](std::size_t k) { // millimetres, on the table under the device
        const Installation truth = labTruth(room(), k);
        return 1e3 * lightError(room().projectors[k].camera, truth.projectors.front().camera, 0.2).value_or(9.0);
    };
    EXPECT_GT(lightBeside(0), 5.0) << "what is believed is far from it";
    for (const char* link : {"room", "mirror"}) {
        if (link == std::string_view("mirror") && !longTests()) continue;
        window.click(QString("chain.link.") + link);
        ASSERT_TRUE(offers("Measure in the lab")) << story();
        next();
        ASSERT_TRUE(eventually([&] { return button() == "Use it"; }, 400s)) << story();
        std::printf("%s: %s\n", link, story().c_str());
        window.screenshot(QString("chain-") + link, 300ms);
        next();
        ASSERT_TRUE(eventually([&] { return badge(link) == "Simulated"; })) << story();
        std::printf("%s: light truly lies %.2f and %.2f mm beside\n", link, lightBeside(0), lightBeside(1));
        EXPECT_LT(lightBeside(0), 0.5) << link;
        EXPECT_LT(lightBeside(1), 0.5) << link;
    }
    EXPECT_EQ(badge("light"), "Next") << "what builds on them may follow";
    EXPECT_TRUE(realParts(room()).empty()) << "nothing of it was measured";
}

TEST_F(Chain, TheRestIsMeasuredOneAfterTheOtherUntilStop) {
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig && window.studio().jobs.running().empty(); }, 60s));
    studio::editInstallation(
        window.studio().document, "A projector that the lab has measured", [](Installation& edited) {
            InstalledProjector& projector = edited.projectors.front();
            projector.lens = projector.pose = {Origin::Way::simulated, "virtual lab", "2026-11-20T10:00:00Z"};
        });
    ASSERT_NO_FATAL_FAILURE(measureUntilStop());
    for (const char* link : {"pointer", "tracker", "device"}) EXPECT_EQ(badge(link), "Simulated") << link;
}

// R24, R25, R26: from nothing to a show that is right in the lab as it truly is, all of its errors on at once.
TEST_F(Chain, AllThatIsMissingIsMeasuredOneAfterTheOther) {
    if (!longTests()) GTEST_SKIP() << "minutes of photographs: LUMORPH_LONG_TESTS=1";
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig && window.studio().jobs.running().empty(); }, 60s));
    for (const studio::ChainLink& link : studio::chainLinks()) {
        if (link.id == studio::LinkId::room) continue; // out of sight with one projector
        const QString how = badge(link.key);
        EXPECT_TRUE(link.stage->isWanted ? how == "Optional" : how == "Next" || how == "Later" || how == "Open")
            << link.key;
    }
    ASSERT_NO_FATAL_FAILURE(measureProjector());
    ASSERT_NO_FATAL_FAILURE(measureUntilStop());
    window.click("chain.rest");
    ASSERT_TRUE(eventually([&] { return badge("check") == "Simulated"; }, 300s)) << story();
    for (const studio::ChainLink& link : studio::chainLinks()) {
        if (link.id == studio::LinkId::room) continue;
        EXPECT_EQ(badge(link.key), link.stage->isWanted ? "Optional" : "Simulated") << link.key << ": " << story();
    }
    EXPECT_TRUE(window.text("chain.card.text").startsWith("All that was missing is measured.")) << story();
    EXPECT_EQ(room().servos.size(), window.state().rig.rig->actuatorCount());
    EXPECT_EQ(room().projectors.front().responseCurve.size(), 65U);
    EXPECT_GT(room().projectors.front().black.g, 0.0F);
    EXPECT_EQ(room().origins.colors.way, Origin::Way::simulated);
    window.screenshot("chain-checked");
    window.click("chain.link.light");
    window.screenshot("chain-light-measured", 300ms);
    window.click("chain.link.servos");
    window.screenshot("chain-servos-measured", 300ms);
    window.click("chain.link.delays");
    window.screenshot("chain-delays-measured", 300ms);
    EXPECT_EQ(room().origins.delays.way, Origin::Way::simulated);
    // The camera stands where the sequence has it: a part that it does not see in all its range keeps its lag, and that
    // is told.
    const QStringList figures = lagFigures();
    for (std::size_t k = 0; k < room().servos.size(); ++k) {
        const MeasuredServo& servo = room().servos[k];
        EXPECT_FALSE(servo.points.empty()) << "delays leave the curves as they are";
        if (!figures.contains(QString::fromStdString(servo.actuator))) {
            EXPECT_EQ(servo.lagSeconds, 0.0) << servo.actuator;
            continue;
        }
        EXPECT_GT(servo.lagSeconds, 0.02) << servo.actuator;
        EXPECT_NEAR(servo.lagSeconds, window.studio().lab.truth().servos[k].lagSeconds, 0.01) << servo.actuator;
    }
    EXPECT_GE(figures.size(), 5);
    window.click("chain.link.eye");
    window.screenshot("chain-eye", 300ms);
    // What the window ends with, judged in the room as it truly is by rays that share nothing with the renderer.
    const Installation& truth = window.studio().lab.truth();
    const std::vector<double> shares = sharesOfPlan(map, room(), truth);
    std::printf("light beside, as a share of the 95 %% of the window's map: mean %.2f, most %.2f of %zu places\n",
                meanOf(shares), quantileOf(shares, 1.0), shares.size());
    EXPECT_GT(shares.size(), 100U);
    EXPECT_LE(quantileOf(shares, 0.95), 1.0) << "inside the map in 95 of 100 places";
    EXPECT_GT(meanOf(shares), 0.01) << "the lab has its projector elsewhere than is believed";
    const ShownError shown = shownError(window.state().rig.rig, room(), truth);
    std::printf("by the window | balls %zu of %zu: mean %.2f, 95 %% %.2f pixels | skin mean %.2f pixels, %.2f mm | eye "
                "%.1f mm | device %.2f mm\n",
                shown.balls.size(), shown.judgedBalls, meanOf(shown.balls), quantileOf(shown.balls, 0.95),
                meanOf(shown.skinPixels), meanOf(shown.skinMillimetres), shown.eyeMillimetres, shown.deviceMillimetres);
    EXPECT_GE(shown.judgedBalls, 20U);
    EXPECT_GE(shown.balls.size() + 2, shown.judgedBalls) << "what is not seen at all is no small error";
    EXPECT_LE(meanOf(shown.balls), 1.5);
    EXPECT_LE(meanOf(shown.skinPixels), 1.5);
}

TEST_F(Chain, ALabsResultAsksBeforeItJoinsWhatWasMeasured) {
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig && window.studio().jobs.running().empty(); }, 60s));
    studio::editInstallation(window.studio().document, "Measured before", [](Installation& room) {
        room.origins.tracker = {Origin::Way::measured, "touched dots, 12", "2026-11-20T10:00:00Z"};
    });
    window.click("chain.link.pointer");
    ASSERT_TRUE(offers("Measure in the lab")) << story();
    next();
    ASSERT_TRUE(offers("Use it")) << story();
    EXPECT_EQ(window.text("chain.card.title"), "Simulated");
    next();
    ASSERT_TRUE(offers("Use it as simulated")) << story();
    EXPECT_EQ(window.text("chain.card.title"), "This room holds what was measured or entered");
    EXPECT_TRUE(window.text("chain.card.text").contains("tracker")) << story();
    EXPECT_EQ(room().origins.pointer.way, Origin::Way::assumed) << "it only asked";
    window.screenshot("chain-asks");
    window.click("chain.link.eye");
    window.click("chain.link.pointer");
    ASSERT_TRUE(offers("Use it")) << "the question is withdrawn: " << story();
    EXPECT_EQ(window.text("chain.card.title"), "Simulated");
    next();
    ASSERT_TRUE(offers("Use it as simulated")) << story();
    next();
    ASSERT_TRUE(eventually([&] { return badge("pointer") == "Simulated"; })) << story();
    EXPECT_EQ(room().origins.pointer.way, Origin::Way::simulated);
    EXPECT_EQ(room().origins.tracker.way, Origin::Way::measured);
    EXPECT_TRUE(window.studio().room.versions().front().version.isSimulated);
}

TEST_F(Chain, RecordingsAreReadInPlaceOfTheLab) {
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig && window.studio().jobs.running().empty(); }, 60s));
    const Installation truth = trueRoom(room(), window.state().rig.rig->actuators(), 31);
    const std::filesystem::path swings = folder.path() / "swings.csv", rests = folder.path() / "rests.csv";
    writePointer(capturePointerInLab(truth, 5), swings, rests);
    window.click("chain.link.pointer");
    window.click("chain.way.files");
    ASSERT_TRUE(offers("Choose: Swings"));
    next();
    answerFileDialog(window, "chain.recording.file", rests, "Open");
    ASSERT_TRUE(offers("Choose: Other dimples"));
    next();
    answerFileDialog(window, "chain.recording.file", rests, "Open");
    ASSERT_TRUE(offers("Read the recordings"));
    window.screenshot("chain-recordings");
    next();
    ASSERT_TRUE(offers("Measure again")) << story();
    EXPECT_EQ(window.text("chain.card.title"), "This is not to be trusted") << "rests are no swings: " << story();
    EXPECT_EQ(room().origins.pointer.way, Origin::Way::assumed);
    window.screenshot("chain-recordings-refused");
    window.click("chain.file.swings");
    answerFileDialog(window, "chain.recording.file", swings, "Open");
    ASSERT_TRUE(offers("Read the recordings")) << story();
    next();
    ASSERT_TRUE(offers("Use it")) << story();
    window.screenshot("chain-recordings-read");
    next();
    ASSERT_TRUE(eventually([&] { return badge("pointer") == "Measured"; })) << story();
    const float beside = glm::distance(room().pointerTip, truth.pointerTip);
    std::printf("pointer tip from recordings: %.2f mm from the truth\n", 1e3F * beside);
    EXPECT_LT(beside, 0.001F);
    // The rest ends where the next recording is missing: nothing of the lab gets into a real room.
    studio::editInstallation(window.studio().document, "Measured before", [](Installation& room) {
        room.projectors.front().lens = {Origin::Way::measured, "structured light", "2026-11-20T10:00:00Z"};
        room.projectors.front().response = {Origin::Way::measured, "flat light", "2026-11-20T10:10:00Z"};
    });
    window.click("chain.rest");
    EXPECT_TRUE(offers("Choose: Tracked body")) << story();
    EXPECT_EQ(badge("tracker"), "Next");
    EXPECT_EQ(room().origins.tracker.way, Origin::Way::assumed);
}

/// A board that is moved and turned about all axes, by the tracker and by a camera whose clock is `later`.
void writeBoard(const std::filesystem::path& tracked, const std::filesystem::path& seen, const Pose& worldFromTracker,
                double later) {
    const Pose bodyFromBoard{{0.03, -0.05, 0.02}, rotationOfTurn({0.2, -0.4, 0.9})};
    PoseTrack inTracker, inRoom;
    for (int k = 0; k < 1800; ++k) {
        const double t = k / 60.0;
        const Pose body{
            {0.3 * std::sin(0.9 * t), 0.8 + 0.1 * std::sin(1.3 * t), 0.2 * std::cos(0.7 * t)},
            rotationOfTurn({0.6 * std::sin(1.1 * t), 0.6 * std::sin(1.7 * t + 1.0), 0.6 * std::sin(0.8 * t + 2.0)})};
        inTracker.poses.push_back({t, body});
        inRoom.poses.push_back({t, worldFromTracker * body * bodyFromBoard});
    }
    std::ofstream first(tracked), second(seen);
    first.precision(12);
    second.precision(12);
    writePoses(first, inTracker, 0.0);
    writePoses(second, inRoom, later);
}

/// A hand on the simulated tracker of the pointer.
class PointerHand {
public:
    PointerHand(StudioWindow& window, const glm::dvec3& tip) : window_(window), tip_(tip) {}
    /// The tip at a place for a moment, the pointer turned so.
    void hold(const glm::dvec3& place, const glm::dvec3& turn, std::chrono::milliseconds time = 20ms) {
        SimulatedSteering& steering = *window_.studio().trackers.trackers().at(0).steering;
        SimulatedOrders orders = steering.orders();
        const glm::dquat rotation = rotationOfTurn(turn);
        orders.held = Pose{place - rotation * tip_, rotation};
        steering.order(orders);
        pass(time);
    }
    void swing(const glm::dvec3& dimple, const std::function<bool()>& untilDone) {
        for (double t = 0.0; t < 40.0 && !untilDone(); t += 0.02)
            hold(dimple, {0.7 * std::sin(2.1 * t), 0.9 * std::sin(0.9 * t), 0.7 * std::cos(1.7 * t)});
    }

private:
    StudioWindow& window_;
    glm::dvec3 tip_;
};

TEST_F(Chain, WhatTheLabRecordedIsKeptAndSolvedAgainAndStaysSimulated) {
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig && window.studio().jobs.running().empty(); }, 60s));
    window.click("chain.link.pointer");
    ASSERT_TRUE(offers("Measure in the lab"));
    next();
    ASSERT_TRUE(offers("Use it")) << story();
    const std::string told = story();
    window.click("chain.keep");
    answerFileDialog(window, "chain.keep.file", folder.path() / "pointer-1", "Keep");
    ASSERT_TRUE(eventually([&] { return window.text("chain.kept").contains("pointer-1"); }, 20s));
    window.screenshot("chain-recording-kept");
    // It is not used; what is solved again comes to the same.
    window.click("chain.way.files");
    EXPECT_FALSE(window.findNow<QAbstractButton>("chain.keep")) << "what was measured another way has gone";
    window.click("chain.file.recording");
    answerFileDialog(window, "chain.recording.file", folder.path() / "pointer-1" / "recording.json", "Open");
    ASSERT_TRUE(offers("Solve the recording")) << story();
    window.screenshot("chain-recording-chosen");
    next();
    ASSERT_TRUE(offers("Use it")) << story();
    EXPECT_EQ(story(), told) << "the same figures, and simulated";
    window.screenshot("chain-recording-solved");
    next();
    ASSERT_TRUE(eventually([&] { return badge("pointer") == "Simulated"; })) << story();
    EXPECT_EQ(room().origins.pointer.way, Origin::Way::simulated);
}

TEST_F(Chain, DelaysOfWhatIsConnectedAreNotTakenFromTheLab) {
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig && window.studio().jobs.running().empty(); }, 60s));
    studio::editInstallation(window.studio().document, "Measured before", [](Installation& room) {
        const Origin measured{Origin::Way::measured, "by hand", "2026-11-20T10:00:00Z"};
        room.projectors.front().lens = room.origins.pointer = room.origins.tracker = measured;
    });
    window.click("chain.link.delays");
    window.click("chain.way.live");
    EXPECT_TRUE(window.text("chain.live.seen").startsWith("The room has no camera of this machine")) << story();
    EXPECT_EQ(window.findNow<QLabel>("chain.warning"), nullptr) << "no servo moves for flashes";
    window.screenshot("chain-delays-connected", 300ms);
    window.studio().commands.find("calibrate.next")->trigger();
    EXPECT_TRUE(eventually([&] { return window.studio().jobs.running().empty(); }));
    EXPECT_EQ(room().origins.delays.way, Origin::Way::assumed);
}

TEST_F(Chain, PointerIsMeasuredWithTheTrackerThatIsConnected) {
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig && window.studio().jobs.running().empty(); }, 60s));
    window.click("chain.link.pointer");
    window.click("chain.way.live");
    EXPECT_TRUE(window.text("chain.live.seen").startsWith("No tracker is connected")) << story();
    ASSERT_TRUE(offers("Begin, with the tracker")) << story();
    window.screenshot("chain-live-nothing");
    next();
    EXPECT_EQ(window.text("chain.card.title"), "It could not be measured");
    window.studio().trackers.open("sim://pointer?rate=60");
    ASSERT_TRUE(
        eventually([&] { return window.text("chain.live.seen") == "The tracker sees all that is needed."; }, 10s));
    const glm::dvec3 tip(0.01, -0.15, 0.02);
    PointerHand hand(window, tip);
    next();
    ASSERT_TRUE(offers("Cancel")) << story();
    const auto title = [&] { return window.text("chain.card.title"); };
    ASSERT_TRUE(title().startsWith("Set the tip into a dimple")) << story();
    hand.swing({0.1, 0.0, 0.2}, [&] { return title().contains("1 of 3"); });
    ASSERT_TRUE(title().contains("1 of 3")) << story();
    window.screenshot("chain-live-step");
    for (int dimple = 0; dimple < 3; ++dimple)
        for (int way = 0; way < 2; ++way) {
            const QString asked = title();
            for (int tries = 0; tries < 100 && title() == asked; ++tries)
                hand.hold({0.2, 0.0, 0.1 * dimple}, {0.5 * way, 0.0, -0.4}, 100ms);
            ASSERT_NE(title(), asked) << story();
        }
    ASSERT_TRUE(offers("Use it")) << story();
    window.screenshot("chain-live-measured");
    next();
    ASSERT_TRUE(eventually([&] { return badge("pointer") == "Simulated"; })) << story() << ": by no real tracker";
    EXPECT_LT(glm::distance(room().pointerTip, glm::vec3(tip)), 0.0005F);
    // What it builds on comes first; a body that nobody tracks is named.
    window.click("chain.link.device");
    EXPECT_TRUE(window.text("chain.live.seen").contains("device")) << window.text("chain.live.seen").toStdString();
}

TEST(ChainFiles, TrackerIsPlacedByABoardThatMoves) {
    const TemporaryFolder folder;
    const std::filesystem::path tracked = folder.path() / "tracked.csv", seen = folder.path() / "seen.csv";
    const Pose truth{{0.4, -0.2, 0.7}, rotationOfTurn({0.3, 1.9, -0.2})};
    writeBoard(tracked, seen, truth, 0.05);
    const Registration placed = studio::trackerFromFiles({defaultInstallation(), {tracked, seen}}, {});
    ASSERT_TRUE(placed.good()) << placed.summary;
    const glm::mat4& found = placed.installation.worldFromTracker;
    EXPECT_LT(glm::distance(glm::dvec3(found[3]), truth.position), 0.001);
    const Pose pose{glm::dvec3(found[3]), glm::normalize(glm::quat_cast(glm::dmat3(glm::mat3(found))))};
    EXPECT_LT(angleOf((inverseOf(truth) * pose).rotation), 0.002);
    std::ofstream(seen, std::ios::app) << "31,nan,0,0,0,0,0,1\n";
    EXPECT_THROW((void)studio::trackerFromFiles({defaultInstallation(), {tracked, seen}}, {}), DataError);
    EXPECT_THROW((void)studio::trackerFromFiles({defaultInstallation(), {tracked, folder.path() / "none.csv"}}, {}),
                 DataError);
}

TEST_F(Chain, ARealDeviceIsPlacedByRecordings) {
    const std::filesystem::path data = LUMORPH_SHARED_DIR "/data/landmarks";
    if (!std::filesystem::exists(data)) GTEST_SKIP() << "without ../shared/data/landmarks";
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig && window.studio().jobs.running().empty(); }, 60s));
    const auto tipAt = [&](glm::vec3 tip) {
        studio::editInstallation(window.studio().document, "Tip", [tip](Installation& room) {
            room.pointerTip = tip;
            room.origins.pointer = {Origin::Way::entered, "", ""};
        });
    };
    tipAt({0.0F, 0.0F, 0.0F}); // a wrong one
    window.click("chain.link.device");
    window.click("chain.way.files");
    for (const char* file : {"pointer.csv", "reference.csv", "model.csv"}) {
        ASSERT_TRUE(eventually([&] { return button().startsWith("Choose: "); })) << story();
        next();
        answerFileDialog(window, "chain.recording.file", data / file, "Open");
    }
    ASSERT_TRUE(offers("Read the recordings")) << story();
    next();
    ASSERT_TRUE(offers("Measure again")) << story();
    EXPECT_EQ(window.text("chain.card.title"), "This is not to be trusted");
    std::printf("wrong tip: %s\n", story().c_str());
    window.screenshot("chain-device-wrong-tip");
    tipAt({0.108565F, 0.00777385F, 0.0025389F}); // as the data's facts have it
    next();
    ASSERT_TRUE(offers("Use it")) << story();
    std::printf("right tip: %s\n", story().c_str());
    window.screenshot("chain-device-recorded");
    next();
    EXPECT_TRUE(eventually([&] { return badge("device") == "Measured"; })) << story();
    EXPECT_EQ(room().origins.deviceBody.way, Origin::Way::measured);
}

TEST(ChainLinks, HaveTheOrderOfTheStages) {
    ASSERT_EQ(studio::chainLinks().size(), calibrationStages().size());
    for (std::size_t k = 0; k < calibrationStages().size(); ++k)
        EXPECT_EQ(studio::chainLinks()[k].stage, &calibrationStages()[k]) << studio::chainLinks()[k].key;
}

TEST(ChainLinks, ACheckThatCannotPutRightOffersNothingToUse) {
    // The camera has moved, and the room knows of none: what is believed is the lab's, which is not kept.
    StageSite site{std::make_shared<const Rig>(test::cutTablet()), defaultInstallation()};
    CalibratedCamera& lamp = site.room.projectors.front().camera;
    lamp = withSize(lamp, {480, 270});
    LabBench bench(*site.rig, pushed(withLabCamera(site.room), *site.rig, {"camera", 3e-3, 0.0}, 2), 1);
    const StageOutcome outcome = outcomeOf(measureStage(calibrationStage("verify"), site, bench), site.room);
    EXPECT_FALSE(outcome.isGood);
    EXPECT_FALSE(outcome.changesRoom) << studio::wordsOf(outcome).summary.toStdString();
}

TEST_F(Chain, TheWatchIsGreyWhereItWouldSeeItsOwnBelief) {
    window.studio().lab.packUp();
    QAction* watch = window.studio().commands.find("calibrate.watch");
    EXPECT_FALSE(watch->isEnabled());
    EXPECT_TRUE(watch->toolTip().contains("the room has no camera of this machine")) << watch->toolTip().toStdString();
    studio::editInstallation(window.studio().document, "A camera", [](Installation& room) {
        room = withLabCamera(room);
        room.cameras.front().address = "camera9";
    });
    EXPECT_TRUE(watch->isEnabled()) << "by the room's camera";
    window.studio().document.undoStack().undo();
    EXPECT_FALSE(watch->isEnabled());
    window.studio().lab.unpack();
    EXPECT_TRUE(watch->isEnabled()) << "by what truly stands in the lab";
    watch->setChecked(true);
    window.studio().lab.packUp();
    EXPECT_FALSE(watch->isEnabled());
    EXPECT_FALSE(watch->isChecked()) << "it ends with the lab";
}

// The lab's camera sees the room as it truly was when the watch began.
TEST_F(Chain, TheWatchTellsAHostThatTheProjectorHasMoved) {
    window.window().showWorkspace("scene");
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig && window.studio().jobs.running().empty(); }, 60s));
    window.studio().lab.unpack();
    studio::editInstallation(
        window.studio().document, "As it truly is",
        [truth = window.studio().lab.truth()](Installation& room) { room = withLabCamera(truth); });
    QAction* watch = window.studio().commands.find("calibrate.watch");
    ASSERT_TRUE(watch->isEnabled());
    watch->setChecked(true);
    EXPECT_EQ(window.find<QPushButton>("status.watch")->text(), "Watch: looking");
    pass(12s);
    EXPECT_TRUE(window.studio().notices.at("calibrate").empty());
    studio::editInstallation(window.studio().document, "Believed elsewhere",
                             [](Installation& room) { room.projectors.front().camera.cameraFromWorld[3].x += 0.003; });
    // Looks six seconds apart have to agree for ten.
    ASSERT_TRUE(eventually([&] { return !window.studio().notices.at("calibrate").empty(); }, 120s));
    EXPECT_EQ(window.find<QPushButton>("status.watch")->text(), "Watch: something has moved");
    window.screenshot("watch-moved", 500ms);
    const studio::Notice notice = window.studio().notices.at("calibrate").front();
    ASSERT_EQ(notice.actions.size(), 1U);
    notice.actions.front().run();
    EXPECT_EQ(window.window().workspace(), "calibrate");
    EXPECT_EQ(window.text("chain.card.title"), "Check");
    watch->setChecked(false);
    EXPECT_EQ(window.findNow<QPushButton>("status.watch"), nullptr);
    EXPECT_TRUE(window.studio().notices.at("calibrate").empty()) << "nobody watches any more";
}

} // namespace
} // namespace lumorph::test
