#include <chrono>

#include <QAbstractButton>
#include <QComboBox>

#include "tests/ui/studio_window.h"

// Trackers as their user has them, against a simulated head: what counts is whom the loop follows.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;

class TrackersWindow : public ::testing::Test {
protected:
    TrackersWindow() : window(folder_ / "session", "devices") {
        window.studio().settings.setValue("trackers/roles", {});
        if (auto* dock = window.window().findChild<QDockWidget*>("dock.devices.trackers")) dock->raise();
    }

    [[nodiscard]] bool opens(const QString& address) {
        window.enter("trackers.address", address, Qt::Key_Tab);
        window.click("trackers.open");
        return eventually([&] { return window.findNow<QWidget>("tracker.0") != nullptr; }, 10s);
    }
    [[nodiscard]] std::string viewer() { return window.studio().loop.frame()->viewer; }
    [[nodiscard]] QString textNow(const QString& name) {
        const auto* label = window.findNow<QLabel>(name);
        return label ? label->text() : QString();
    }
    [[nodiscard]] double framesPerSecond() { return textNow("tracker.0.frames").section(' ', 0, 0).toDouble(); }

    TemporaryFolder folder_;
    StudioWindow window;
};

TEST_F(TrackersWindow, TheLoopFollowsASimulatedHeadUntilItIsClosed) {
    EXPECT_EQ(viewer(), "");
    const auto own = window.studio().loop.frame()->eye;
    EXPECT_NE(window.findNow<QWidget>("empty.tracker.simulate"), nullptr);
    ASSERT_TRUE(opens("sim://head?rate=60"));
    EXPECT_TRUE(eventually([&] { return framesPerSecond() > 10.0; }, 10s)) << framesPerSecond();
    EXPECT_TRUE(eventually([&] { return textNow("tracker.0.body.0.name").startsWith("head"); }, 5s));
    EXPECT_TRUE(eventually([&] { return textNow("tracker.0.body.0.place").contains("cm"); }, 5s));
    auto* role = window.find<QComboBox>("tracker.0.body.0.role");
    ASSERT_NE(role, nullptr);
    EXPECT_EQ(role->currentText(), "Head");
    EXPECT_TRUE(eventually([&] { return viewer() == "head"; }, 5s));
    ASSERT_TRUE(window.studio().loop.frame()->eye);
    EXPECT_GT(window.studio().loop.frame()->eye->z, 0.3F) << "where a simulated head is";
    window.screenshot("trackers-head");
    window.click("tracker.0.close");
    EXPECT_TRUE(eventually([&] { return viewer().empty() && window.studio().loop.frame()->eye == own; }, 5s));
    EXPECT_TRUE(eventually([&] { return window.findNow<QWidget>("empty.tracker.simulate") != nullptr; }, 5s));
    EXPECT_TRUE(window.studio().trackers.addresses().contains("sim://head?rate=60")) << "it is offered again";
}

TEST_F(TrackersWindow, WhoABodyIsCanBeChangedAndIsRemembered) {
    ASSERT_TRUE(opens("sim://head"));
    ASSERT_TRUE(eventually([&] { return viewer() == "head"; }, 10s));
    auto* role = window.find<QComboBox>("tracker.0.body.0.role");
    ASSERT_NE(role, nullptr);
    role->setFocus();
    QTest::keyClick(role, Qt::Key_N); // nobody
    EXPECT_TRUE(eventually([&] { return viewer().empty(); }, 5s));
    EXPECT_FALSE(window.studio().trackers.role("head").has_value());
    studio::Notices notices;
    studio::TrackerDesk later(window.studio().settings, window.studio().loop, notices);
    later.open("sim://head");
    EXPECT_TRUE(eventually([&] { return !later.trackers().empty(); }, 5s));
    EXPECT_TRUE(eventually([&] { return !later.trackers().front().status.bodies.empty(); }, 5s));
    EXPECT_FALSE(later.role("head").has_value()) << "as it was said before";
}

TEST_F(TrackersWindow, AWrongAddressIsToldAndNothingIsOpen) {
    window.enter("trackers.address", "natnet://somewhere", Qt::Key_Return);
    EXPECT_NE(window.find<QWidget>("notice"), nullptr);
    EXPECT_TRUE(window.studio().trackers.trackers().empty());
    EXPECT_FALSE(window.studio().notices.at("devices").empty());
    EXPECT_FALSE(window.studio().trackers.addresses().contains("natnet://somewhere"));
    ASSERT_TRUE(opens("sim://pointer"));
    EXPECT_TRUE(eventually([&] { return window.studio().notices.at("devices").empty(); }, 5s));
}

TEST(TrackerRoles, AreGuessedByTheName) {
    EXPECT_EQ(studio::likelyRole("Anna's Hat"), PoseRole::head);
    EXPECT_EQ(studio::likelyRole("EYEglass"), PoseRole::head);
    EXPECT_EQ(studio::likelyRole("my tablet"), PoseRole::device);
    EXPECT_EQ(studio::likelyRole("body 3"), std::nullopt);
}

} // namespace
} // namespace lumorph::test
