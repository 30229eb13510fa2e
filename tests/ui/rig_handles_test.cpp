#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>

#include <QComboBox>
#include <QListWidget>

#include "app/studio/widgets/value_field.h"
#include "app/workspaces/rig/actuator_guide.h"
#include "app/workspaces/rig/influence_map.h"
#include "core/rig/rig_file.h"
#include "core/rig/templates/reference_rigs.h"
#include "tests/ui/stall_watch.h"
#include "tests/ui/view_pictures.h"

// Handles of an actuator in the Rig workspace's view, by real mouse events. What a drag must come to is worked out here
// from the ray through the pixel where it ended.

namespace lumorph::studio {
namespace {

using test::dragMouse;
using test::eventually;

constexpr double kPi = std::numbers::pi;

glm::dvec3 unit(const glm::vec3& v) { return glm::normalize(glm::dvec3(v)); }

/// The line that a hinge or a bend turns about, read from the parts.
struct Line {
    glm::dvec3 origin, axis;
};
Line lineOf(const Actuator& actuator) {
    if (const auto* hinge = std::get_if<Hinge>(&actuator.deformer)) return {hinge->origin, unit(hinge->axis)};
    const auto& bend = std::get<Bend>(actuator.deformer);
    return {bend.origin, unit(bend.axis)};
}
double distanceFrom(const Line& line, const glm::dvec3& point) {
    return glm::length(glm::cross(point - line.origin, line.axis));
}
glm::dvec3 meets(const Ray& ray, const glm::dvec3& at, const glm::dvec3& normal) {
    const glm::dvec3 o(ray.origin), d(ray.direction);
    return o + glm::dot(at - o, normal) / glm::dot(d, normal) * d;
}

class RigHandles : public testing::Test {
protected:
    RigHandles() {
        window.studio().document.change("Pause", [](StudioState& state) { state.playback.playing = false; });
        view = window.find<ViewportWidget>("rig.viewport");
    }

    /// Another rig than the demo's tablet.
    void take(Rig rig) {
        const auto taken = std::make_shared<const Rig>(std::move(rig));
        window.studio().project.takeRig(taken, "a device");
        ASSERT_TRUE(
            eventually([&] { return window.state().rig.rig == taken && window.studio().jobs.running().empty(); },
                       std::chrono::seconds(60)));
    }
    /// By a click in the list; waits until the view shows it and the wiggle is over.
    void choose(std::size_t index) {
        auto* list = window.find<QListWidget>("rig.list");
        list->scrollToItem(list->item(static_cast<int>(index)));
        QTest::mouseClick(list->viewport(), Qt::LeftButton, {},
                          list->visualItemRect(list->item(static_cast<int>(index))).center());
        chosen = index;
        test::pass(std::chrono::milliseconds(2700));
        ASSERT_TRUE(eventually([&] { return view->settled(); }));
    }
    [[nodiscard]] const RigParts& parts() { return *window.state().rig.parts; }
    [[nodiscard]] const Actuator& actuator() { return parts().actuators.at(chosen); }
    [[nodiscard]] std::vector<std::byte> bytes() { return writeRigGlb(Rig(parts())); }
    [[nodiscard]] int steps() { return window.studio().document.undoStack().index(); }
    [[nodiscard]] glm::vec2 size() { return {view->width(), view->height()}; }
    [[nodiscard]] ActuatorGuide guide() {
        return guideOf(parts(), chosen, window.state().rig.rig->verticesOf(chosen)).value();
    }
    [[nodiscard]] QPointF seen(RigHandle wanted, double stroke = 0.0) {
        for (const SeenHandle& one : seenHandles(guide(), stroke, view->camera(), size()))
            if (one.handle == wanted) return {one.pixel.x, one.pixel.y};
        ADD_FAILURE() << "there is no such handle";
        return {};
    }
    /// The ray through where the handle's middle is carried by a drag.
    [[nodiscard]] Ray rayAfter(const QPointF& handle, const QPointF& by) {
        const QPointF end = handle + by;
        return rayThrough(view->camera(), {end.x(), end.y()}, size());
    }
    [[nodiscard]] std::vector<glm::vec3> shown() {
        const auto& scene = view->scene();
        return scene && !scene->surfaces.empty() ? *scene->surfaces.front().positions : std::vector<glm::vec3>();
    }
    [[nodiscard]] std::vector<glm::vec3> deformed(const std::vector<double>& strokes) {
        std::vector<glm::vec3> positions(parts().restMesh.positions.size());
        Rig(parts()).deform(strokes, positions);
        return positions;
    }
    /// The last drag is one step, and undo gives back every byte.
    void expectOneStep(const std::vector<std::byte>& before, int stepsBefore) {
        EXPECT_EQ(steps(), stepsBefore + 1);
        EXPECT_NE(bytes(), before);
        window.studio().document.undoStack().undo();
        EXPECT_EQ(bytes(), before);
        ASSERT_TRUE(eventually([&] { return window.state().rig.compiled && view->settled(); }));
    }

    TemporaryFolder folder;
    test::StudioWindow window{folder / "session", "rig"};
    ViewportWidget* view = nullptr;
    std::size_t chosen = 0;
};

/// The angle about a flap's line under a pixel's ray, from the way along the sheet to the flap.
double angleUnder(const Ray& ray, const RigParts& parts, std::size_t index) {
    const Actuator& actuator = parts.actuators.at(index);
    const Line line = lineOf(actuator);
    double low = 1e9, high = -1e9;
    for (const Influence& influence : actuator.influences) {
        const double along = glm::dot(glm::dvec3(parts.restMesh.positions[influence.vertex]) - line.origin, line.axis);
        low = std::min(low, along);
        high = std::max(high, along);
    }
    const glm::dvec3 from = meets(ray, line.origin + 0.5 * (low + high) * line.axis, line.axis) - line.origin;
    const glm::dvec3 arm = unit(std::get<Bend>(actuator.deformer).direction);
    return std::atan2(glm::dot(from, glm::cross(line.axis, arm)), glm::dot(from, arm));
}

TEST_F(RigHandles, ALimitGoesWhereTheRayMeetsTheArc) {
    ASSERT_TRUE(std::holds_alternative<Bend>(actuator().deformer)) << "the tablet's flaps bend";
    for (const std::size_t index : {std::size_t{0}, std::size_t{3}}) {
        choose(index);
        const auto before = bytes();
        const int step = steps();
        const double speed = actuator().maxVelocity * (rangeOf(actuator()).max - rangeOf(actuator()).min);
        const QPointF handle = seen(RigHandle::to);
        const QPointF by(-31.0, 23.0);
        const double expected = angleUnder(rayAfter(handle, by), parts(), index);
        dragMouse(view, handle, by, {}, false);
        EXPECT_EQ(steps(), step) << "a drag is no step";
        // The flap follows the hand: it stands at the limit.
        ASSERT_TRUE(eventually([&] { return window.state().rig.compiled; }));
        std::vector<double> strokes = window.studio().loop.frame()->estimatedStrokes;
        strokes[index] = 1.0;
        EXPECT_TRUE(eventually([&] { return shown() == deformed(strokes); }));
        window.screenshot("rig_handles_limit");
        QTest::mouseRelease(view, Qt::LeftButton, {}, (handle.toPoint() + by).toPoint());
        EXPECT_NEAR(rangeOf(actuator()).max, expected, 1e-4);
        EXPECT_EQ(rangeOf(actuator()).min, 0.0);
        EXPECT_NEAR(actuator().maxVelocity * rangeOf(actuator()).max, speed, 1e-9) << "its servo is as fast as before";
        expectOneStep(before, step);
    }
}

TEST_F(RigHandles, AnEndOfTheLineGoesWhereTheRayMeetsTheSheet) {
    choose(1);
    const auto before = bytes();
    const int step = steps();
    for (const RigHandle end : {RigHandle::lineStart, RigHandle::lineEnd}) {
        const auto ends = endsOf(guide());
        const glm::dvec3 fixed(ends[end == RigHandle::lineStart ? 1 : 0]);
        const Line line = lineOf(actuator());
        const glm::dvec3 normal = glm::cross(line.axis, unit(std::get<Bend>(actuator().deformer).direction));
        const QPointF handle = seen(end);
        const QPointF by(17.0, -26.0);
        const glm::dvec3 goal = meets(rayAfter(handle, by), line.origin, normal);
        dragMouse(view, handle, by);
        const Line now = lineOf(actuator());
        EXPECT_LT(distanceFrom(now, goal), 1e-5);
        EXPECT_LT(distanceFrom(now, fixed), 1e-5);
        EXPECT_GT(std::abs(std::acos(std::min(1.0, glm::dot(now.axis, line.axis)))), 0.01) << "it has turned";
        const glm::dvec3 direction = unit(std::get<Bend>(actuator().deformer).direction);
        EXPECT_LT(std::abs(glm::dot(direction, now.axis)), 1e-5);
        EXPECT_LT(std::abs(glm::dot(direction, normal)), 1e-5) << "it stays in the sheet";
        EXPECT_NO_THROW(Rig{parts()});
        window.screenshot("rig_handles_line");
        expectOneStep(before, step);
    }
}

TEST_F(RigHandles, ArrowsCarryTheLineAndTheArcOfABendIsDrawnOut) {
    choose(0);
    const auto before = bytes();
    const int step = steps();
    // An arrow across the line: 45 of its 90 pixels out.
    const glm::vec3 pivot = guide().pivot;
    const Line line = lineOf(actuator());
    const glm::vec3 across = std::abs(line.axis.x) < 0.9 ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
    const auto a = pixelOf(view->camera(), pivot, size()).value();
    const auto b = pixelOf(view->camera(), pivot + 0.01F * across, size()).value();
    const glm::vec2 grab = a + 45.0F * glm::normalize(b - a);
    dragMouse(view, {grab.x, grab.y}, {b.x - a.x, b.y - a.y});
    const glm::dvec3 moved = lineOf(actuator()).origin - line.origin;
    EXPECT_NEAR(glm::dot(moved, glm::dvec3(across)), 0.01, 0.0015);
    EXPECT_LT(glm::length(glm::cross(moved, glm::dvec3(across))), 1e-6) << "along the arrow alone";
    EXPECT_EQ(lineOf(actuator()).axis, line.axis);
    expectOneStep(before, step);

    const QPointF handle = seen(RigHandle::bendEnd);
    const QPointF by(14.0, 9.0);
    const glm::dvec3 direction = unit(std::get<Bend>(actuator().deformer).direction);
    const glm::dvec3 goal = meets(rayAfter(handle, by), line.origin, glm::cross(line.axis, direction));
    dragMouse(view, handle, by);
    EXPECT_NEAR(std::get<Bend>(actuator().deformer).length, std::max(0.001, glm::dot(goal - line.origin, direction)),
                1e-5);
    expectOneStep(before, step);
}

TEST_F(RigHandles, EscapeTakesBackWhatWasDragged) {
    choose(2);
    const auto before = bytes();
    const int step = steps();
    const auto asItStood = shown();
    for (const RigHandle one : {RigHandle::to, RigHandle::lineEnd, RigHandle::bendEnd}) {
        const QPointF handle = seen(one);
        dragMouse(view, handle, {20.0, 14.0}, {}, false);
        EXPECT_NE(bytes(), before);
        QTest::keyClick(view, Qt::Key_Escape);
        EXPECT_EQ(bytes(), before);
        QTest::mouseRelease(view, Qt::LeftButton);
        EXPECT_EQ(bytes(), before);
        EXPECT_EQ(steps(), step);
        EXPECT_TRUE(eventually([&] { return shown() == asItStood; }));
    }
    const ViewCamera camera = view->camera();
    dragMouse(view, seen(RigHandle::to), {2.0, 1.0});
    EXPECT_EQ(bytes(), before) << "a click that trembles is no drag";
    EXPECT_EQ(view->camera(), camera);
}

TEST_F(RigHandles, CtrlSnapsToWholeSteps) {
    choose(0);
    dragMouse(view, seen(RigHandle::to), {-20.0, 31.0}, Qt::ControlModifier);
    const double sixths = Angle::radians(rangeOf(actuator()).max).inDegrees() / 15.0;
    EXPECT_NEAR(sixths, std::round(sixths), 1e-9);
    const QPointF end = seen(RigHandle::lineEnd);
    dragMouse(view, end, {25.0, 30.0}, Qt::ControlModifier);
    const glm::dvec3 axis = lineOf(actuator()).axis;
    const double turns = std::atan2(axis.z, axis.x) / (kPi / 12.0);
    EXPECT_NEAR(turns, std::round(turns), 1e-4);
}

TEST_F(RigHandles, ThePointerRehearsesInTheViewAlone) {
    choose(0);
    const auto before = window.state();
    const auto asItStood = shown();
    const double stroke = window.studio().loop.frame()->estimatedStrokes[0];
    const QPointF handle = seen(RigHandle::stroke, stroke);
    const QPointF to = seen(RigHandle::stroke, 0.6);
    dragMouse(view, handle, to - handle);
    EXPECT_TRUE(eventually([&] { return view->settled(); }));
    EXPECT_EQ(window.state().rig.parts, before.rig.parts);
    EXPECT_EQ(window.state().strokes, before.strokes);
    std::vector<double> strokes = window.studio().loop.frame()->estimatedStrokes;
    strokes[0] = 0.6;
    const auto wanted = deformed(strokes), is = shown();
    ASSERT_EQ(is.size(), wanted.size());
    float farthest = 0.0F;
    for (std::size_t v = 0; v < is.size(); ++v) farthest = std::max(farthest, glm::distance(is[v], wanted[v]));
    EXPECT_LT(farthest, 0.002F);
    EXPECT_NE(is, asItStood);
    window.screenshot("rig_handles_rehearsed");
    window.click("rig.backButton");
    EXPECT_TRUE(eventually([&] { return shown() == asItStood; }));
}

TEST_F(RigHandles, AWayIsDraggedByItsEndsAndTurned) {
    take(referenceRigs().at(2)); // 30 x 30 pins
    choose(465);
    const auto before = bytes();
    int step = steps();
    const ActuatorGuide was = guide();
    for (const RigHandle limit : {RigHandle::to, RigHandle::from}) {
        // Where the picture of the way shows a place 6 mm further, the limit has to go there.
        const double value = (limit == RigHandle::to ? was.range.max : was.range.min) + 0.006;
        const auto goal =
            pixelOf(view->camera(), was.pivot + static_cast<float>(value - was.range.min) * was.axis, size()).value();
        const QPointF handle = seen(limit);
        step = steps();
        dragMouse(view, handle, QPointF(goal.x, goal.y) - handle);
        const ActuatorRange now = rangeOf(actuator());
        EXPECT_NEAR(limit == RigHandle::to ? now.max : now.min, value, 2e-5);
        EXPECT_EQ(limit == RigHandle::to ? now.min : now.max, limit == RigHandle::to ? was.range.min : was.range.max);
        expectOneStep(before, step);
    }
    const QPointF handle = seen(RigHandle::direction);
    const QPointF by(40.0, 10.0);
    const glm::dvec3 tip = [&] {
        const glm::vec3 end = was.pivot + static_cast<float>(was.range.max - was.range.min) * was.axis;
        return glm::dvec3(end + 44.0F * metresPerPixel(view->camera(), end, size()) * was.axis);
    }();
    const glm::dvec3 back = -unit(view->camera().pivot - eyeOf(view->camera()));
    const glm::dvec3 goal = meets(rayAfter(handle, by), tip, back) - glm::dvec3(was.pivot);
    step = steps();
    dragMouse(view, handle, by);
    EXPECT_LT(glm::distance(unit(std::get<Slide>(actuator().deformer).direction), glm::normalize(goal)), 1e-4);
    window.screenshot("rig_handles_way");
    expectOneStep(before, step);
}

TEST_F(RigHandles, TheKindOfServoIsChosenAndSaysWhetherItIsStrongEnough) {
    choose(4);
    const auto before = bytes();
    const int step = steps();
    auto* servo = window.find<QComboBox>("rig.edit.servo");
    const auto pick = [&](const QString& name) {
        servo->setCurrentIndex(servo->findText(name));
        emit servo->activated(servo->currentIndex());
    };
    const ServoLoad needed = servoLoad(*window.state().rig.rig, chosen);
    pick("SG90");
    EXPECT_EQ(actuator().drive.servo, "SG90");
    EXPECT_EQ(steps(), step + 1);
    ASSERT_TRUE(eventually([&] { return window.text("rig.edit.load").contains("SG90"); }));
    EXPECT_EQ(window.text("rig.edit.load").contains("Too weak"), needed.torque > 0.5 * 0.17652);
    window.screenshot("rig_servo_weak");
    pick("DS3218");
    ASSERT_TRUE(eventually([&] { return window.text("rig.edit.load").contains("DS3218"); }));
    EXPECT_FALSE(window.text("rig.edit.load").contains("Too weak"));
    // 90 degrees at 0.16 s for 60.
    auto* stroke = window.find<ValueField>("rig.edit.stroke");
    window.enter("rig.edit.stroke", "0.1");
    EXPECT_NEAR(1.0 / actuator().maxVelocity, 0.24, 1e-9);
    EXPECT_TRUE(stroke->toolTip().contains("0.24 s at best"));
    window.screenshot("rig_servo");
    while (steps() > step) window.studio().document.undoStack().undo();
    EXPECT_EQ(bytes(), before);
}

TEST_F(RigHandles, TheMirrorImageTakesOverHowTheChosenOneMoves) {
    choose(0);
    dragMouse(view, seen(RigHandle::to), {-31.0, 23.0});
    const double max = rangeOf(actuator()).max;
    const auto before = bytes();
    const int step = steps();
    window.command("mirror to the other side");
    ASSERT_TRUE(eventually([&] { return steps() == step + 1; }));
    EXPECT_EQ(parts().actuators.size(), 6U);
    EXPECT_EQ(rangeOf(parts().actuators[1]).max, max) << "corner front right as corner front left";
    expectOneStep(before, step);
}

TEST_F(RigHandles, ColoursSayHowFarEachPlaceGoes) {
    choose(0);
    const std::size_t without = view->scene()->surfaces.size();
    window.click("rig.influenceButton");
    ASSERT_TRUE(eventually([&] { return view->scene()->surfaces.size() > without && view->settled(); }));
    window.screenshot("rig_influence");
    // A triangle of a higher band goes farther than one of a lower, at the end of its stroke, and the rest stays.
    const Rig& rig = *window.state().rig.rig;
    const std::vector<int> bands = InfluenceMap(rig, 0).bands();
    std::vector<double> strokes(rig.actuatorCount(), 0.0);
    const auto rest = deformed(strokes);
    strokes[0] = 1.0;
    const auto now = deformed(strokes);
    std::vector<double> least(InfluenceMap::kBands, 1e9), most(InfluenceMap::kBands, 0.0);
    for (std::size_t t = 0; t < bands.size(); ++t) {
        double way = 0.0;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = rig.restMesh().triangles[t][k];
            way += static_cast<double>(glm::distance(now[v], rest[v])) / 3.0;
        }
        if (bands[t] < 0) {
            EXPECT_LT(way, 1e-5);
            continue;
        }
        least[bands[t]] = std::min(least[bands[t]], way);
        most[bands[t]] = std::max(most[bands[t]], way);
    }
    EXPECT_GT(most.back(), 0.04) << "its tip goes farthest";
    for (int b = 1; b < InfluenceMap::kBands; ++b)
        EXPECT_LE(most[b - 1], least[b] + 0.0005) << b; // an empty band says nothing
    window.click("rig.influenceButton");
    EXPECT_TRUE(eventually([&] { return view->scene()->surfaces.size() == without; }));
}

/// What the window's own thread has worked so far, whoever else has the processor.
double workedMilliseconds() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

TEST_F(RigHandles, ADragHoldsTheWindowUpByLessThanATenthOfASecond) {
    choose(0);
    const QPointF handle = seen(RigHandle::to);
    std::vector<double> worked;
    double longest = 1e9;
    // Another program may have the processor in one try.
    for (int attempt = 0; attempt < 6 && longest >= 100.0; ++attempt) {
        QTest::mousePress(view, Qt::LeftButton, {}, handle.toPoint());
        test::StallWatch watch;
        for (int i = 1; i <= 60; ++i) {
            const QPointF at = handle + QPointF(-0.8 * i, 0.6 * i);
            QMouseEvent move(QEvent::MouseMove, at, view->mapToGlobal(at), Qt::NoButton, Qt::LeftButton, {});
            const double before = workedMilliseconds();
            QApplication::sendEvent(view, &move);
            worked.push_back(workedMilliseconds() - before);
            test::pass(std::chrono::milliseconds(15));
        }
        longest = watch.takeLongest();
        QTest::keyClick(view, Qt::Key_Escape);
        QTest::mouseRelease(view, Qt::LeftButton);
    }
    std::ranges::nth_element(worked, worked.begin() + static_cast<std::ptrdiff_t>(worked.size() / 2));
    std::printf("the longest stall of a drag: %.0f ms; a move takes %.1f ms of work\n", longest,
                worked[worked.size() / 2]);
    EXPECT_LT(longest, 100.0);
    EXPECT_LT(worked[worked.size() / 2], 1000.0 / 60.0) << "60 edits a second";
}

} // namespace
} // namespace lumorph::studio
