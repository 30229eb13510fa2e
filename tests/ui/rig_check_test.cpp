#include <gtest/gtest.h>

#include <cmath>

#include <QAbstractButton>
#include <QListWidget>

#include "app/studio/document/rig_edit.h"
#include "app/workspaces/rig/rig_facts.h"
#include "core/rig/rig_check.h"
#include "tests/support/small_rigs.h"
#include "tests/ui/studio_window.h"

namespace lumorph::studio {
namespace {

using test::eventually;

/// A body and two flaps on it: "left" may turn down into the body, "right" is sound but goes fast.
std::shared_ptr<const Rig> faultyRig() {
    RigParts parts;
    parts.name = "faulty";
    parts.restMesh = test::boxMesh({-0.1F, 0, 0}, {0.1F, 0.03F, 0.08F});
    const auto add = [&](const char* name, const glm::vec3& min, const glm::vec3& max, const Hinge& hinge,
                         double velocity) {
        const auto first = static_cast<std::uint32_t>(parts.restMesh.positions.size());
        append(parts.restMesh, test::boxMesh(min, max));
        Actuator actuator;
        actuator.name = name;
        actuator.deformer = hinge;
        actuator.maxVelocity = velocity;
        for (std::uint32_t v = first; v < parts.restMesh.positions.size(); ++v)
            actuator.influences.push_back({v, 1.0F});
        parts.actuators.push_back(std::move(actuator));
    };
    add("right", {0.02F, 0.05F, 0.02F}, {0.08F, 0.052F, 0.06F},
        {{0.02F, 0.05F, 0}, {0, 0, 1}, Angle(), Angle::degrees(90)}, 4.0);
    add("left", {-0.08F, 0.04F, 0.02F}, {-0.02F, 0.042F, 0.06F},
        {{-0.02F, 0.04F, 0}, {0, 0, 1}, Angle(), Angle::degrees(30)}, 0.5);
    return std::make_shared<const Rig>(std::move(parts));
}

struct RigFaults : testing::Test {
    void check() {
        window.command("Check the rig");
        ASSERT_TRUE(eventually([&] { return window.findNow<QLabel>("rig.report.looked") != nullptr; },
                               std::chrono::seconds(60)));
    }
    [[nodiscard]] std::vector<glm::vec3> seen() {
        const auto& scene = window.find<ViewportWidget>("rig.viewport")->scene();
        std::vector<glm::vec3> all;
        for (const ViewportSurface& surface : scene->surfaces)
            if (surface.positions->size() == window.state().rig.rig->restMesh().positions.size())
                all = *surface.positions;
        return all;
    }
    [[nodiscard]] std::vector<glm::vec3> at(const std::vector<double>& strokes) {
        return deformed(*window.state().rig.rig, strokes).positions;
    }
    [[nodiscard]] std::vector<glm::vec3> asItStands() { return *window.studio().loop.frame()->devicePositions; }
    [[nodiscard]] bool isMarked() {
        const auto& lines = window.find<ViewportWidget>("rig.viewport")->scene()->lines;
        return std::ranges::any_of(lines, [](const ViewportLine& line) { return line.onTop; });
    }

    TemporaryFolder folder;
    test::StudioWindow window{folder / "session", "rig"};
};

TEST_F(RigFaults, AClickOnARowShowsTheStateAndChoosesTheActuator) {
    window.studio().project.takeRig(faultyRig(), "a device");
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig->name() == "faulty"; }));
    window.window().findChild<QDockWidget*>("dock.rig.report")->raise();
    check();
    // The graver comes first.
    EXPECT_TRUE(window.find<QAbstractButton>("rig.finding.0")->accessibleName().startsWith("'left' runs into"));
    EXPECT_TRUE(window.find<QAbstractButton>("rig.finding.1")->accessibleName().startsWith("'right' moves a point at"));
    EXPECT_EQ(window.findNow<QAbstractButton>("rig.finding.2"), nullptr);
    window.screenshot("rig_faults");
    ASSERT_TRUE(eventually([&] { return seen() == asItStands(); }));
    const auto strokes = window.state().strokes;
    const ViewCamera before = window.find<ViewportWidget>("rig.viewport")->camera();

    window.click("rig.finding.0");
    EXPECT_TRUE(eventually([&] { return seen() == at({0.0, 1.0}); }));
    EXPECT_TRUE(isMarked());
    EXPECT_EQ(window.find<QListWidget>("rig.list")->currentRow(), 1);
    EXPECT_EQ(window.state().strokes, strokes) << "in the view alone";
    EXPECT_TRUE(window.text("rig.finding.remedy").contains("'left' end at 9.6 degrees"));
    ASSERT_TRUE(eventually([&] { return window.find<ViewportWidget>("rig.viewport")->camera().pivot.x < -0.02F; }))
        << "it looks at " << window.find<ViewportWidget>("rig.viewport")->camera().pivot.x << ", before at "
        << before.pivot.x;
    EXPECT_FALSE(window.find<ViewportWidget>("rig.viewport")->camera() == before);
    window.screenshot("rig_fault_shown", std::chrono::milliseconds(800)); // the view turns and glides

    // The keyboard does the same; then the device is seen as it stands.
    auto* second = window.find<QAbstractButton>("rig.finding.1");
    second->setFocus();
    QTest::keyClick(second, Qt::Key_Return);
    EXPECT_EQ(window.find<QListWidget>("rig.list")->currentRow(), 0);
    EXPECT_FALSE(window.find<QAbstractButton>("rig.finding.0")->isChecked());
    EXPECT_TRUE(second->isChecked());
    window.click("rig.finding.back");
    EXPECT_TRUE(eventually([&] { return seen() == asItStands(); }));
    EXPECT_FALSE(isMarked());
    EXPECT_FALSE(second->isChecked());

    // What is allowed is the user's to say; with it, and a range that ends before, there is nothing left.
    window.enter("rig.maxSpeed", "1");
    ASSERT_TRUE(eventually(
        [&] {
            return window.findNow<QAbstractButton>("rig.finding.1") == nullptr &&
                   window.findNow<QAbstractButton>("rig.finding.0") != nullptr;
        },
        std::chrono::seconds(30)));
    editRig(window.studio().document, "Narrow",
            [](RigParts& parts) { setRange(parts.actuators[1], 0.0, Angle::degrees(9.5).inRadians()); });
    ASSERT_TRUE(eventually([&] { return window.findNow<QLabel>("rig.report.looked") == nullptr; }))
        << "what was found is of another shape";
    ASSERT_TRUE(eventually([&] { return window.state().rig.compiled; }));
    check();
    EXPECT_EQ(window.findNow<QAbstractButton>("rig.finding.0"), nullptr);
    EXPECT_TRUE(window.text("rig.report.title").startsWith("The rig is a clean solid"));
}

} // namespace
} // namespace lumorph::studio
