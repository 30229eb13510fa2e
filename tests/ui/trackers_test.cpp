#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>

#include <QAbstractButton>
#include <QCheckBox>
#include <QComboBox>
#include <QPainter>
#include <QSlider>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "app/studio/widgets/plot.h"
#include "tests/calibration/photographer.h"
#include "tests/ui/file_dialog.h"
#include "tests/ui/trackers_window.h"

// Trackers as their user has them, against simulated bodies and a board in a video: what counts is whom the loop
// follows.

namespace lumorph::test {
namespace {

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
    studio::TrackerService later(window.studio().settings, window.studio().loop, notices);
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

TEST_F(TrackersWindow, OfTwoHeadsTheFirstIsFollowedAndTheSecondIsToldWhy) {
    const QString first = "sim://head?rate=60", second = "sim://head?rate=90";
    ASSERT_TRUE(opens(first));
    ASSERT_TRUE(eventually([&] { return viewer() == "head"; }, 10s));
    window.enter("trackers.address", second, Qt::Key_Tab);
    window.click("trackers.open");
    ASSERT_TRUE(eventually([&] { return window.studio().trackers.trackers().size() == 2; }, 10s));
    const glm::dvec3 places[] = {{-0.3, 0.4, 0.6}, {0.3, 0.4, 0.6}};
    for (std::size_t i = 0; i < 2; ++i) {
        studio::OpenTracker tracker = window.studio().trackers.trackers().at(i);
        ASSERT_EQ(tracker.status.address, (i == 0 ? first : second).toStdString());
        SimulatedOrders orders = tracker.steering->orders();
        orders.held = Pose{places[i], {1, 0, 0, 0}};
        tracker.steering->order(orders);
    }
    const auto isAt = [&](const glm::dvec3& place) {
        return eye() && glm::distance(glm::dvec3(*eye()), place) < 0.003;
    };
    EXPECT_TRUE(eventually([&] { return isAt(places[0]); }, 10s));
    const auto told = [&] { return textNow("tracker.1.advice"); };
    EXPECT_TRUE(eventually([&] { return told().contains("'head' of this tracker is not followed"); }, 5s));
    EXPECT_TRUE(told().contains(first + " (a simulated head)")) << told().toStdString();
    EXPECT_TRUE(told().contains("Close one of the two trackers, or rename the body")) << told().toStdString();
    EXPECT_EQ(textNow("tracker.0.advice"), "") << "nothing is wrong with the first";
    for (int i = 0; i < 30; ++i) {
        pass(10ms);
        ASSERT_FALSE(isAt(places[1])) << "the eye does not jump";
    }
    window.screenshot("trackers-two-heads");
    reveal("tracker.0.close");
    window.click("tracker.0.close");
    EXPECT_TRUE(eventually([&] { return window.studio().trackers.trackers().size() == 1; }, 10s));
    EXPECT_TRUE(eventually([&] { return isAt(places[1]); }, 10s)) << "the second takes over by itself";
    EXPECT_TRUE(eventually([&] { return textNow("tracker.0.advice").isEmpty(); }, 5s));
}

// --- A person without hardware

TEST_F(TrackersWindow, ASimulatedTrackerIsBrokenOnPurposeAndItIsTold) {
    ASSERT_TRUE(opens("sim://head?rate=100"));
    ASSERT_TRUE(eventually([&] { return viewer() == "head"; }, 10s));
    const auto set = [&](const QString& part, int steps) {
        auto* slider = window.find<QSlider>("tracker.0.sim." + part);
        ASSERT_NE(slider, nullptr);
        slider->setValue(steps);
    };
    EXPECT_TRUE(eventually([&] { return framesPerSecond() > 60.0; }, 10s));
    set("rate", 20);
    set("latency", 40); // of 5 ms
    EXPECT_TRUE(eventually([&] { return std::abs(framesPerSecond() - 20.0) < 3.0; }, 10s)) << framesPerSecond();
    EXPECT_TRUE(eventually([&] { return textNow("tracker.0.latency") == "200.0 ms"; }, 5s));
    EXPECT_EQ(textNow("tracker.0.sim.latency.value"), "200 ms");
    for (const char* part : {"tracker.0.rates", "tracker.0.delays"}) {
        auto* plot = window.find<studio::Plot>(part);
        ASSERT_NE(plot, nullptr);
        EXPECT_TRUE(eventually([&] { return !plot->curves().empty() && plot->curves()[0].values.size() > 5; }, 5s));
    }
    EXPECT_TRUE(eventually(
        [&] { return window.find<studio::Plot>("tracker.0.delays")->curves().at(0).values.back() == 200.0; }, 5s));
    set("rate", 100);
    window.click("tracker.0.sim.teleport");
    EXPECT_TRUE(eventually([&] { return textNow("tracker.0.event").contains("head jumped by"); }, 5s));
    window.click("tracker.0.sim.nan");
    EXPECT_TRUE(eventually([&] { return textNow("tracker.0.reason").contains("is no number"); }, 5s));
    EXPECT_TRUE(eventually([&] { return textNow("tracker.0.rejected") == "10"; }, 5s));
    window.screenshot("trackers-broken");
    auto* hidden = window.find<QCheckBox>("tracker.0.sim.hidden");
    ASSERT_NE(hidden, nullptr);
    hidden->click();
    EXPECT_TRUE(eventually([&] { return textNow("tracker.0.advice").contains("hidden"); }, 5s));
    EXPECT_TRUE(eventually([&] { return viewer().empty(); }, 5s)) << "who is not seen is not followed";
    hidden->click();
    set("drop", 100);
    EXPECT_TRUE(eventually([&] { return textNow("tracker.0.advice").contains("dropped"); }, 5s));
    set("drop", 0);
    EXPECT_TRUE(eventually([&] { return viewer() == "head"; }, 10s));
}

// --- A board by camera

/// A video of the default board, as a camera at (0.1, 0.5, 0.35) sees it that looks at the origin; it slides by 4 cm.
std::string boardVideo(const std::filesystem::path& file) {
    const MarkerBoard board;
    const CalibratedCamera camera = cameraLookingAt({0.10, 0.50, 0.35}, {0.0, 0.0, 0.0}, {640, 360}, 530.0);
    const Photographer photographer(board, camera);
    const glm::dvec2 size = sizeOf(board);
    const Pose bodyFromBoard{{-0.5 * size.x, 0.0, 0.5 * size.y}, glm::angleAxis(-M_PI / 2.0, glm::dvec3(1, 0, 0))};
    cv::VideoWriter video(file.string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 20.0, {640, 360});
    for (int i = 0; i < 16; ++i) {
        const Pose body{{0.03 + 0.0025 * std::min(i, 15 - i), 0.0, -0.02}, glm::angleAxis(0.3, glm::dvec3(0, 1, 0))};
        std::vector<std::uint8_t> grey = photographer.picture(matrixOf(body) * matrixOf(bodyFromBoard), 2.0);
        cv::Mat color;
        cv::cvtColor(cv::Mat(360, 640, CV_8UC1, grey.data()), color, cv::COLOR_GRAY2BGR);
        video.write(color);
    }
    return "board://" + file.string() +
           "?squares=5x7&size=30&marker=22&lens=530,530,319.5,179.5&from=0.1,0.5,0.35&repeat=yes";
}

TEST_F(TrackersWindow, ABoardInAVideoIsTheDeviceOfTheShow) {
    const QString address = QString::fromStdString(boardVideo(folder_ / "board.avi"));
    ASSERT_TRUE(opens(address));
    EXPECT_TRUE(eventually([&] { return textNow("tracker.0.camera.fit").contains("px, good"); }, 15s))
        << textNow("tracker.0.camera.fit").toStdString();
    EXPECT_TRUE(textNow("tracker.0.camera.size").startsWith("640 × 360"));
    EXPECT_TRUE(eventually([&] { return textNow("tracker.0.camera.found") == "100 %"; }, 5s));
    auto* role = window.find<QComboBox>("tracker.0.body.0.role");
    ASSERT_NE(role, nullptr);
    EXPECT_EQ(role->currentText(), "Device");
    // 3 to 4.75 cm to the right, 2 cm back, turned by 0.3.
    const auto isThere = [&] {
        const glm::dmat4 device(window.studio().loop.frame()->worldFromDevice);
        return device[3].x > 0.026 && device[3].x < 0.052 && std::abs(device[3].z + 0.02) < 0.004 &&
               degreesBetween(glm::quat_cast(glm::dmat3(device)), glm::angleAxis(0.3, glm::dvec3(0, 1, 0))) < 1.5;
    };
    EXPECT_TRUE(eventually(isThere, 10s)) << "the loop follows it";
    window.screenshot("trackers-board");
    auto* picture = window.find<QWidget>("tracker.0.camera.picture");
    ASSERT_NE(picture, nullptr);
    const QImage shown = picture->grab().toImage();
    int orange = 0;
    for (int y = 0; y < shown.height(); ++y)
        for (int x = 0; x < shown.width(); ++x)
            orange += shown.pixelColor(x, y).red() > 200 && shown.pixelColor(x, y).blue() < 100;
    EXPECT_GT(orange, 100) << "the board's outline stands in the live picture";
}

TEST_F(TrackersWindow, ACameraThatIsNotThereIsToldWithItsRemedy) {
    ASSERT_TRUE(opens("board:///dev/video97?squares=5x7"));
    EXPECT_TRUE(
        eventually([&] { return textNow("tracker.0.advice").contains("There is no camera at /dev/video97"); }, 10s));
    EXPECT_EQ(textNow("tracker.0.camera.fit"), "not seen");
    const QStringList all = window.studio().trackers.addresses();
    EXPECT_TRUE(std::ranges::any_of(all, [](const QString& one) { return one.startsWith("board:///dev/video"); }));
}

TEST_F(TrackersWindow, TheBoardThatIsOpenIsWrittenToBePrinted) {
    ASSERT_TRUE(opens("board:///dev/video97?squares=4x6&size=35&marker=25"));
    window.studio().commands.find("tracker.board")->trigger();
    answerFileDialog(window, "tracker.board.file", folder_ / "page.pdf");
    ASSERT_TRUE(eventually([&] { return std::filesystem::exists(folder_ / "page.pdf"); }, 5s));
    std::ifstream file(folder_ / "page.pdf");
    const std::string pdf{std::istreambuf_iterator<char>(file), {}};
    EXPECT_NE(pdf.find("4 x 6 squares of 35 mm, markers of 25 mm"), std::string::npos);
}

// --- In the 3D views

/// Pixels of the widget about a point that are strongly red, green or blue: an axis.
int axisPixels(const QImage& image, const QPointF& about) {
    int count = 0;
    for (int y = std::max(0, int(about.y()) - 40); y < std::min(image.height(), int(about.y()) + 40); ++y)
        for (int x = std::max(0, int(about.x()) - 40); x < std::min(image.width(), int(about.x()) + 40); ++x) {
            const QColor c = image.pixelColor(x, y);
            const int most = std::max({c.red(), c.green(), c.blue()}), least = std::min({c.red(), c.green(), c.blue()});
            count += most - least > 90 ? 1 : 0;
        }
    return count;
}

TEST(BodyMarks, AxesStandWhereTheBodyIsAndFadeWhenItIsLost) {
    ViewCamera camera;
    camera.distance = 2.0;
    const QSize size(400, 300);
    const auto painted = [&](const studio::BodyMark& body) {
        QImage image(size, QImage::Format_RGB32);
        image.fill(QColor(40, 40, 40));
        QPainter painter(&image);
        studio::paintBodies(painter, size, camera, {body}, studio::paletteOf(Theme::dark));
        return image;
    };
    studio::BodyMark body{"head", {0.2F, 0.1F, 0.0F}, {1, 0, 0, 0}, 1.0};
    const auto at = pixelOf(camera, body.position, {400, 300});
    ASSERT_TRUE(at);
    const QPointF point(at->x, at->y);
    EXPECT_GT(axisPixels(painted(body), point), 60);
    EXPECT_LT(axisPixels(painted(body), {60, 240}), 1) << "and nowhere else";
    // +X to the right in red, +Y up in green.
    const QImage image = painted(body);
    EXPECT_GT(image.pixelColor((point + QPointF(12, 0)).toPoint()).red(), 180);
    EXPECT_GT(image.pixelColor((point - QPointF(0, 12)).toPoint()).green(), 160);
    body.strength = studio::strengthOf(10.0);
    EXPECT_EQ(body.strength, 0.25);
    EXPECT_LT(painted(body).pixelColor((point + QPointF(12, 0)).toPoint()).red(), 120);
    EXPECT_EQ(studio::strengthOf(0.1), 1.0);
    EXPECT_LT(studio::strengthOf(1.0), studio::strengthOf(0.5));
    body.position = {0.0F, 0.0F, 5.0F}; // behind the eye
    body.strength = 1.0;
    int bright = 0;
    const QImage edge = painted(body);
    for (int y = 200; y < 300; ++y)
        for (int x = 150; x < 250; ++x) bright += edge.pixelColor(x, y).lightness() > 180 ? 1 : 0;
    EXPECT_GT(bright, 30) << "an arrow at the edge points to it";
}

TEST_F(TrackersWindow, BodiesAreInTheViewsUntilTheyAreSwitchedOff) {
    ASSERT_TRUE(opens("sim://pointer"));
    ASSERT_TRUE(eventually([&] { return !window.studio().trackers.bodies().empty(); }, 10s));
    const auto& seen = window.studio().trackers.bodies();
    EXPECT_EQ(seen[0].role, PoseRole::pointer);
    EXPECT_LT(seen[0].age, 0.3);
    SimulatedOrders orders = seen[0].steering->orders();
    orders.held = Pose{{0.02, 0.12, 0.02}, {1, 0, 0, 0}};
    seen[0].steering->order(orders);
    window.click("tab.field");
    auto& view = window.view();
    ASSERT_TRUE(eventually([&] { return view.framesPainted() > 0; }, 20s));
    QPointF at;
    const auto isPainted = [&] {
        const auto pixel = pixelOf(view.camera(), {0.02F, 0.12F, 0.02F}, {view.width(), view.height()});
        if (!pixel) return false;
        at = {pixel->x, pixel->y};
        return axisPixels(view.grab().toImage(), at) > 60;
    };
    QAction* axes = window.studio().commands.find("view.bodies");
    ASSERT_NE(axes, nullptr);
    EXPECT_TRUE(axes->isChecked());
    EXPECT_TRUE(eventually(isPainted, 10s));
    window.screenshot("trackers-room");
    const int with = axisPixels(view.grab().toImage(), at);
    axes->trigger();
    EXPECT_TRUE(eventually([&] { return axisPixels(view.grab().toImage(), at) < with / 3; }, 5s));
    axes->trigger();
}

TEST(TrackerRoles, AreGuessedByTheName) {
    EXPECT_EQ(studio::likelyRole("board"), PoseRole::device);
    EXPECT_EQ(studio::likelyRole("Left Hand"), PoseRole::pointer);
    EXPECT_EQ(studio::likelyRole("Anna's Hat"), PoseRole::head);
    EXPECT_EQ(studio::likelyRole("EYEglass"), PoseRole::head);
    EXPECT_EQ(studio::likelyRole("my tablet"), PoseRole::device);
    EXPECT_EQ(studio::likelyRole("body 3"), std::nullopt);
}

} // namespace
} // namespace lumorph::test
