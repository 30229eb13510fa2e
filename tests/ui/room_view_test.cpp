#include <algorithm>
#include <array>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "app/workspaces/devices/room_view.h"
#include "tests/calibration/photographer.h"
#include "tests/ui/trackers_window.h"

// The room of tracked bodies: led by mouse and keys, and seen from any side.

namespace lumorph::test {
namespace {

class RoomWindow : public TrackersWindow {
protected:
    [[nodiscard]] studio::RoomView& room() { return *window.find<studio::RoomView>("trackers.room"); }
    /// Where a place of the room is in its view.
    [[nodiscard]] static QPoint pixelIn(const studio::RoomView& view, const glm::dvec3& place) {
        const ViewCamera& camera = view.camera();
        const glm::dmat4 turn = glm::rotate(glm::rotate(glm::dmat4(1.0), camera.pitch.inRadians(), {1.0, 0.0, 0.0}),
                                            -camera.yaw.inRadians(), {0.0, 1.0, 0.0});
        const glm::dvec3 seen = glm::dvec3(turn * glm::dvec4(place - glm::dvec3(camera.pivot), 1.0));
        const double unit = 0.5 * view.height() / std::tan(0.5 * camera.fieldOfView.inRadians());
        const glm::dvec2 at = unit / (camera.distance - seen.z) * glm::dvec2(seen.x, -seen.y);
        return QPointF(0.5 * view.width() + at.x, 0.5 * view.height() + at.y).toPoint();
    }
};

TEST_F(RoomWindow, ASimulatedHeadGoesWhereItIsDraggedAndTheShowFollows) {
    ASSERT_TRUE(opens("sim://head"));
    ASSERT_TRUE(eventually([&] { return viewer() == "head"; }, 10s));
    reveal("trackers.room");
    studio::RoomView& view = room();
    ASSERT_TRUE(eventually([&] { return view.focusPolicy() == Qt::StrongFocus; }, 5s)) << "it has something to move";
    const Pose before = truth();
    const QPoint from = pixelIn(view, before.position);
    const QPoint to = from + QPoint(30, -18);
    QTest::mousePress(&view, Qt::LeftButton, {}, from);
    for (int i = 1; i <= 6; ++i) QTest::mouseMove(&view, from + QPoint(5 * i, -3 * i));
    QTest::mouseRelease(&view, Qt::LeftButton, {}, to);
    ASSERT_TRUE(window.studio().trackers.trackers().at(0).steering->orders().held) << "it no longer goes by itself";
    const Pose held = *window.studio().trackers.trackers().at(0).steering->orders().held;
    // It walked on for the moment that the test took.
    const QPoint off = pixelIn(view, held.position) - to;
    EXPECT_LT(off.manhattanLength(), 12) << "it stays under the pointer";
    EXPECT_GT(held.position.x, before.position.x + 0.01) << "to the right";
    EXPECT_LT(held.position.z, before.position.z - 0.01) << "away from who looks";
    EXPECT_NEAR(held.position.y, before.position.y, 0.05);
    EXPECT_TRUE(eventually([&] { return eye() && glm::distance(glm::dvec3(*eye()), held.position) < 0.003; }, 10s))
        << "the show is drawn for where it was put";
    window.screenshot("trackers-dragged");
    const auto* release = window.find<QWidget>("tracker.0.sim.release");
    ASSERT_TRUE(eventually([&] { return release->isEnabled(); }, 2s)) << "there is something to let go of";
    window.click("tracker.0.sim.release");
    EXPECT_TRUE(eventually([&] { return glm::distance(truth().position, held.position) > 0.01; }, 10s));
}

TEST_F(RoomWindow, TheAxesOfABodyAreSeenFromAnySide) {
    ASSERT_TRUE(opens("sim://device"));
    reveal("trackers.room");
    studio::RoomView& view = room();
    ASSERT_TRUE(eventually([&] { return view.focusPolicy() == Qt::StrongFocus; }, 5s));
    view.setFocus();
    QTest::keyClick(&view, Qt::Key_PageUp, Qt::ControlModifier); // takes it by the hand
    for (int i = 0; i < 4; ++i) QTest::keyClick(&view, Qt::Key_Comma);
    const auto pose = [&] { return window.studio().trackers.trackers().at(0).status.bodies.at(0).pose; };
    const auto held = [&] { return *window.studio().trackers.trackers().at(0).steering->orders().held; };
    const auto arrives = [&] { return glm::distance(pose().position, held().position) < 0.001; };
    const auto showsAxes = [&] {
        const QImage picture = view.grab().toImage();
        std::string wrong;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 end(0.0);
            end[axis] = 0.05; // an axis is 6 cm long at least
            const QPoint at = pixelIn(view, pose().position + pose().rotation * end);
            if ((at - pixelIn(view, pose().position)).manhattanLength() < 12) continue; // it points at the viewer
            const QColor color = picture.pixelColor(at * picture.devicePixelRatio());
            const std::array channels{color.red(), color.green(), color.blue()};
            const auto most = std::ranges::max_element(channels) - channels.begin();
            if (most != axis || color.saturation() < 60)
                wrong += "axis " + std::to_string(axis) + " is " + color.name().toStdString() + "; ";
        }
        return wrong;
    };
    ASSERT_TRUE(eventually(arrives, 10s));
    EXPECT_TRUE(eventually([&] { return showsAxes().empty(); }, 2s)) << showsAxes();
    window.screenshot("trackers-turned");
    const double yaw = view.camera().yaw.inDegrees();
    const QPoint beside(view.width() - 12, 12);
    QTest::mousePress(&view, Qt::LeftButton, {}, beside);
    QTest::mouseMove(&view, beside - QPoint(80, 0));
    QTest::mouseMove(&view, beside - QPoint(120, 0));
    QTest::mouseRelease(&view, Qt::LeftButton, {}, beside - QPoint(120, 0));
    EXPECT_NEAR(view.camera().yaw.inDegrees(), yaw + 90.0, 1.0) << "half its height is a quarter of a turn";
    EXPECT_TRUE(eventually([&] { return showsAxes().empty(); }, 2s)) << showsAxes();
    const glm::dvec3 before = held().position;
    QTest::keyClick(&view, Qt::Key_Right, Qt::ControlModifier);
    EXPECT_LT(glm::distance(held().position - before, {0.0, 0.0, -0.10}), 1e-9) << "to the right as it is seen";
    ASSERT_TRUE(eventually(arrives, 10s));
    QTest::mouseDClick(&view, Qt::LeftButton, {}, beside);
    EXPECT_NEAR(view.camera().pitch.inDegrees(), 90.0, 1e-6) << "from above";
    EXPECT_TRUE(eventually([&] { return showsAxes().empty(); }, 2s)) << showsAxes();
    window.screenshot("trackers-turned-above");
    QTest::mouseDClick(&view, Qt::LeftButton, {}, beside);
    EXPECT_NEAR(view.camera().yaw.inDegrees(), yaw, 1e-6) << "as it was at first";
}

TEST_F(RoomWindow, KeysMoveLiftAndTurnASimulatedDevice) {
    ASSERT_TRUE(opens("sim://device"));
    reveal("trackers.room");
    studio::RoomView& view = room();
    ASSERT_TRUE(eventually([&] { return view.focusPolicy() == Qt::StrongFocus; }, 5s));
    view.setFocus();
    QTest::keyClick(&view, Qt::Key_PageUp); // takes it by the hand
    const auto held = [&] { return *window.studio().trackers.trackers().at(0).steering->orders().held; };
    const Pose start = held();
    for (int i = 0; i < 3; ++i) QTest::keyClick(&view, Qt::Key_Right);
    QTest::keyClick(&view, Qt::Key_Up);
    QTest::keyClick(&view, Qt::Key_PageUp, Qt::ControlModifier);
    for (int i = 0; i < 6; ++i) QTest::keyClick(&view, Qt::Key_Comma);
    const Pose end = held();
    for (const Qt::KeyboardModifier other : {Qt::AltModifier, Qt::MetaModifier})
        QTest::keyClick(&view, Qt::Key_Right, other); // a desktop's
    QKeyEvent settings(QEvent::ShortcutOverride, Qt::Key_Comma, Qt::ControlModifier);
    settings.ignore();
    QCoreApplication::sendEvent(&view, &settings);
    EXPECT_FALSE(settings.isAccepted()) << "Ctrl+comma is the window's";
    EXPECT_EQ(held().position, end.position);
    EXPECT_LT(glm::distance(end.position - start.position, {0.03, 0.10, -0.01}), 1e-9);
    EXPECT_NEAR(degreesBetween(start.rotation, end.rotation), 30.0, 1e-6);
    const auto device = [&] { return glm::dmat4(window.studio().loop.frame()->worldFromDevice); };
    EXPECT_TRUE(eventually([&] { return glm::distance(glm::dvec3(device()[3]), end.position) < 0.003; }, 10s));
    EXPECT_LT(degreesBetween(glm::quat_cast(glm::dmat3(device())), end.rotation), 1.0) << "the show turns with it";
}

TEST_F(RoomWindow, ABodyThatGoesWhileItIsDraggedIsLetGo) {
    ASSERT_TRUE(opens("sim://head"));
    reveal("trackers.room");
    studio::RoomView& view = room();
    ASSERT_TRUE(eventually([&] { return view.focusPolicy() == Qt::StrongFocus; }, 5s));
    const QPoint from = pixelIn(view, truth().position);
    QTest::mousePress(&view, Qt::LeftButton, {}, from);
    QTest::mouseMove(&view, from + QPoint(5, 0));
    ASSERT_TRUE(window.studio().trackers.trackers().at(0).steering->orders().held) << "it is dragged";
    view.show({}); // as when its tracker ends meanwhile
    for (int i = 2; i < 5; ++i) QTest::mouseMove(&view, from + QPoint(5 * i, 0));
    QTest::mouseRelease(&view, Qt::LeftButton, {}, from);
    EXPECT_NE(view.cursor().shape(), Qt::ClosedHandCursor);
}

TEST_F(RoomWindow, ADragKeepsToItsBodyWhenAnotherTrackerCloses) {
    ASSERT_TRUE(opens("sim://device"));
    ASSERT_TRUE(opens("sim://head"));
    reveal("trackers.room");
    studio::RoomView& view = room();
    const auto trackers = [&] { return window.studio().trackers.trackers(); };
    const auto head = [&] { return trackers().back(); };
    ASSERT_TRUE(eventually([&] { return trackers().size() == 2 && !head().status.bodies.empty(); }, 10s));
    pass(300ms); // both are drawn
    const QPoint from = pixelIn(view, head().status.bodies.at(0).pose.position);
    QTest::mousePress(&view, Qt::LeftButton, {}, from);
    QTest::mouseMove(&view, from + QPoint(5, 0));
    ASSERT_TRUE(head().steering->orders().held) << "the head is dragged";
    const double before = head().steering->orders().held->position.x;
    window.studio().trackers.close(QString::fromStdString(trackers().at(0).status.address));
    ASSERT_TRUE(eventually([&] { return trackers().size() == 1; }, 5s));
    pass(300ms);
    for (int i = 2; i < 8; ++i) QTest::mouseMove(&view, from + QPoint(5 * i, 0));
    QTest::mouseRelease(&view, Qt::LeftButton, {}, from + QPoint(35, 0));
    EXPECT_GT(head().steering->orders().held->position.x, before + 0.01) << "it goes on, to the right";
}

} // namespace
} // namespace lumorph::test
