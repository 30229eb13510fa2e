#include "app/workspaces/field/story_export.h"

#include <filesystem>

#include <QComboBox>
#include <QImage>
#include <QLabel>
#include <QPushButton>
#include <QRegularExpression>
#include <QSlider>
#include <QTest>
#include <gtest/gtest.h>

#include <opencv2/videoio.hpp>

#include "app/studio/look/palette.h"
#include "app/workspaces/field/story_canvas.h"
#include "app/workspaces/field/story_painter.h"
#include "core/base/resources.h"
#include "core/mdf/builder.h"
#include "core/mdf/ramp.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/small_rigs.h"
#include "tests/ui/file_dialog.h"
#include "tests/ui/studio_window.h"

namespace lumorph::studio {
namespace {

using namespace std::chrono_literals;
using test::eventually;

/// Someone who wants to know, before the tablet and the dunes.
struct FieldStory : testing::Test {
    void openStory() {
        window.command("How the field works");
        ASSERT_TRUE(eventually([&] { return window.findNow<StoryCanvas>("story.canvas") != nullptr && told(); }, 120s));
        canvas = window.find<StoryCanvas>("story.canvas");
        dialog = window.findNow<QDialog>("story.window");
        ASSERT_NE(dialog, nullptr);
    }
    [[nodiscard]] bool told() {
        auto* text = window.findNow<QLabel>("story.text");
        return text && !text->text().isEmpty() && window.studio().jobs.running().empty();
    }
    [[nodiscard]] QString text() { return window.text("story.text"); }
    [[nodiscard]] const MatchField& field() { return *window.state().field.field; }
    [[nodiscard]] int value(const char* slider) { return window.find<QSlider>(slider)->value(); }
    [[nodiscard]] VoxelPlane plane() {
        return {window.find<QComboBox>("story.side")->currentIndex() == 0 ? 2 : 0, value("story.plane")};
    }
    /// All levels were run through, so that nothing moves by itself any more.
    [[nodiscard]] bool atRest() {
        auto* run = window.findNow<QAbstractButton>("story.run");
        return eventually([&] { return run && !run->isChecked() && value("story.level") == field().field.levels - 1; });
    }
    /// The share of voxels of the plane whose middles have the colour that they should have; an outline runs over some.
    [[nodiscard]] double painted(const std::function<QColor(const glm::ivec3&)>& expected, int& coloured) {
        const QImage picture = canvas->grab().toImage();
        const double ratio = picture.devicePixelRatio();
        const StoryLayout layout = canvas->layoutNow();
        const glm::ivec3 size = field().field.frame.dimensions;
        const glm::ivec2 extent = sizeOf(plane(), size);
        int right = 0;
        coloured = 0;
        for (int across = 0; across < extent.x; ++across)
            for (int up = 0; up < extent.y; ++up) {
                const QColor color = expected(voxelOf(plane(), size, {across, up}));
                const QPointF middle = layout.pixel(glm::dvec2(across, up) + 0.5) * ratio;
                right += picture.pixelColor(middle.toPoint()) == color ? 1 : 0;
                coloured += color != currentPalette().sunken ? 1 : 0;
            }
        return static_cast<double>(right) / (extent.x * extent.y);
    }
    /// Voxels of the target where the document says that it stands.
    [[nodiscard]] BitColumns targetNow() {
        const MatchTarget& target = *window.state().target.target;
        const Target standing{placed(target.solid.mesh, window.state().placement), target.solid.closed, {}};
        SolidVoxelizer voxelizer;
        BitColumns wanted;
        voxelizeTarget(field().field.frame, standing, voxelizer, wanted);
        wanted &= field().coverage.domain();
        return wanted;
    }
    /// The IoU of V(votes) with these voxels.
    [[nodiscard]] double votedIou(const BitColumns& wanted) {
        BitColumns covered;
        CoverageScratch scratch;
        field().coverage.covered(field().voting.match(wanted).state(), covered, scratch);
        return intersectionOverUnion(covered, wanted);
    }
    [[nodiscard]] QColor level(int of) const {
        const double share = static_cast<double>(of) / (window.state().field.field->field.levels - 1);
        return blend(currentPalette().levelLow, currentPalette().levelHigh, share);
    }
    [[nodiscard]] QColor body() const { return blend(currentPalette().sunken, currentPalette().textMuted, 0.45); }
    [[nodiscard]] static QString number(std::size_t count) {
        return QLocale(QLocale::English).toString(static_cast<qulonglong>(count));
    }
    /// The numbers in a sentence that are followed by a sign of percent.
    [[nodiscard]] static std::vector<double> percents(const QString& sentence) {
        std::vector<double> found;
        auto all = QRegularExpression(R"(([0-9.]+) %)").globalMatch(sentence);
        while (all.hasNext()) found.push_back(all.next().captured(1).toDouble());
        return found;
    }

    TemporaryFolder folder;
    test::StudioWindow window{folder.path()};
    StoryCanvas* canvas = nullptr;
    QDialog* dialog = nullptr;
};

TEST_F(FieldStory, IsWalkedThroughByMouseAndKeysWithThePicturesAndNumbersOfTheField) {
    window.studio().project.openTarget(resourceFile("targets/dunes.glb"));
    // It glides to where it matches best.
    ASSERT_TRUE(eventually([&] { return window.studio().project.autoPlaced(); }, 60s));
    openStory();
    const Field& mdf = field().field;
    const Coverage& coverage = field().coverage;
    const std::size_t actuators = mdf.actuators.size();
    int coloured = 0;

    // 1: a state, by the slider's keys.
    ASSERT_TRUE(atRest());
    auto* slider = window.find<QSlider>("story.level");
    slider->setFocus();
    for (int k = 0; k < 6; ++k) QTest::keyClick(slider, Qt::Key_Left);
    const int chosen = slider->value();
    EXPECT_EQ(chosen, mdf.levels - 7);
    State state(actuators);
    state[0] = Level{chosen};
    BitColumns covered;
    CoverageScratch scratch;
    coverage.covered(state, covered, scratch);
    EXPECT_TRUE(text().contains(number(covered.count()))) << text().toStdString();
    EXPECT_GT(painted(
                  [&](const glm::ivec3& v) {
                      if (mdf.body.test(v.x, v.y, v.z)) return body();
                      return covered.test(v.x, v.y, v.z) ? level(chosen) : currentPalette().sunken;
                  },
                  coloured),
              0.93);
    EXPECT_GT(coloured, 200);
    window.screenshot("story-1");

    // 2: its field, by an arrow key.
    window.find<QPushButton>("story.next")->setFocus();
    QTest::keyClick(dialog, Qt::Key_Right);
    ASSERT_TRUE(atRest());
    const std::vector<Ramp> ramps = denseRamps(mdf, 0);
    EXPECT_GT(painted(
                  [&](const glm::ivec3& v) {
                      if (mdf.body.test(v.x, v.y, v.z)) return body();
                      const Ramp& ramp = ramps[mdf.voxelIndex(v.x, v.y, v.z)];
                      return ramp.v0 != kUnchanged ? level(ramp.v0) : currentPalette().sunken;
                  },
                  coloured),
              0.93);
    window.screenshot("story-2");

    // 3: all of them, by the button; the cut moved by the wheel.
    window.click("story.next");
    EXPECT_TRUE(text().contains(number(reachableVoxels(mdf).count()))) << text().toStdString();
    EXPECT_FALSE(text().contains("being counted"));
    const int before = value("story.plane");
    QWheelEvent wheel(canvas->rect().center(), canvas->mapToGlobal(canvas->rect().center()), {}, {0, 120}, Qt::NoButton,
                      Qt::NoModifier, Qt::NoScrollPhase, false);
    QCoreApplication::sendEvent(canvas, &wheel);
    EXPECT_EQ(value("story.plane"), before + 1);
    window.screenshot("story-3");

    // 4: the target.
    QTest::keyClick(dialog, Qt::Key_PageDown);
    window.screenshot("story-4");
    EXPECT_TRUE(text().contains("dunes")) << text().toStdString();

    // 5: the votes; another actuator by a click on its chart.
    window.click("story.step.5");
    const QPointF chart = canvas->layoutNow().charts.back().center();
    QTest::mouseClick(canvas, Qt::LeftButton, {}, chart.toPoint());
    EXPECT_EQ(window.find<QComboBox>("story.actuator")->currentIndex(), static_cast<int>(actuators) - 1);
    const BitColumns wanted = targetNow();
    const Votes votes = field().voting.match(wanted);
    const ActuatorVote& last = votes.actuators.back();
    ASSERT_TRUE(last.reached);
    EXPECT_TRUE(text().contains(QString("level %1 is best").arg(last.level.index)))
        << text().toStdString() << " turned by " << window.studio().loop.frame()->turned.inDegrees();
    window.screenshot("story-5");

    // 6: the fit.
    QTest::keyClick(dialog, Qt::Key_PageDown);
    const std::vector<double> ious = percents(text());
    ASSERT_EQ(ious.size(), 2U) << text().toStdString();
    EXPECT_NEAR(ious[0], 100.0 * votedIou(wanted), 0.06);
    EXPECT_GE(ious[1], ious[0]);
    auto* view = window.find<ViewportWidget>("story.view");
    EXPECT_TRUE(eventually([&] { return view->scene() && view->scene()->tint; })) << "device and target meet in colour";
    window.screenshot("story-6");
    EXPECT_FALSE(canvas->accessibleDescription().isEmpty());

    // A target that is dragged takes the story with it.
    window.studio().document.preview([](StudioState& moved) { moved.placement.scale *= 0.8; });
    window.studio().document.commitPreview("Size the target");
    const double smaller = 100.0 * votedIou(targetNow());
    EXPECT_GT(std::abs(smaller - ious[0]), 0.5);
    EXPECT_TRUE(eventually([&] { return std::abs(percents(text())[0] - smaller) < 0.06; }, 20s))
        << text().toStdString() << smaller;

    // Esc leaves, and stops nothing.
    QTest::keyClick(dialog, Qt::Key_Escape);
    EXPECT_FALSE(dialog->isVisible());
    EXPECT_FALSE(window.studio().loop.stopped());
}

TEST_F(FieldStory, BuildsAFieldThatIsMissingAndThenTellsOfIt) {
    ASSERT_TRUE(eventually([&] { return window.state().field.field && window.studio().jobs.running().empty(); }, 30s));
    window.studio().document.change("Without a field", [](StudioState& state) { state.field = {}; });
    openStory();
    ASSERT_NE(window.state().field.field, nullptr);
    EXPECT_TRUE(text().contains("levels"));
}

TEST_F(FieldStory, AStepIsExportedAsAPicture) {
    openStory();
    window.click("story.picture");
    auto* dialogOfPicture = window.find<QDialog>("export.picture.dialog");
    ASSERT_NE(dialogOfPicture, nullptr);
    window.click("export.picture.accept");
    const std::filesystem::path file = folder.path() / "step.png";
    test::answerFileDialog(window, "export.story.picture.file", file);
    ASSERT_TRUE(eventually([&] { return std::filesystem::exists(file); }, 30s));
    const QImage page(QString::fromStdString(file.string()));
    EXPECT_EQ(page.size(), QSize(1920, 1080));
    const QRect beside = viewOnPage(page.size());
    EXPECT_NE(page.pixelColor(beside.center()), page.pixelColor(2, 2)) << "the view is on it";
}

/// A story of three actuators that is told without a window.
StoryShot cushionShot() {
    const auto field = std::make_shared<const MatchField>(
        buildField(test::cushionRig(), {.resolution = 12, .levels = 5, .samples = 8, .seed = 3, .threads = 1}));
    StoryShot shot;
    shot.picture.story = makeStory(field, {});
    shot.picture.reach = std::make_shared<const JointReach>(jointReach(field->coverage));
    return shot;
}

TEST(FieldStoryVideo, HoldsEveryStepThatCanBeTold) {
    const StoryShot shot = cushionShot();
    const PictureStyle style{{320, 180}, Theme::light, true, false};
    int painted = 0;
    const Painter plain = [&](const FrameRequest& request, const Progress&) {
        ++painted;
        EXPECT_EQ(request.pixels, viewOnPage(style.size).size());
        QImage image(request.pixels, QImage::Format_RGB32);
        image.fill(Qt::darkGray);
        return image;
    };
    const std::vector<StoryFrames> frames = storyFrames(shot.picture, 30.0);
    int expected = 0;
    for (const StoryFrames& one : frames) {
        expected += one.frames;
        EXPECT_LE(one.view.step, StoryStep::all) << "there is no target";
    }
    TemporaryFolder folder;
    writeStory(shot, style, plain, folder.path() / "story.mp4");
    EXPECT_EQ(painted, static_cast<int>(frames.size()));
    cv::VideoCapture video((folder.path() / "story.mp4").string(), cv::CAP_FFMPEG);
    EXPECT_EQ(static_cast<int>(video.get(cv::CAP_PROP_FRAME_COUNT)), expected);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(writeStory(shot, style, plain, folder.path() / "none.mp4", Progress({}, stop.get_token())), Cancelled);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "none.mp4"));
}

} // namespace
} // namespace lumorph::studio
