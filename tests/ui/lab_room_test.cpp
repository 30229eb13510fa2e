#include "app/studio/calibration/lab_room.h"

#include <fstream>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "app/studio/calibration/chain_service.h"
#include "app/studio/calibration/live_service.h"
#include "app/studio/document/scene_edit.h"
#include "calibration/lab/true_room.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/small_rigs.h"
#include "tests/ui/event_loop.h"

// The lab's one truth, and what becomes of it and of what was measured by it. Without a window.

namespace lumorph::studio {
namespace {

using test::eventually;

class LabRoomTest : public ::testing::Test {
protected:
    void open(Rig rig) {
        document.change("Opened", [&rig](StudioState& state) {
            state.rig.rig = state.rig.origin = std::make_shared<const Rig>(std::move(rig));
        });
    }
    void edit(const std::function<void(Installation&)>& change) { editInstallation(document, "Measured", change); }
    [[nodiscard]] const Installation& believed() const { return *document.state().installation; }

    struct Forgotten { // before and after each test
        Forgotten() { forget(); }
        ~Forgotten() { forget(); }
        static void forget() {
            Settings kept;
            for (const char* key : {"lab/unpacked", "lab/next"}) kept.remove(key);
        }
    } forgotten;
    Settings settings;
    Notices notices;
    Jobs jobs;
    StudioDocument document;
    StudioLoop loop{document};
    TrackerService trackers{settings, loop, notices};
    LabRoom lab{settings, document, trackers};
};

TEST_F(LabRoomTest, PackedItIsAsIsBelievedAndUnpackedAnotherThatStaysTheSame) {
    open(test::cutTablet());
    EXPECT_FALSE(lab.isUnpacked());
    EXPECT_EQ(lab.truth(), believed());
    edit([](Installation& room) { room.pointerTip = {0.0F, -0.1F, 0.0F}; });
    EXPECT_EQ(lab.truth(), believed());
    int told = 0;
    QObject::connect(&lab, &LabRoom::changed, [&told] { ++told; });
    lab.unpack();
    EXPECT_TRUE(lab.isUnpacked());
    const Installation truth = lab.truth();
    EXPECT_GT(glm::distance(truth.pointerTip, believed().pointerTip), 0.005F);
    EXPECT_GT(glm::distance(truth.eyeFromHead, believed().eyeFromHead), 0.001F);
    EXPECT_NE(truth.worldFromTracker, believed().worldFromTracker);
    EXPECT_EQ(truth.servos.size(), document.state().rig.rig->actuatorCount());
    EXPECT_EQ(truth.projectors.front().camera, believed().projectors.front().camera) << "it was put up by hand";
    lab.unpack();
    EXPECT_EQ(told, 1) << "it is unpacked already";
    EXPECT_EQ(lab.truth(), truth) << "asked twice it is the same";
    // Whoever starts the program again finds the same.
    EXPECT_EQ(LabRoom(settings, document, trackers).truth(), truth);
}

TEST_F(LabRoomTest, WhatIsMeasuredAndTakenBackLeavesTheTruth) {
    open(test::cutTablet());
    lab.unpack();
    const Installation truth = lab.truth();
    edit([&truth](Installation& room) {
        room.pointerTip = truth.pointerTip;
        room.origins.pointer = {Origin::Way::measured, "swings", "2026-11-20T10:00:00Z"};
        room.servos = truth.servos;
        room.worldFromTracker = truth.worldFromTracker;
        room.predictionSeconds = truth.predictionSeconds;
        room.projectors.front().gain = truth.projectors.front().gain;
        room.deviceColor = truth.deviceColor;
        room.origins.colors.way = Origin::Way::measured;
    });
    const auto expectSame = [&](const char* when) {
        EXPECT_EQ(lab.truth().pointerTip, truth.pointerTip) << when;
        EXPECT_EQ(lab.truth().servos, truth.servos) << when;
        EXPECT_EQ(lab.truth().worldFromTracker, truth.worldFromTracker) << when;
        EXPECT_EQ(lab.truth().predictionSeconds, truth.predictionSeconds) << when;
        EXPECT_EQ(lab.truth().projectors.front().gain, truth.projectors.front().gain) << when;
        EXPECT_EQ(lab.truth().deviceColor, truth.deviceColor) << when;
    };
    expectSame("measured");
    document.undoStack().undo();
    expectSame("taken back");
    EXPECT_EQ(lab.truth(), truth);
    document.undoStack().redo();
    expectSame("measured again");
}

TEST_F(LabRoomTest, PackedUpItIsAsIsBelievedAndTheNextOneIsAnother) {
    open(test::cutTablet());
    lab.unpack();
    const Installation first = lab.truth();
    lab.packUp();
    EXPECT_FALSE(lab.isUnpacked());
    EXPECT_EQ(lab.truth(), believed());
    EXPECT_EQ(LabRoom(settings, document, trackers).truth(), believed()) << "at the next start too";
    lab.packUp();
    lab.unpack();
    EXPECT_NE(lab.truth().pointerTip, first.pointerTip);
    EXPECT_NE(lab.truth().worldFromTracker, first.worldFromTracker);
}

TEST_F(LabRoomTest, AnotherProjectIsInTheSameRoomWithServosOfItsOwn) {
    open(test::cutTablet());
    lab.unpack();
    const Installation truth = lab.truth();
    StudioState other = document.state();
    other.rig.rig = std::make_shared<const Rig>(test::cushionRig());
    document.reset(other, {});
    EXPECT_TRUE(lab.isUnpacked());
    EXPECT_EQ(lab.truth().worldFromTracker, truth.worldFromTracker);
    EXPECT_EQ(lab.truth().pointerTip, truth.pointerTip);
    EXPECT_EQ(lab.truth().trackerSeconds, truth.trackerSeconds);
    ASSERT_EQ(lab.truth().servos.size(), 3U);
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(lab.truth().servos[k].actuator, document.state().rig.rig->actuators()[k].name);
    // Edited, its actuators are others.
    document.change("Edited",
                    [](StudioState& state) { state.rig.rig = std::make_shared<const Rig>(test::lifterRig()); });
    EXPECT_EQ(lab.truth(), LabRoom(settings, document, trackers).truth()) << "as after the next start";
    open(test::cutTablet());
    EXPECT_EQ(lab.truth().servos, truth.servos) << "back with the first device its servos are as they were";
}

/// The chain beside such a lab, fed with recordings.
class DoubtedPointer : public LabRoomTest {
protected:
    /// A board moved and turned about all axes, by a tracker and by a camera; `spoil` is what the tracker does.
    void write(const std::function<void(glm::dvec3& place, glm::dquat& turn)>& spoil) {
        std::ofstream tracked(folder.path() / "tracked.csv"), seen(folder.path() / "seen.csv");
        const auto row = [](std::ostream& out, double t, const glm::dvec3& p, const glm::dquat& q) {
            out << t << ',' << p.x << ',' << p.y << ',' << p.z << ',' << q.x << ',' << q.y << ',' << q.z << ',' << q.w
                << '\n';
        };
        tracked.precision(12);
        seen.precision(12);
        const auto turnOf = [](double x, double y, double z) { return glm::dquat(glm::dvec3(x, y, z)); };
        const glm::dquat world = turnOf(0.3, 1.2, -0.2), board = turnOf(0.2, -0.4, 0.9);
        for (int k = 0; k < 1200; ++k) {
            const double t = k / 60.0;
            glm::dvec3 place{0.3 * std::sin(0.9 * t), 0.8 + 0.1 * std::sin(1.3 * t), 0.2 * std::cos(0.7 * t)};
            glm::dquat turn =
                turnOf(0.6 * std::sin(1.1 * t), 0.6 * std::sin(1.7 * t + 1.0), 0.6 * std::sin(0.8 * t + 2.0));
            row(seen, t, world * (place + turn * glm::dvec3(0.03, -0.05, 0.02)) + glm::dvec3(0.4, -0.2, 0.7),
                world * turn * board);
            spoil(place, turn);
            row(tracked, t, place, turn);
        }
    }
    [[nodiscard]] bool measures() {
        const auto& links = chainLinks();
        const auto tracker =
            static_cast<std::size_t>(std::ranges::find(links, LinkId::tracker, &ChainLink::id) - links.begin());
        chain.setWay(LinkWay::files);
        chain.choose(tracker);
        chain.setFile(tracker, 0, folder.path() / "tracked.csv");
        chain.setFile(tracker, 1, folder.path() / "seen.csv");
        chain.measure();
        return eventually([this] { return !chain.state().session.running(); }, std::chrono::seconds(60)) &&
               chain.state().session.outcomeAt(tracker) != nullptr;
    }
    void believePointer(Origin::Way way) {
        edit([way](Installation& room) {
            room.pointerTip = {0.01F, -0.16F, 0.0F};
            room.origins.pointer = {way, "8 swings", "2026-11-20T10:00:00Z"};
        });
    }
    [[nodiscard]] const Origin& pointer() const { return believed().origins.pointer; }

    TemporaryFolder folder;
    LiveService live{trackers, [](const QImage&) {}};
    ChainService chain{document, loop, lab,     jobs,
                       notices,  live, nullptr, [](const InstallationVersion&) { return true; }};
};

TEST_F(DoubtedPointer, AMirroredTrackerLeavesThePointerInDoubtWithItsFigure) {
    open(test::cutTablet());
    for (const bool mirrored : {true, false}) {
        believePointer(Origin::Way::measured);
        write([mirrored](glm::dvec3& place, glm::dquat& turn) {
            if (!mirrored) return void(place *= 100.0); // it tells centimetres
            place.z = -place.z;
            turn = {turn.w, -turn.x, -turn.y, turn.z};
        });
        ASSERT_TRUE(measures());
        EXPECT_EQ(pointer().way, Origin::Way::assumed) << mirrored;
        EXPECT_NE(pointer().method.find("in doubt"), std::string::npos) << pointer().method;
        EXPECT_EQ(believed().pointerTip, glm::vec3(0.01F, -0.16F, 0.0F)) << "nobody has a better one";
        EXPECT_EQ(believed().origins.tracker.way, Origin::Way::assumed);
        document.undoStack().undo();
        EXPECT_EQ(pointer().way, Origin::Way::measured) << "undo gives it back";
    }
}

TEST_F(DoubtedPointer, AGoodTrackerOrATipByHandIsLeftAlone) {
    open(test::cutTablet());
    believePointer(Origin::Way::measured);
    write([](glm::dvec3&, glm::dquat&) {});
    ASSERT_TRUE(measures());
    EXPECT_EQ(pointer().way, Origin::Way::measured);
    believePointer(Origin::Way::entered);
    write([](glm::dvec3& place, glm::dquat&) { place *= 100.0; });
    ASSERT_TRUE(measures());
    EXPECT_EQ(pointer().way, Origin::Way::entered) << "nobody said that it was measured by this tracker";
}

} // namespace
} // namespace lumorph::studio
