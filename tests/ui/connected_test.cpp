#include "app/studio/calibration/connected.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <QAbstractButton>

#include "tests/ui/devices_window.h"

// What is connected: each part's state and remedy from plain facts, then the page of the Calibrate workspace.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;
using studio::ConnectedFacts;
using studio::ConnectedPart;

studio::SeenBody seenBody(const char* name, std::optional<PoseRole> role, double age = 0.0) {
    studio::SeenBody body;
    body.name = name;
    body.role = role;
    body.age = age;
    return body;
}

/// A room in which everything is connected, and nothing simulated.
ConnectedFacts allConnected() {
    ConnectedFacts facts;
    facts.room = defaultInstallation();
    facts.room.projectors.front().camera.size = {1920, 1080};
    facts.room.cameras.resize(1);
    facts.room.cameras.front().address = "genicam://Basler-21438501";
    facts.room.cameras.front().camera.size = {2448, 2048};
    facts.outputs = {{true, "HDMI-1", {}}};
    TrackerStatus tracker;
    tracker.address = "natnet://192.168.0.5";
    tracker.receiving = true;
    tracker.framesPerSecond = 120.0;
    tracker.latencyMilliseconds = 8.0;
    facts.trackers = {tracker};
    facts.bodies = {seenBody("pen", PoseRole::pointer), seenBody("tablet", PoseRole::device),
                    seenBody("cap", PoseRole::head)};
    facts.rig = "cut tablet";
    facts.servos = 6;
    facts.link.phase = LinkPhase::live;
    facts.link.servos.resize(6);
    for (ServoStatus& servo : facts.link.servos) servo.attached = true;
    facts.controller = "Maestro";
    return facts;
}

/// A part without a name where there is none of this kind.
ConnectedPart partOf(const ConnectedFacts& facts, const QString& kind) {
    const std::vector<ConnectedPart> parts = connectedParts(facts);
    const auto found = std::ranges::find(parts, kind, &ConnectedPart::kind);
    return found == parts.end() ? ConnectedPart() : *found;
}

QString badgeOf(const ConnectedFacts& facts, const QString& kind) { return wordOf(partOf(facts, kind).state); }
std::string wordsOf(const ConnectedFacts& facts, const QString& kind) { return partOf(facts, kind).text.toStdString(); }

TEST(ConnectedParts, OfNothingEachSaysWhatToDo) {
    ConnectedFacts nothing;
    nothing.room = defaultInstallation();
    const struct {
        const char* kind;
        const char* badge;
        const char* remedy;
        const char* button;
    } rows[] = {{"projector1", "Missing", "in Projector and camera choose Camera", "Projector and camera"},
                {"camera", "Virtual lab", "choose Camera in Projector and camera", "Projector and camera"},
                {"tracker", "Missing", "open one in Devices", "Open Devices"},
                {"device", "Missing", "open that of the device", "Open rig..."},
                {"servos", "Missing", "open one first", "Open rig..."}};
    const std::vector<ConnectedPart> parts = connectedParts(nothing);
    ASSERT_EQ(parts.size(), std::size(rows));
    for (std::size_t k = 0; k < parts.size(); ++k) {
        EXPECT_EQ(parts[k].kind, rows[k].kind);
        EXPECT_EQ(wordOf(parts[k].state), rows[k].badge) << rows[k].kind;
        EXPECT_TRUE(parts[k].text.contains(rows[k].remedy)) << parts[k].text.toStdString();
        EXPECT_EQ(buttonOf(parts[k].place), rows[k].button) << rows[k].kind;
    }
    const studio::ConnectedSummary summary = connectedSummary(parts);
    EXPECT_EQ(summary.title, "Next: projector 1");
    EXPECT_EQ(summary.text, parts.front().text);
    EXPECT_EQ(summary.place, ConnectedPart::Place::setup);
    nothing.room.projectors.front().enabled = false;
    EXPECT_EQ(partOf(nothing, "projector1").place, ConnectedPart::Place::scene);
}

TEST(ConnectedParts, OfEverythingAreReadyWithTheirFigures) {
    ConnectedFacts facts = allConnected();
    const std::pair<const char*, const char*> rows[] = {{"projector1", "1920 × 1080 pixels is shown on screen HDMI-1"},
                                                        {"camera", "2448 × 2048 pixels"},
                                                        {"tracker", "120 frames a second, 8 ms after"},
                                                        {"device", "cut tablet with 6 servos"},
                                                        {"servos", "6 of 6 are driven, by Maestro"}};
    for (const auto& [kind, figures] : rows) {
        const ConnectedPart part = partOf(facts, kind);
        EXPECT_EQ(part.state, ConnectedPart::State::ready) << kind << ": " << part.text.toStdString();
        EXPECT_TRUE(part.text.contains(QString::fromUtf8(figures))) << part.text.toStdString();
        EXPECT_FALSE(part.isSimulated) << kind;
    }
    EXPECT_TRUE(wordsOf(facts, "tracker").ends_with("Seen: pen as pointer, tablet as device, cap as head."));
    studio::ConnectedSummary summary = connectedSummary(connectedParts(facts));
    EXPECT_EQ(summary.title, "Nothing is missing");
    EXPECT_FALSE(summary.place) << "on with the chain";
    EXPECT_TRUE(summary.text.startsWith("Nothing of it says")) << summary.text.toStdString();

    facts.room.cameras.front().address = "http://127.0.0.1:8080/lumorph-table";
    facts.trackers.front().source = "Lumorph table 0.4";
    facts.isControllerSimulated = true;
    summary = connectedSummary(connectedParts(facts));
    EXPECT_TRUE(summary.text.startsWith("Simulated: camera, tracker, servos.")) << summary.text.toStdString();
    EXPECT_TRUE(wordsOf(facts, "servos").ends_with("Simulated."));
}

TEST(ConnectedParts, OfATrackerNameTheRolesThatAreMissing) {
    ConnectedFacts facts = allConnected();
    facts.bodies.front().age = 2.0;
    facts.bodies.push_back(seenBody("marker 4", std::nullopt));
    EXPECT_EQ(badgeOf(facts, "tracker"), "Needs you");
    EXPECT_NE(wordsOf(facts, "tracker").find("Not seen: pointer."), std::string::npos) << wordsOf(facts, "tracker");
    EXPECT_NE(wordsOf(facts, "tracker").find("Without a role: marker 4."), std::string::npos);

    facts = allConnected();
    facts.bodies.push_back(seenBody("glasses", PoseRole::head));
    EXPECT_EQ(badgeOf(facts, "tracker"), "Needs you");
    EXPECT_NE(wordsOf(facts, "tracker").find("Two bodies are the head"), std::string::npos);

    facts = allConnected();
    facts.trackers.front().receiving = false;
    facts.trackers.front().advice = "is Motive's streaming on?";
    EXPECT_EQ(badgeOf(facts, "tracker"), "Needs you");
    EXPECT_NE(wordsOf(facts, "tracker").find("Nothing arrives from natnet://192.168.0.5. Is Motive's"),
              std::string::npos)
        << wordsOf(facts, "tracker");
}

TEST(ConnectedParts, OfAProjectorNeedItsOwnScreenPixelByPixel) {
    ConnectedFacts facts = allConnected();
    facts.outputs.front().problem = "its window has 1280 × 800 pixels, the projector 1920 × 1080";
    EXPECT_EQ(badgeOf(facts, "projector1"), "Needs you");
    EXPECT_NE(wordsOf(facts, "projector1").find("HDMI-1, but its window has 1280 × 800 pixels"), std::string::npos);
    facts.outputs.front() = {true, {}, {}};
    EXPECT_EQ(badgeOf(facts, "projector1"), "Needs you");
    EXPECT_NE(wordsOf(facts, "projector1").find("in a window"), std::string::npos);

    facts = allConnected();
    facts.room.projectors.push_back(facts.room.projectors.front());
    EXPECT_EQ(badgeOf(facts, "projector2"), "Missing");
    facts.room.projectors.back().enabled = false;
    EXPECT_TRUE(partOf(facts, "projector2").kind.isEmpty()) << "it is switched off";
}

TEST(ConnectedParts, OfCameraAndServosSayWhatKeepsThemFromUse) {
    ConnectedFacts facts = allConnected();
    facts.room.cameras.front().address = "/dev/video7";
    facts.room.cameras.resize(2);
    facts.room.cameras.back().name = "Side";
    facts.isCameraPresent = false;
    EXPECT_EQ(badgeOf(facts, "camera"), "Missing");
    EXPECT_NE(wordsOf(facts, "camera").find("/dev/video7"), std::string::npos);
    EXPECT_NE(wordsOf(facts, "camera").find("Also in the room: Side."), std::string::npos);

    facts.link.servos.back().attached = false;
    EXPECT_EQ(badgeOf(facts, "servos"), "Needs you");
    EXPECT_TRUE(wordsOf(facts, "servos").starts_with("5 of 6 are driven: ")) << wordsOf(facts, "servos");
    for (const LinkPhase phase : {LinkPhase::connecting, LinkPhase::handshake, LinkPhase::unidentified,
                                  LinkPhase::disarmed, LinkPhase::starting, LinkPhase::stopped, LinkPhase::lost}) {
        facts.link.phase = phase;
        EXPECT_EQ(badgeOf(facts, "servos"), "Needs you");
        EXPECT_NE(wordsOf(facts, "servos").find("Devices"), std::string::npos) << wordsOf(facts, "servos");
    }
    facts.link = {};
    EXPECT_EQ(badgeOf(facts, "servos"), "Missing");
    EXPECT_TRUE(wordsOf(facts, "servos").starts_with("0 of 6 are driven: connect")) << wordsOf(facts, "servos");
}

class ConnectedPage : public DevicesWindow {
protected:
    [[nodiscard]] QString badge(const QString& kind) { return window.text("connected." + kind + ".how"); }
    [[nodiscard]] bool tellsOf(const QString& kind, const QString& words) {
        return eventually([&] { return window.text("connected." + kind + ".text").contains(words); }, 10s);
    }
};

TEST_F(ConnectedPage, FollowsWhatIsConnectedAndLeadsToWhatIsMissing) {
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig && window.studio().jobs.running().empty(); }, 60s));
    window.window().showWorkspace("calibrate");
    window.click("calibrate.whole");
    window.click("chain.connected");
    ASSERT_NE(window.find<QWidget>("connected.view"), nullptr);
    EXPECT_EQ(window.findNow<QWidget>("chain.view"), nullptr);
    EXPECT_TRUE(window.find<QAbstractButton>("chain.connected")->isChecked());
    EXPECT_EQ(badge("projector1"), "Missing");
    EXPECT_EQ(badge("camera"), "Virtual lab");
    EXPECT_EQ(badge("tracker"), "Missing");
    EXPECT_EQ(badge("device"), "Ready");
    EXPECT_EQ(badge("servos"), "Missing");
    EXPECT_EQ(window.text("connected.card.title"), "Next: projector 1");
    window.screenshot("connected");

    // What is missing is set up elsewhere, and the page is still there afterwards.
    window.click("connected.card.next");
    EXPECT_NE(window.find<QWidget>("calibrate.setup"), nullptr);
    window.click("calibrate.whole");
    window.studio().outputs.showInWindow(0);
    EXPECT_TRUE(tellsOf("projector1", "in a window"));
    EXPECT_EQ(badge("projector1"), "Needs you");
    window.studio().outputs.close(0);
    EXPECT_EQ(badge("projector1"), "Missing");

    window.click("connected.servos.go");
    ASSERT_EQ(window.window().workspace(), "devices");
    goLive();
    ASSERT_FALSE(HasFatalFailure());
    window.window().showWorkspace("calibrate");
    EXPECT_TRUE(eventually([&] { return badge("servos") == "Ready"; }, 10s)) << badge("servos").toStdString();
    EXPECT_TRUE(tellsOf("servos", QString("%1 of %1 are driven").arg(window.state().rig.rig->actuatorCount())));
    EXPECT_TRUE(tellsOf("servos", "Simulated."));

    window.studio().trackers.open("sim://pointer");
    EXPECT_TRUE(tellsOf("tracker", "Seen: pointer as pointer."));
    EXPECT_TRUE(tellsOf("tracker", "Not seen: device and head."));
    EXPECT_EQ(badge("tracker"), "Needs you");
    for (const char* other : {"sim://device", "sim://head"}) window.studio().trackers.open(other);
    EXPECT_TRUE(eventually([&] { return badge("tracker") == "Ready"; }, 10s));
    window.screenshot("connected-servos");

    window.click("chain.link.pointer");
    EXPECT_NE(window.find<QWidget>("chain.view"), nullptr);
    EXPECT_EQ(window.findNow<QWidget>("connected.view"), nullptr);
    EXPECT_TRUE(window.find<QAbstractButton>("chain.link.pointer")->isChecked());
    EXPECT_FALSE(window.find<QAbstractButton>("chain.connected")->isChecked());
}

} // namespace
} // namespace lumorph::test
