#include <cmath>
#include <fstream>
#include <mutex>

#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QComboBox>
#include <QLineEdit>
#include <QListWidget>

#include "app/workspaces/field/pose_timeline.h"
#include "core/motion/rig_motion.h"
#include "tests/ui/file_dialog.h"
#include "tests/ui/studio_window.h"

namespace lumorph::studio {
namespace {

using test::eventually;
using test::StudioWindow;

const PoseSequence& sequenceOf(const StudioWindow& window) { return window.state().poses->sequence; }

/// Sliders to levels by the mouse, then the pose is kept and its name is typed.
void keepPoseByHand(StudioWindow& window, const std::vector<double>& shares, const QString& name) {
    for (std::size_t k = 0; k < shares.size(); ++k) window.slide(QString("actuators.slider.%1").arg(k), shares[k]);
    window.click("actuators.keep");
    auto* list = window.find<QListWidget>("poses.list");
    ASSERT_TRUE(list);
    ASSERT_TRUE(eventually([&] { return list->findChild<QLineEdit*>() != nullptr; }));
    auto* editor = list->findChild<QLineEdit*>();
    QTest::keyClick(editor, Qt::Key_A, Qt::ControlModifier);
    QTest::keyClicks(editor, name);
    QTest::keyClick(editor, Qt::Key_Return);
    // The list takes the name over when the event loop comes round.
    ASSERT_TRUE(eventually([&] { return sequenceOf(window).poses.back().name == name.toStdString(); }));
    ASSERT_TRUE(eventually([&] { return list->findChild<QLineEdit*>() == nullptr; }));
    ASSERT_EQ(sequenceOf(window).poses.back().strokes, window.state().strokes);
}

void addStep(StudioWindow& window, int pose) {
    auto* list = window.find<QListWidget>("poses.list");
    QTest::mouseClick(list->viewport(), Qt::LeftButton, {}, list->visualItemRect(list->item(pose)).center());
    window.click("poses.addStep");
}

void dragStep(PoseTimeline& timeline, int from, int to) {
    const QPoint begin = timeline.boxOf(from).center();
    const QRect box = timeline.boxOf(to);
    const QPoint end(to > from ? box.right() - 2 : box.left() + 2, begin.y());
    QTest::mousePress(&timeline, Qt::LeftButton, {}, begin);
    for (int k = 1; k <= 10; ++k) QTest::mouseMove(&timeline, begin + (end - begin) * k / 10);
    QTest::mouseRelease(&timeline, Qt::LeftButton, {}, end);
}

/// What the loop's frames ask of the actuators, each with its time of the sequence; taken in the loop's thread.
class Watched {
public:
    explicit Watched(StudioLoop& loop) : loop_(loop) {
        id_ = loop.addTap([this](const MatchFrame& frame) {
            const std::scoped_lock lock(mutex_);
            if (frame.poseSeconds) frames_.push_back({*frame.poseSeconds, frame.wantedStrokes, frame.estimatedStrokes});
        });
    }
    ~Watched() { loop_.removeTap(id_); }
    struct Frame {
        double seconds;
        std::vector<double> wanted, estimated;
    };
    [[nodiscard]] std::vector<Frame> frames() {
        const std::scoped_lock lock(mutex_);
        return frames_;
    }

private:
    StudioLoop& loop_;
    int id_ = 0;
    std::mutex mutex_;
    std::vector<Frame> frames_;
};

/// The minimum-jerk way and the hold of each step, written out.
std::vector<double> expectedAt(const std::vector<std::vector<double>>& poses, const std::vector<double>& travels,
                               const std::vector<double>& holds, std::vector<double> from, double seconds) {
    for (std::size_t k = 0; k < poses.size(); ++k) {
        if (seconds < travels[k]) {
            const double u = seconds / travels[k];
            const double share = 10.0 * std::pow(u, 3) - 15.0 * std::pow(u, 4) + 6.0 * std::pow(u, 5);
            for (std::size_t a = 0; a < from.size(); ++a) from[a] += share * (poses[k][a] - from[a]);
            return from;
        }
        seconds -= travels[k];
        from = poses[k];
        if (seconds < holds[k]) return from;
        seconds -= holds[k];
    }
    return from;
}

TEST(Poses, ThreeMadeByTheMousePlayAsReckonedAndEndWhereTheLastOneIs) {
    TemporaryFolder folder;
    StudioWindow window(folder / "session");
    EXPECT_FALSE(window.findNow<QWidget>("poses.list")) << "who makes no poses does not see their dock";
    keepPoseByHand(window, {0.9, 0.1, 0.5}, "open");
    keepPoseByHand(window, {0.0, 0.8, 0.2}, "half");
    keepPoseByHand(window, {0.4, 0.4, 1.0}, "shut");
    for (const int pose : {0, 1, 2}) addStep(window, pose);
    ASSERT_EQ(sequenceOf(window).steps.size(), 3U);

    auto* timeline = window.find<PoseTimeline>("poses.timeline");
    dragStep(*timeline, 2, 0);
    ASSERT_EQ(sequenceOf(window).steps[0].pose, "shut") << "dragged to the front";
    ASSERT_EQ(sequenceOf(window).steps[2].pose, "half");
    EXPECT_TRUE(window.text("poses.step") == "Step 1");
    window.enter("poses.travel", "4");
    window.enter("poses.hold", "0.3");
    EXPECT_EQ(sequenceOf(window).steps[0].travelSeconds, 4.0);
    EXPECT_EQ(sequenceOf(window).steps[0].holdSeconds, 0.3);
    window.screenshot("poses_made");

    const std::vector<double> from = window.state().strokes;
    const int steps = window.studio().document.undoStack().index();
    Watched watched(window.studio().loop);
    window.click("poses.play");
    ASSERT_TRUE(window.studio().loop.posePlay());
    const PoseSequence plan = window.studio().loop.posePlay()->sequence;
    const auto drawn = [&](int step) { return static_cast<double>(timeline->boxOf(step).width()); };
    const auto lasts = [&](std::size_t step) { return plan.steps[step].travelSeconds + plan.steps[step].holdSeconds; };
    EXPECT_NEAR(drawn(0) / drawn(1), lasts(0) / lasts(1), 0.05) << "drawn as long as they last";
    EXPECT_EQ(window.studio().driver.driver(), Driver::hand);
    ASSERT_TRUE(eventually([&] { return timeline->playheadX() > timeline->boxOf(0).center().x(); }));
    window.screenshot("poses_play");
    ASSERT_TRUE(eventually([&] { return !window.studio().loop.posePlay(); })) << "it ends by itself";
    const std::vector<Watched::Frame> frames = watched.frames();
    ASSERT_GT(frames.size(), 40U);
    const auto& poses = sequenceOf(window).poses;
    const std::vector<std::vector<double>> way = {poses[2].strokes, poses[0].strokes, poses[1].strokes};
    std::vector<double> travels, holds;
    for (const PoseStep& step : plan.steps) {
        travels.push_back(step.travelSeconds);
        holds.push_back(step.holdSeconds);
    }
    // No faster than the rig's servos may, whatever was set.
    const auto limits = motionLimits(*window.state().rig.rig);
    std::vector<double> before = from;
    for (std::size_t k = 0; k < way.size(); ++k) {
        EXPECT_GE(travels[k], k == 0 ? 4.0 : 1.0);
        for (std::size_t a = 0; a < before.size(); ++a)
            EXPECT_LE(1.875 * std::abs(way[k][a] - before[a]) / travels[k], limits[a].maxVelocity + 1e-9);
        before = way[k];
    }
    for (std::size_t k = 0; k < frames.size(); ++k) {
        const std::vector<double> expected = expectedAt(way, travels, holds, from, frames[k].seconds);
        for (std::size_t a = 0; a < from.size(); ++a) ASSERT_NEAR(frames[k].wanted[a], expected[a], 1e-9);
    }
    EXPECT_EQ(window.state().strokes, poses[1].strokes);
    EXPECT_EQ(window.studio().document.undoStack().index(), steps + 1) << "all of it is one step";
    window.studio().document.undoStack().undo();
    EXPECT_EQ(window.state().strokes, from);
}

TEST(Poses, PauseWaitsASliderTakesOverAndStopEndsIt) {
    TemporaryFolder folder;
    StudioWindow window(folder / "session");
    keepPoseByHand(window, {1.0}, "up");
    keepPoseByHand(window, {0.0}, "down");
    addStep(window, 0);
    addStep(window, 1);
    window.click("poses.loop");
    EXPECT_TRUE(sequenceOf(window).loop);
    auto& loop = window.studio().loop;
    window.click("poses.play");
    ASSERT_TRUE(eventually([&] { return loop.frame()->wantedStrokes[0] > 0.2; }));
    window.click("poses.play");
    ASSERT_TRUE(loop.posePlay() && loop.posePlay()->heldAt);
    const double held = *loop.posePlay()->heldAt;
    ASSERT_TRUE(eventually([&] { return loop.frame()->poseSeconds == held; }));
    test::pass(std::chrono::milliseconds(300));
    EXPECT_EQ(loop.frame()->poseSeconds, held);
    window.click("poses.play");
    ASSERT_TRUE(eventually([&] { return loop.frame()->poseSeconds > held; }));
    EXPECT_LT(*loop.frame()->poseSeconds, held + 2.0) << "it goes on from there";

    // A slider that is moved has all of them; the others stay where they were at that moment.
    window.slide("actuators.slider.1", 0.7);
    EXPECT_FALSE(loop.posePlay());
    EXPECT_NEAR(window.state().strokes[1], 0.7, 0.05);

    window.click("poses.play");
    ASSERT_TRUE(eventually([&] { return loop.frame()->poseSeconds > 0.5; }));
    loop.stop();
    EXPECT_FALSE(loop.posePlay());
    EXPECT_FALSE(window.find<QAbstractButton>("poses.play")->isEnabled()) << "after STOP one resumes first";
    const std::vector<double> there = window.state().strokes;
    loop.resume();
    test::pass(std::chrono::milliseconds(300));
    EXPECT_EQ(loop.frame()->wantedStrokes, there) << "the device stays where STOP found it";

    // Names that are there already, and none at all, are said and change nothing.
    auto* list = window.find<QListWidget>("poses.list");
    for (const QString name : {"up", ""}) {
        list->item(1)->setText(name);
        EXPECT_EQ(sequenceOf(window).poses[1].name, "down");
        EXPECT_EQ(list->item(1)->text(), "down");
    }
    EXPECT_FALSE(window.studio().notices.at("poses").empty());
    window.screenshot("poses_notice");
    window.click("poses.remove");
    ASSERT_EQ(sequenceOf(window).poses.size(), 1U);
    EXPECT_EQ(sequenceOf(window).steps.size(), 1U);
}

TEST(Poses, ExportWritesTheSketchWithThemAndSaysWhatTheBoardChanges) {
    TemporaryFolder folder;
    StudioWindow window(folder / "session");
    keepPoseByHand(window, {1.0}, "up");
    keepPoseByHand(window, {0.0}, "down");
    addStep(window, 0);
    addStep(window, 1);
    auto* easing = window.find<QComboBox>("poses.easing");
    easing->setFocus();
    QTest::keyClick(easing, Qt::Key_End);
    EXPECT_EQ(sequenceOf(window).steps[1].easing, Easing::linear);
    window.click("poses.export");
    EXPECT_TRUE(window.text("poses.export.says").contains("smoothly in step 2"))
        << window.text("poses.export.says").toStdString();
    window.screenshot("poses_export");
    window.click("poses.export.accept");
    std::filesystem::create_directories(folder / "sketches");
    test::answerFileDialog(window, "poses.export.file", folder / "sketches", "Export here");
    const auto header = folder / "sketches/tablet/poses.h";
    ASSERT_TRUE(eventually([&] { return std::filesystem::exists(header); }));
    std::ifstream file(header);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    EXPECT_NE(text.find("kPoseSteps = 2;"), std::string::npos);
    EXPECT_NE(text.find("kPoseButton = 12;"), std::string::npos);
    EXPECT_TRUE(eventually([&] { return !window.studio().notices.at("poses").empty(); }));
}

} // namespace
} // namespace lumorph::studio
