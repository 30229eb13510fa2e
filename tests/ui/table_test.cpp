#include <cmath>
#include <cstdio>
#include <future>

#include <QAbstractButton>
#include <QGuiApplication>
#include <QPainter>
#include <QProcess>
#include <QRasterWindow>
#include <QScreen>
#include <QTest>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "calibration/capture/capture_camera.h"
#include "calibration/delays/flash_capture.h"
#include "core/geometry/calibrated_camera.h"
#include "core/loop/pose_stream.h"
#include "core/rig/rig_file.h"
#include "core/scene/measured_servos.h"
#include "devices/controllers/servo_link.h"
#include "devices/trackers/tracker.h"
#include "tests/support/long_tests.h"
#include "tests/ui/event_loop.h"
#include "tests/ui/table_program.h"

// The table behind its sockets, judged by its truth: light by the closed form of a ray and a plane.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;

constexpr double kRim = 16.0;         // camera pixels
constexpr double kDeviceReach = 0.17; // metres: a tablet's corner, and some room beside it

/// What the projector at the screen throws: black, with one white square.
class Thrown : public QRasterWindow {
public:
    Thrown() {
        setFlags(Qt::FramelessWindowHint | Qt::X11BypassWindowManagerHint);
        setGeometry(screen()->geometry());
        setCursor(Qt::BlankCursor);
        show();
    }
    void light(const QRect& square, const QColor& color = Qt::white) {
        square_ = square;
        color_ = color;
        update();
    }

protected:
    void paintEvent(QPaintEvent* /*event*/) override {
        QPainter painter(this);
        painter.fillRect(QRect(QPoint(), size()), Qt::black);
        painter.fillRect(square_, color_);
    }

private:
    QRect square_;
    QColor color_ = Qt::white;
};

class TableProgramTest : public testing::Test, protected TableProgram {};

/// Where a projector truly throws a pixel on the table.
glm::dvec3 thrownTo(const CalibratedCamera& projector, const glm::dvec2& pixel) {
    const glm::dvec3 from = positionOf(projector), along = directionOf(projector, pixel);
    return from - from.y / along.y * along;
}

/// The middle of what is brighter than a third of the brightest, or nearly.
cv::Point2d brightest(const cv::Mat& picture) {
    double most = 0.0;
    cv::minMaxLoc(picture, nullptr, &most);
    double sum = 0.0;
    cv::Point2d at;
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x)
            if (const double light = picture.at<std::uint8_t>(y, x); light > 0.3 * most) {
                sum += light;
                at += light * cv::Point2d(x, y);
            }
    return at / sum;
}

TEST_F(TableProgramTest, CamerasSeeWhatTheScreenShowsWhereItsTruthSays) {
    ASSERT_NO_FATAL_FAILURE(start());
    Thrown thrown;
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&thrown));
    const CalibratedCamera& projector = truth.projectors.front().camera;
    ASSERT_EQ(projector.size, glm::ivec2(thrown.width(), thrown.height()));
    for (const char* kind : {"uri", "mjpeg"}) {
        const auto camera = openCaptureCamera(address(kind));
        int seen = 0;
        for (const double across : {0.1, 0.88})
            for (const double down : {0.12, 0.85}) {
                const QRect square(int(across * thrown.width()), int(down * thrown.height()), 24, 24);
                const glm::dvec2 middle(square.x() + 11.5, square.y() + 11.5);
                const glm::dvec3 place = thrownTo(projector, middle);
                const CalibratedCamera& seer = truth.cameras.front().camera;
                const auto wanted = pixelOf(seer, place);
                if (!wanted || wanted->x < kRim || wanted->y < kRim || wanted->x > seer.size.x - kRim ||
                    wanted->y > seer.size.y - kRim || std::abs(place.x) > 0.5 * truth.tableSize.x ||
                    std::abs(place.z) > 0.5 * truth.tableSize.y ||
                    glm::distance(place, glm::dvec3(truth.worldFromDevice[3])) < kDeviceReach)
                    continue;
                thrown.light(square);
                pass(200ms);
                const cv::Point2d found = brightest(greyOf(camera->grab({})));
                EXPECT_NEAR(found.x, wanted->x, 0.5) << kind << ", " << across << ", " << down;
                EXPECT_NEAR(found.y, wanted->y, 0.5) << kind << ", " << across << ", " << down;
                ++seen;
            }
        EXPECT_GE(seen, 2) << kind;
    }
}

TEST_F(TableProgramTest, ExposureGainAndWhatCoversTheScreenAreSeen) {
    ASSERT_NO_FATAL_FAILURE(start());
    Thrown thrown;
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&thrown));
    const auto camera = openCaptureCamera(address("uri"));
    ASSERT_TRUE(camera->exposures());
    thrown.light(QRect(QPoint(), thrown.size()), QColor(180, 180, 180));
    pass(300ms);
    const auto mean = [&] {
        (void)camera->grab({}); // one that may have begun before
        return cv::mean(greyOf(camera->grab({})))[0];
    };
    camera->setExposure(0.004);
    const double once = mean();
    camera->setExposure(0.008);
    EXPECT_NEAR(mean() / once, 2.0, 0.06) << "linear, and below white";
    // A message of another program lies over the picture.
    Thrown message;
    message.setGeometry(0, 0, thrown.width() / 2, thrown.height());
    pass(300ms);
    EXPECT_LT(mean(), 1.6 * once);
}

TEST_F(TableProgramTest, TrackerTellsWhereThingsTrulyAre) {
    ASSERT_NO_FATAL_FAILURE(start());
    const auto tracker = openTracker(ready["tracker"].toString().toStdString(), {});
    const auto bodyOf = [&](const std::string& name) -> std::optional<Pose> {
        for (const auto& body : tracker->status().bodies)
            if (body.name == name && body.valid) return body.pose;
        return std::nullopt;
    };
    ASSERT_TRUE(eventually([&] { return bodyOf("device").has_value(); }));
    EXPECT_FALSE(bodyOf("pointer")) << "nobody has brought it";
    does("touch 0.1 0.05 -0.2");
    pass(1s);
    const auto inRoom = [&](const glm::dvec3& place) {
        return glm::dvec3(truth.worldFromTracker * glm::vec4(glm::vec3(place), 1.0F));
    };
    glm::dvec3 tip(0.0);
    for (int k = 0; k < 40; ++k) {
        const auto pose = bodyOf("pointer");
        ASSERT_TRUE(pose);
        tip += inRoom(*pose * glm::dvec3(truth.pointerTip)) / 40.0;
        pass(20ms);
    }
    EXPECT_LT(glm::distance(tip, glm::dvec3(0.1, 0.05, -0.2)), 1e-3);
    does("fault tracker_dropout on");
    EXPECT_TRUE(eventually([&] { return !bodyOf("pointer"); }, 5s));
    does("fault tracker_dropout off");
    EXPECT_TRUE(eventually([&] { return bodyOf("pointer").has_value(); }, 5s));
    EXPECT_FALSE(tell("touch nowhere")["ok"].toBool());
    EXPECT_FALSE(tell("carry 1 2")["ok"].toBool());
}

/// Shows what a measurement asks for, in a thread of its own, in the window of this one.
class ThrownPatterns final : public PatternDisplay {
public:
    explicit ThrownPatterns(Thrown& thrown) : thrown_(thrown) {}
    [[nodiscard]] cv::Size size() const override { return {thrown_.width(), thrown_.height()}; }
    void show(const cv::Mat& picture, const Progress& progress) override {
        progress.throwIfCancelled();
        const int grey = picture.at<std::uint8_t>(0, 0);
        QMetaObject::invokeMethod(
            &thrown_, [this, grey] { thrown_.light(QRect(QPoint(), thrown_.size()), QColor(grey, grey, grey)); },
            Qt::QueuedConnection);
    }
    void clear() override {}

private:
    Thrown& thrown_;
};

// Through the screen, the camera's packets and its clock; no frame of a show comes before these pictures.
TEST_F(TableProgramTest, LightIsTimedByFlashes) {
    if (!longTests()) GTEST_SKIP() << "a busy machine draws and photographs late: LUMORPH_LONG_TESTS=1";
    ASSERT_NO_FATAL_FAILURE(start({"--seed", "8", "--camera-size", "480x384"}));
    Thrown thrown;
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&thrown));
    std::future<MeasuredDelay> measured = std::async(std::launch::async, [&] {
        const auto camera = openCaptureCamera(address("uri"));
        ThrownPatterns display(thrown);
        return solveFlashDelay(recordFlashes(*camera, display, 0.0, {}, 16));
    });
    ASSERT_TRUE(eventually([&] { return measured.wait_for(0s) == std::future_status::ready; }, 60s));
    const MeasuredDelay delay = measured.get();
    std::printf("light: %.1f ms after it was asked for, sigma %.1f, truth %.1f and what the screen takes\n",
                1e3 * delay.seconds, 1e3 * delay.sigma, 1e3 * truth.predictionSeconds);
    // To draw and to show it takes a machine some milliseconds; more, where other tests keep it busy.
    EXPECT_GT(delay.seconds, truth.predictionSeconds - 0.005);
    EXPECT_LT(delay.seconds, truth.predictionSeconds + 0.060);
    EXPECT_LT(delay.sigma, 0.015);
}

// Light, servos and check look through the same camera.
TEST_F(TableProgramTest, CameraAndProjectorAreFreeOnceTheWholeChainIsShown) {
    ASSERT_NO_FATAL_FAILURE(start());
    TemporaryFolder session;
    {
        studio::Settings settings; // as a new user has it
        settings.remove("calibrate");
    }
    StudioWindow window(session / "session", "scene");
    ASSERT_TRUE(eventually([&] { return window.studio().jobs.running().empty(); }, 60s));
    window.window().showWorkspace("calibrate");
    ASSERT_NO_FATAL_FAILURE(chooseScreenAndCamera(window));
    EXPECT_EQ(window.state().installation->projectors.front().lens.way, Origin::Way::assumed)
        << "nobody has entered the pixels of the screen";
    const auto isWhite = [&] {
        const QImage shown = window.studio().outputs.window(0)->grab().toImage();
        return shown.pixelColor(shown.width() / 2, shown.height() / 2) == QColor(Qt::white);
    };
    const auto offers = [&](const QString& words) {
        return eventually([&] {
            const auto* next = window.findNow<QAbstractButton>("calibrate.card.next");
            return next && next->text().startsWith(words);
        });
    };
    ASSERT_TRUE(offers("Photograph pose 1"));
    window.click("calibrate.card.next");
    ASSERT_TRUE(offers("Photograph this pose again"))
        << "no board lies there: " << window.text("calibrate.card.title").toStdString() << ": "
        << window.text("calibrate.card.text").toStdString();
    EXPECT_TRUE(eventually(isWhite, 20s)) << "a board that is laid there now is lit";
    window.click("calibrate.whole");
    EXPECT_TRUE(eventually([&] { return !isWhite(); }, 20s)) << "the show is back";
    const auto camera = openCaptureCamera(address("uri"));
    EXPECT_FALSE(camera->grab({}).empty());
}

/// A body's pose from another one's, by OpenCV's conventions.
glm::dmat4 fromOther(const CalibratedCamera& of, const CalibratedCamera& other) {
    return of.cameraFromWorld * glm::inverse(other.cameraFromWorld);
}

// By the mouse, through the camera's packets and the projector's screen; judged by what the table wrote.
TEST_F(TableProgramTest, ProjectorIsCalibratedInTheWindowByTheCameraOfTheTable) {
    if (!longTests()) GTEST_SKIP() << "minutes of photographs: LUMORPH_LONG_TESTS=1";
    ASSERT_NO_FATAL_FAILURE(
        start({"--seed", "5", "--camera-size", "1600x1280"})); // one pixel for each of the projector, nearly
    TemporaryFolder session;
    {
        studio::Settings settings; // as a new user has it
        settings.remove("calibrate");
        std::filesystem::create_directories(session / "poses");
        settings.setValue("calibrate/saved", QString::fromStdString(session / "poses"));
        settings.setValue("calibrate/camera/poses", 4);
    }
    StudioWindow window(session / "session", "scene");
    ASSERT_TRUE(eventually([&] { return window.studio().jobs.running().empty(); }, 60s));
    window.window().showWorkspace("calibrate");
    ASSERT_NO_FATAL_FAILURE(chooseScreenAndCamera(window));
    const auto story = [&] {
        return (window.text("calibrate.card.title") + ": " + window.text("calibrate.card.text")).toStdString();
    };
    const auto offers = [&](const QString& words) {
        return eventually(
            [&] {
                const auto* next = window.findNow<QAbstractButton>("calibrate.card.next");
                return next && next->text().startsWith(words);
            },
            300s);
    };
    for (int k = 1; k <= 4; ++k) {
        ASSERT_TRUE(offers(QString("Photograph pose %1").arg(k))) << story();
        does(QString("board %1").arg(k));
        pass(700ms);
        window.click("calibrate.card.next");
    }
    ASSERT_TRUE(offers("Use this calibration")) << story();
    window.click("calibrate.card.next");
    const auto room = [&]() -> const Installation& { return *window.state().installation; };
    ASSERT_TRUE(eventually([&] { return room().projectors.front().lens.isCalibrated(); }, 10s)) << story();
    ASSERT_EQ(room().cameras.size(), 1U);
    const CalibratedCamera& found = room().projectors.front().camera;
    const CalibratedCamera& wanted = truth.projectors.front().camera;
    EXPECT_NEAR(found.focal.x / wanted.focal.x, 1.0, 0.004);
    EXPECT_NEAR(found.focal.y / wanted.focal.y, 1.0, 0.004);
    const glm::dmat4 between = fromOther(found, room().cameras.front().camera),
                     truly = fromOther(wanted, truth.cameras.front().camera);
    EXPECT_LT(glm::distance(glm::dvec3(between[3]), glm::dvec3(truly[3])), 0.01);
    const glm::dmat3 turn = glm::transpose(glm::dmat3(truly)) * glm::dmat3(between);
    EXPECT_LT(std::acos(std::min(1.0, 0.5 * (turn[0][0] + turn[1][1] + turn[2][2] - 1.0))), 0.005);
    std::printf("at the table: focal %.4f, %.4f of the truth; %.2f mm, %.3f degrees between projector and camera\n",
                found.focal.x / wanted.focal.x, found.focal.y / wanted.focal.y,
                1e3 * glm::distance(glm::dvec3(between[3]), glm::dvec3(truly[3])),
                57.29578 * std::acos(std::min(1.0, 0.5 * (turn[0][0] + turn[1][1] + turn[2][2] - 1.0))));
}

TEST_F(TableProgramTest, IsFoundByTheCommandThatListsCameras) {
    ASSERT_NO_FATAL_FAILURE(start());
    QProcess command;
    command.start(LUMORPH_BIN_DIR "/lumorph", {"cameras", "--json"});
    ASSERT_TRUE(eventually([&] { return command.state() == QProcess::NotRunning; }, 30s));
    EXPECT_TRUE(command.readAllStandardOutput().contains(QByteArray::fromStdString(address("uri"))));
}

} // namespace
} // namespace lumorph::test
