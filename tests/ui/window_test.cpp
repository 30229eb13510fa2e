#include <fstream>

#include <QAbstractButton>
#include <QApplication>
#include <QFileDialog>
#include <QImage>
#include <QLineEdit>
#include <QPointer>
#include <QProcess>

#include "app/workspaces/common/field_scene.h"
#include "core/base/resources.h"
#include "core/geometry/mesh_file.h"
#include "core/mdf/coverage.h"
#include "tests/ui/file_dialog.h"
#include "tests/ui/studio_window.h"

// The studio as its user has it: the real window, driven by mouse and keys.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;
using studio::StudioState;

/// Spot where it is there; else the bundled dunes.
std::filesystem::path someModel() {
    const std::filesystem::path spot = std::filesystem::path(LUMORPH_SHARED_DIR) / "data/meshes/spot.obj";
    return std::filesystem::exists(spot) ? spot : resourceFile("targets/dunes.glb");
}

/// IoU of the state a frame asks for with the target where the document has it, from the voxels alone.
double iouByHand(const StudioState& state, const State& wanted) {
    const MatchField& field = *state.field.field;
    const Target target{
        placed(state.target.target->solid.mesh, state.placement), state.target.target->solid.closed, {}};
    SolidVoxelizer voxelizer;
    BitColumns goal, covered;
    voxelizeTarget(field.field.frame, target, voxelizer, goal);
    CoverageScratch scratch;
    field.coverage.covered(wanted, covered, scratch);
    std::size_t both = 0, either = 0;
    const glm::ivec3 size = field.field.frame.dimensions;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                if (field.field.body.test(x, y, z)) continue;
                const bool wants = goal.test(x, y, z), has = covered.test(x, y, z);
                both += wants && has;
                either += wants || has;
            }
    return either == 0 ? 1.0 : static_cast<double>(both) / static_cast<double>(either);
}

/// Share of pixels that differ clearly.
double difference(const QImage& a, const QImage& b) {
    if (a.size() != b.size()) return 1.0;
    int differing = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            const QRgb p = a.pixel(x, y), q = b.pixel(x, y);
            differing +=
                std::abs(qRed(p) - qRed(q)) + std::abs(qGreen(p) - qGreen(q)) + std::abs(qBlue(p) - qBlue(q)) > 48;
        }
    return static_cast<double>(differing) / (a.width() * a.height());
}

bool matchesTarget(StudioWindow& window, const std::string& name) {
    return eventually([&] {
        const auto& frame = window.studio().loop.frame();
        return frame && frame->matched && frame->target && frame->target->name == name &&
               window.studio().jobs.running().empty();
    });
}

class Window : public ::testing::Test {
protected:
    [[nodiscard]] std::filesystem::path session() const { return folder_ / "session"; }
    TemporaryFolder folder_;
};

// R14, R15, R42: what a new user does first, from the start to the next day.
TEST_F(Window, FirstHour) {
    StudioState kept;
    {
        StudioWindow window(session());
        auto& document = window.studio().document;
        ASSERT_TRUE(eventually([&] { return window.studio().loop.matchRate() > 0.0; })) << "the demo is not matched";
        window.screenshot("1-start");

        // A model is dropped, matched, and seen.
        const std::filesystem::path model = someModel();
        window.drop(model);
        ASSERT_TRUE(matchesTarget(window, model.stem().string()));
        ASSERT_TRUE(window.settles());
        ASSERT_TRUE(eventually([&] {
            return window.text("match.iou") ==
                   QString::number(iouByHand(window.state(), window.studio().loop.frame()->wanted), 'f', 2);
        })) << window.text("match.iou").toStdString();
        window.screenshot("2-dropped");
        const QImage withTarget = window.view().frameImage();

        // The rig's state by hand: one slider, one step of undo, and the match lets go.
        const int steps = document.undoStack().index();
        const double before = window.studio().loop.frame()->wantedStrokes[0];
        const double to = before < 0.5 ? 0.9 : 0.1;
        window.slide("actuators.slider.0", to);
        EXPECT_EQ(window.state().matching.driver, Driver::hand);
        EXPECT_NEAR(window.state().strokes[0], to, 0.04);
        EXPECT_EQ(document.undoStack().index(), steps + 1);
        ASSERT_TRUE(
            eventually([&] { return std::abs(window.studio().loop.frame()->estimatedStrokes[0] - to) < 0.05; }));
        ASSERT_TRUE(window.settles());
        EXPECT_GT(difference(withTarget, window.view().frameImage()), 0.005) << "the view does not show the new state";
        window.screenshot("3-by-hand");

        // A finer field.
        const auto coarse = window.state().field.field;
        window.command("build the field");
        window.enter("field.build.resolution", "48", Qt::Key_Tab);
        window.click("field.build.accept");
        ASSERT_TRUE(eventually([&] { return window.state().field.field != coarse; }, 240s))
            << "the field was not built";
        const auto finer = window.state().field.field;
        EXPECT_EQ(finer->field.frame.dimensions.y, 48);
        ASSERT_TRUE(window.settles());
        window.screenshot("4-finer");

        // One that takes long, cancelled: nothing changes.
        const int built = document.undoStack().index();
        window.command("build the field");
        window.enter("field.build.samples", "4096", Qt::Key_Tab);
        window.enter("field.build.resolution", "150", Qt::Key_Tab);
        window.click("field.build.accept");
        window.screenshot("5-building");
        window.click("job.cancel");
        ASSERT_TRUE(eventually([&] { return window.studio().jobs.running().empty(); }));
        EXPECT_EQ(window.state().field.field, finer);
        EXPECT_EQ(document.undoStack().index(), built);

        // A picture.
        const std::filesystem::path picture = folder_ / "picture.png";
        window.command("export a picture");
        window.screenshot("6-export");
        window.click("export.picture.accept");
        answerFileDialog(window, "export.picture.file", picture);
        ASSERT_TRUE(eventually([&] { return std::filesystem::exists(picture); }));
        const QImage written(QString::fromStdString(picture.string()));
        EXPECT_GE(written.width(), 1920);
        EXPECT_GT(difference(written, QImage(written.size(), QImage::Format_RGB32)), 0.0);

        // Back to the coarse field, the live match and the demo's target, and forth again.
        while (document.undoStack().canUndo()) QTest::keyClick(&window.window(), Qt::Key_Z, Qt::ControlModifier);
        EXPECT_EQ(window.state().field.field, coarse);
        EXPECT_EQ(window.state().matching.driver, Driver::target);
        EXPECT_NE(window.state().target.path, model);
        while (document.undoStack().canRedo())
            QTest::keyClick(&window.window(), Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
        EXPECT_EQ(window.state().field.field, finer);
        kept = window.state();
        ViewCamera looks = window.view().camera();
        looks.yaw = Angle::degrees(-70.0);
        looks.pitch = Angle::degrees(51.0);
        looks.distance *= 0.6;
        window.view().setCamera(looks);
        EXPECT_TRUE(window.window().close());
    }
    StudioWindow again(session());
    EXPECT_EQ(again.state().rig.rig->name(), kept.rig.rig->name());
    EXPECT_EQ(again.state().field.field->field, kept.field.field->field);
    ASSERT_TRUE(again.state().target.target);
    EXPECT_EQ(again.state().target.target->name, kept.target.target->name);
    EXPECT_EQ(again.state().target.target->solid.mesh.triangles, kept.target.target->solid.mesh.triangles);
    EXPECT_EQ(again.state().placement.deviceFromTarget(), kept.placement.deviceFromTarget());
    EXPECT_EQ(again.state().strokes, kept.strokes);
    EXPECT_EQ(again.state().matching, kept.matching);
    EXPECT_EQ(again.state().playback, kept.playback);
    EXPECT_TRUE(again.studio().notices.at().empty());
    EXPECT_TRUE(eventually([&] { return std::abs(again.view().camera().yaw.inDegrees() + 70.0) < 1e-6; }))
        << "one looks from elsewhere: " << again.view().camera().yaw.inDegrees();
    EXPECT_NEAR(again.view().camera().pitch.inDegrees(), 51.0, 1e-6);
    again.screenshot("7-reopened");
}

// Voting is one click away, and says the same as the engine.
TEST_F(Window, VotingIsOneClickAway) {
    StudioWindow window(session());
    window.drop(resourceFile("targets/dunes.glb"));
    ASSERT_TRUE(matchesTarget(window, "dunes"));
    window.click("match.method.voting");
    const auto& field = *window.state().field.field;
    const Target target{placed(window.state().target.target->solid.mesh, window.state().placement), true, {}};
    SolidVoxelizer voxelizer;
    BitColumns goal;
    voxelizeTarget(field.field.frame, target, voxelizer, goal);
    const Votes votes = field.voting.match(goal);
    EXPECT_TRUE(eventually([&] {
        const auto& frame = window.studio().loop.frame();
        return frame->votes && frame->votes->state() == votes.state() && frame->wanted == votes.state();
    }));
    window.click("match.method.refined");
    EXPECT_TRUE(eventually([&] { return window.studio().loop.frame()->statesSeen > 0; }));
}

// Esc-Esc stops from any dock; the actuators stay where they are until one resumes.
TEST_F(Window, EscapeTwiceStops) {
    StudioWindow window(session());
    window.click("actuators.dance");
    ASSERT_TRUE(eventually([&] { return window.studio().loop.frame()->estimatedStrokes[0] > 0.02; }));
    auto* slider = window.find<QWidget>("actuators.slider.2");
    slider->setFocus();
    QTest::keyClick(slider, Qt::Key_Escape);
    QTest::keyClick(slider, Qt::Key_Escape);
    ASSERT_TRUE(eventually([&] { return window.studio().loop.stopped(); }));
    pass(200ms);
    const auto held = window.studio().loop.frame()->estimatedStrokes;
    pass(500ms);
    EXPECT_EQ(window.studio().loop.frame()->estimatedStrokes, held);
    window.click("stop");
    EXPECT_TRUE(window.studio().loop.stopped()) << "only Resume resumes";
    window.click("resume");
    EXPECT_FALSE(window.studio().loop.stopped());
    EXPECT_TRUE(eventually([&] { return window.studio().loop.frame()->estimatedStrokes != held; }));
}

// Clicking the target selects it; its handle drags it by one step of undo, and Esc takes a drag back.
TEST_F(Window, TheGizmoMovesTheTarget) {
    StudioWindow window(session());
    window.drop(resourceFile("targets/dunes.glb"));
    ASSERT_TRUE(matchesTarget(window, "dunes"));
    ASSERT_TRUE(window.settles());
    auto& view = window.view();
    const glm::vec2 size(view.width(), view.height());
    const auto frame = window.studio().loop.frame();
    const Box box = boundingBox(placed(window.state().target.target->solid.mesh, window.state().placement).positions);
    const auto middle = pixelOf(view.camera(), box.centre(), size);
    ASSERT_TRUE(middle);
    QTest::mouseClick(&view, Qt::LeftButton, {}, QPoint(static_cast<int>(middle->x), static_cast<int>(middle->y)));
    ASSERT_TRUE(eventually([&] {
        for (const auto& surface : view.scene()->surfaces)
            if (surface.id == studio::kTargetId && surface.outlined) return true;
        return false;
    })) << "the target is not selected";
    const Placement before = window.state().placement;
    const int steps = window.studio().document.undoStack().index();
    const studio::Gizmo gizmo{before, {box.centre().x, box.min.y, box.centre().z}};
    std::optional<QPoint> handle;
    for (int py = 0; py < view.height() && !handle; py += 2)
        for (int px = 0; px < view.width() && !handle; px += 2)
            if (studio::gizmoAt(gizmo, view.camera(), {px, py}, size, 1.0) == studio::GizmoHandle::moveX)
                handle = QPoint(px, py);
    ASSERT_TRUE(handle);
    const auto drag = [&] {
        QTest::mouseMove(&view, *handle);
        QTest::mousePress(&view, Qt::LeftButton, {}, *handle);
        for (int i = 1; i <= 12; ++i) QTest::mouseMove(&view, *handle + QPoint(4 * i, i));
    };
    drag();
    EXPECT_GT(std::abs(window.state().placement.translation.x - before.translation.x), 0.002F);
    QTest::keyClick(&view, Qt::Key_Escape);
    EXPECT_EQ(window.state().placement.translation, before.translation);
    QTest::mouseRelease(&view, Qt::LeftButton, {}, *handle);
    EXPECT_EQ(window.studio().document.undoStack().index(), steps);
    drag();
    QTest::mouseRelease(&view, Qt::LeftButton, {}, *handle + QPoint(48, 12));
    EXPECT_GT(std::abs(window.state().placement.translation.x - before.translation.x), 0.002F);
    EXPECT_EQ(window.state().placement.translation.z, before.translation.z);
    EXPECT_EQ(window.studio().document.undoStack().index(), steps + 1);
    QTest::keyClick(&window.window(), Qt::Key_Z, Qt::ControlModifier);

    const double x = window.state().placement.translation.x;
    EXPECT_NEAR(x, before.translation.x, 1e-6);
    window.enter("target.x", QString::number(100.0 * x + 1.5) + " cm");
    EXPECT_NEAR(window.state().placement.translation.x, x + 0.015, 1e-4);
    EXPECT_TRUE(eventually([&] { return window.studio().loop.frame() != frame; }));
    QTest::keyClick(&window.window(), Qt::Key_Z, Qt::ControlModifier);
    EXPECT_NEAR(window.state().placement.translation.x, x, 1e-6);
}

// Whatever is dropped: said in the window, with a remedy, and what was open stays.
TEST_F(Window, BrokenFilesChangeNothing) {
    StudioWindow window(session());
    const auto write = [&](const std::string& name, const std::string& text) {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    };
    std::string truncated;
    {
        std::ifstream whole(resourceFile("models/tablet.glb"), std::ios::binary);
        truncated.assign(std::istreambuf_iterator<char>(whole), {});
        truncated.resize(truncated.size() / 2);
    }
    const std::vector<std::filesystem::path> files{
        write("words.obj", "this is no mesh\n"),
        write("index.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9\n"),
        write("half.glb", truncated),
        write("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        write("old.mdf", "LUMORPH"),
        write("newer.lumorph", R"({"schemaVersion": 99, "rig": "x.glb"})"),
        write("picture.jpg", "\xFF\xD8\xFF"),
        write("empty.stl", ""),
        folder_ / "missing.obj",
    };
    const StudioState before = window.state();
    const int steps = window.studio().document.undoStack().count();
    for (const auto& file : files) {
        SCOPED_TRACE(file.filename());
        window.drop(file);
        EXPECT_TRUE(eventually([&] {
            for (const auto& notice : window.studio().notices.at())
                if ((notice.subject + notice.why).contains(QString::fromStdString(file.filename().string())))
                    return !notice.why.isEmpty() && !notice.remedy.isEmpty() && window.studio().jobs.running().empty();
            return false;
        }));
        EXPECT_EQ(window.state().target.target, before.target.target);
        EXPECT_EQ(window.state().field.field, before.field.field);
        EXPECT_EQ(window.state().rig.rig, before.rig.rig);
    }
    EXPECT_EQ(window.studio().document.undoStack().count(), steps);
    EXPECT_NE(window.findNow<QWidget>("notice"), nullptr) << "no notice is in sight";
    window.screenshot("broken");
    // The remedy is a button.
    EXPECT_NE(window.findNow<QAbstractButton>("notice.action.0"), nullptr);
}

// A mesh with holes is taken, with a warning.
TEST_F(Window, AnOpenMeshIsTakenWithAWarning) {
    StudioWindow window(session());
    TriangleMesh mesh = readMesh(resourceFile("targets/dunes.glb"));
    mesh.triangles.resize(mesh.triangles.size() * 9 / 10);
    writeMesh(mesh, folder_ / "holes.obj");
    window.drop(folder_ / "holes.obj");
    ASSERT_TRUE(matchesTarget(window, "holes"));
    EXPECT_FALSE(window.state().target.target->warnings.empty());
    EXPECT_GT(window.studio().loop.frame()->iouWanted, 0.05);
}

// GL below 4.1: a page with the version found, and the rest of the window works.
TEST_F(Window, OldOpenGlIsSaidOnAPage) {
    if (qEnvironmentVariable("MESA_GL_VERSION_OVERRIDE") != "3.3") {
        QProcess again;
        QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
        environment.insert("MESA_GL_VERSION_OVERRIDE", "3.3");
        environment.insert("MESA_GLSL_VERSION_OVERRIDE", "330");
        again.setProcessEnvironment(environment);
        again.start(QCoreApplication::applicationFilePath(), {"--gtest_filter=Window.OldOpenGlIsSaidOnAPage"});
        ASSERT_TRUE(again.waitForFinished(120000));
        EXPECT_EQ(again.exitCode(), 0) << again.readAllStandardOutput().toStdString();
        return;
    }
    StudioWindow window(session());
    EXPECT_TRUE(window.text("viewport.failure.reason").contains("3.3"));
    EXPECT_NE(window.findNow<QAbstractButton>("viewport.retry"), nullptr);
    window.screenshot("no-gl");
    window.slide("actuators.slider.0", 0.5); // the match and the docks go on without a picture
    EXPECT_NEAR(window.state().strokes[0], 0.5, 0.05);
}

} // namespace
} // namespace lumorph::test
