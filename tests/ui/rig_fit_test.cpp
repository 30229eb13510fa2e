#include <gtest/gtest.h>

#include <algorithm>

#include <QComboBox>
#include <QStackedWidget>

#include "app/studio/document/rig_edit.h"
#include "app/studio/widgets/plot.h"
#include "app/workspaces/rig/target_tiles.h"
#include "core/base/resources.h"
#include "core/mdf/target_library.h"
#include "core/rig/templates/rig_templates.h"
#include "tests/support/small_rigs.h"
#include "tests/ui/studio_window.h"

namespace lumorph::studio {
namespace {

using test::eventually;

constexpr const char* kStale = "Of the rig before your edit";

/// A low slab that one actuator raises into the mesh itself.
std::shared_ptr<const Rig> rigThatBecomes(const TriangleMesh& mesh) {
    RigParts parts;
    parts.name = "becomes it";
    parts.restMesh = mesh;
    parts.pathInside = true;
    Actuator actuator;
    actuator.name = "raise";
    MorphTarget raise{"raised", {1.0F}, {{}}};
    const float bottom = boundingBox(mesh.positions).min.y;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const float height = mesh.positions[v].y - bottom;
        if (height <= 0.0F) continue;
        parts.restMesh.positions[v].y = bottom + 0.1F * height;
        actuator.influences.push_back({v, 1.0F});
        raise.displacements[0].push_back({0.0F, 0.9F * height, 0.0F});
    }
    actuator.deformer = std::move(raise);
    parts.actuators.push_back(std::move(actuator));
    return std::make_shared<const Rig>(std::move(parts));
}

struct RigFit : testing::Test {
    [[nodiscard]] std::vector<TargetTile*> tiles() {
        auto found = window.window().findChildren<TargetTile*>();
        return {found.begin(), found.end()};
    }
    [[nodiscard]] TargetTile* tile(const std::string& name) {
        return window.find<TargetTile>("rig.fit.target." + QString::fromStdString(name));
    }
    [[nodiscard]] QString said() { return window.text("rig.fit.state"); }
    /// Until the fine fit of the rig as it is now is shown, and what follows it.
    [[nodiscard]] bool isNew() {
        return eventually(
            [&] {
                const auto* state = window.findNow<QLabel>("rig.fit.state");
                return state && state->text().isEmpty() && !tiles().empty() && window.state().rig.compiled &&
                       !window.findNow<Plot>("rig.fit.steps")->curves().empty() && !isWorking();
            },
            std::chrono::seconds(60));
    }
    [[nodiscard]] bool isWorking() {
        return std::ranges::any_of(window.studio().jobs.running(),
                                   [](const auto& job) { return job.place == "rig.fit"; });
    }
    void takeRig(const std::shared_ptr<const Rig>& rig) {
        window.studio().project.takeRig(rig, "a device");
        ASSERT_TRUE(eventually([&] { return window.state().rig.rig == rig; }));
    }
    [[nodiscard]] std::vector<glm::vec3> seen() {
        const auto& scene = window.find<ViewportWidget>("rig.viewport")->scene();
        return scene && !scene->surfaces.empty() ? *scene->surfaces.front().positions : std::vector<glm::vec3>();
    }
    [[nodiscard]] std::vector<glm::vec3> deformed(const std::vector<double>& strokes) {
        const Rig& rig = *window.state().rig.rig;
        std::vector<glm::vec3> positions(rig.restMesh().positions.size());
        rig.deform(strokes, positions);
        return positions;
    }

    TemporaryFolder folder;
    test::StudioWindow window{folder / "session", "rig"};
};

TEST_F(RigFit, FollowsTheRigAndShowsEachShape) {
    // The tablet: an edit makes what is shown stale, then new; a sheet that hardly rises fits worse.
    ASSERT_TRUE(isNew());
    EXPECT_EQ(tiles().size(), readTargetLibrary(resourcesFolder() / "targets").size());
    const QString verdict = window.text("rig.fit.verdict");
    const int bloom = tile("bloom")->percent();
    const std::size_t actuators = window.state().rig.rig->actuatorCount();
    EXPECT_EQ(window.find<Plot>("rig.fit.steps")->curves().front().values.size(), actuators + 1);
    window.screenshot("rig_fit");
    QElapsedTimer since;
    since.start();
    editRig(window.studio().document, "Lower all", [](RigParts& parts) {
        for (glm::vec3& mode : parts.sheet->modes.modes) mode *= 0.1F;
    });
    EXPECT_EQ(said(), kStale);
    ASSERT_TRUE(eventually([&] { return said() != kStale; }));
    std::printf("the coarse fit came %lld ms after the edit\n", static_cast<long long>(since.elapsed()));
    ASSERT_TRUE(isNew());
    EXPECT_NE(window.text("rig.fit.verdict"), verdict);
    EXPECT_LT(tile("bloom")->percent(), bloom);
    window.studio().document.undoStack().undo();
    ASSERT_TRUE(isNew());
    EXPECT_EQ(window.text("rig.fit.verdict"), verdict);

    // A click shows the shape in the view alone; a button moves the device there. Not of the bloom, which it follows:
    // it may stand just so.
    const auto before = window.state();
    const auto asItStands = seen();
    window.click("rig.fit.target.stairs");
    EXPECT_TRUE(window.text("rig.fit.tried").contains("stays unmatched"));
    ASSERT_TRUE(eventually([&] { return seen() != asItStands; }));
    test::pass(std::chrono::seconds(1));
    const auto shown = seen();
    EXPECT_EQ(window.state().strokes, before.strokes);
    window.click("rig.fit.takeButton");
    EXPECT_EQ(window.state().matching.driver, Driver::hand);
    EXPECT_EQ(deformed(window.state().strokes), shown);
    window.studio().document.undoStack().undo();
    EXPECT_EQ(window.state().strokes, before.strokes);
    window.click("rig.fit.back");
    EXPECT_EQ(window.findNow<QLabel>("rig.fit.tried"), nullptr);

    // Another device below each of this one's figures.
    const QString area = window.text("rig.metric.area.physical");
    auto* reference = window.find<QComboBox>("rig.fit.reference");
    reference->setCurrentIndex(reference->findText("tablet"));
    ASSERT_NE(window.find<QLabel>("rig.metric.area.compared.physical"), nullptr);
    EXPECT_EQ(window.text("rig.metric.area.compared.physical"), area) << "the demo's device is that tablet";
    window.screenshot("rig_fit_compared");
    reference->setCurrentIndex(0);

    // A device made from a target's own shape takes that one on best, at full stroke.
    for (const LibraryTarget& target : readTargetLibrary(resourcesFolder() / "targets")) {
        if (target.name != "stairs" && target.name != "twist") continue;
        takeRig(rigThatBecomes(target.target.mesh));
        ASSERT_TRUE(isNew()) << target.name;
        EXPECT_GE(tile(target.name)->percent(), 97) << target.name;
        for (const TargetTile* other : tiles())
            EXPECT_LE(other->percent(), tile(target.name)->percent()) << other->text().toStdString();
        window.click("rig.fit.target." + QString::fromStdString(target.name));
        window.click("rig.fit.takeButton");
        EXPECT_NEAR(window.state().strokes.at(0), 1.0, 0.04) << target.name;
    }

    // Out of sight nothing is worked out.
    window.window().showWorkspace("field");
    takeRig(std::make_shared<const Rig>(rigOf(rigTemplate("phone"), {})));
    EXPECT_FALSE(eventually([&] { return isWorking(); }, std::chrono::seconds(1)));
    window.window().showWorkspace("rig");
    ASSERT_TRUE(isNew());

    RigParts blank;
    blank.name = "blank";
    blank.restMesh = test::boxMesh({0.0F, 0.0F, 0.0F}, {0.2F, 0.01F, 0.1F});
    takeRig(std::make_shared<const Rig>(std::move(blank)));
    EXPECT_EQ(window.find<QStackedWidget>("rig.fit.pages")->currentIndex(), 1);
    EXPECT_FALSE(isWorking());
}

} // namespace
} // namespace lumorph::studio
