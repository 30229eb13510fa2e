#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <vector>

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
#include "calibration/capture/pose_capture.h"
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
        picture_ = {};
        update();
    }
    void light(const QImage& picture) {
        picture_ = picture;
        update();
    }

protected:
    void paintEvent(QPaintEvent* /*event*/) override {
        QPainter painter(this);
        if (!picture_.isNull()) return painter.drawImage(0, 0, picture_);
        painter.fillRect(QRect(QPoint(), size()), Qt::black);
        painter.fillRect(square_, color_);
    }

private:
    QRect square_;
    QColor color_ = Qt::white;
    QImage picture_; ///< if any, instead
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
        const QImage image = QImage(picture.data, picture.cols, picture.rows, static_cast<qsizetype>(picture.step),
                                    QImage::Format_Grayscale8)
                                 .copy();
        QMetaObject::invokeMethod(
            &thrown_, [this, image] { thrown_.light(image); }, Qt::QueuedConnection);
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

/// What happens while a pose is photographed, and what may be said of it: keys of causes, "sound", or a few words of an
/// error.
struct Mishap {
    const char* what;
    std::function<void()> happens, ends;
    std::vector<std::string> said;
};

std::string keyOrWords(const std::function<CapturedPose()>& capture) {
    try {
        const CapturedPose pose = capture();
        return pose.findings.refusal ? std::string(keyOf(pose.findings.refusal->cause)) : "sound";
    } catch (const CaptureRefused& refused) { // while it measured how late light comes
        return std::string(keyOf(refused.finding().cause));
    } catch (const DeviceError& error) {
        return error.what();
    }
}

// What goes wrong in a room goes wrong here behind the sockets, in the middle of a pose; what is said is compared with
// what was done.
TEST_F(TableProgramTest, MishapsWhileAPoseIsPhotographedAreNamed) {
    if (!longTests()) GTEST_SKIP() << "minutes of photographs: LUMORPH_LONG_TESTS=1";
    int named = 0, all = 0;
    for (const char* seed : {"41", "42", "43"}) {
        TableProgram table;
        ASSERT_NO_FATAL_FAILURE(table.start({"--seed", seed, "--camera-size", "640x512"}));
        Thrown thrown;
        ASSERT_TRUE(QTest::qWaitForWindowExposed(&thrown));
        table.does("board 1");
        const auto cover = [&](const QRect& place) {
            return [&thrown, place, message = std::make_shared<std::unique_ptr<Thrown>>()](bool covers) {
                if (!covers) return message->reset();
                *message = std::make_unique<Thrown>();
                (*message)->setGeometry(place);
                (*message)->raise();
            };
        };
        const QSize size = thrown.size();
        const auto message = cover({size.width() / 3, size.height() / 3, size.width() / 3, size.height() / 4});
        const auto asleep = cover({QPoint(), size});
        const auto fault = [&](const QString& key, const QString& how = "on") {
            return [&table, key, how] { table.does("fault " + key + " " + how); };
        };
        const std::vector<Mishap> mishaps = {
            {"packets lost, 0.1 %", fault("packets_lost", "0.1"), fault("packets_lost", "off"), {"sound"}},
            {"packets lost, 1 %",
             fault("packets_lost", "1"),
             fault("packets_lost", "off"),
             {"sound", "arrive incomplete"}},
            {"camera unplugged and back",
             [&] {
                 table.does("fault camera_unplugged on");
                 pass(2s);
                 table.does("fault camera_unplugged off");
             },
             [] {},
             {"sound"}},
            {"automatic exposure", fault("auto_exposure"), fault("auto_exposure", "off"), {"exposure_drifts"}},
            {"night light", fault("night_light"), fault("night_light", "off"), {"exposure_drifts"}},
            {"a message over the picture",
             [&] { message(true); },
             [&] { message(false); },
             {"wrong_order", "hand_in_view"}},
            {"screen asleep", [&] { asleep(true); }, [&] { asleep(false); }, {"board_unlit", "late_frame"}},
            {"another board",
             [&] { table.does("board 2"); },
             [&] { table.does("board 1"); },
             {"rig_moved", "wrong_order"}},
            {"a hand",
             [&] { table.does("hand 0 0.1 0"); },
             [&] { table.does("hand off"); },
             {"wrong_order", "hand_in_view"}},
        };
        std::atomic<int> shots{0};
        const auto photograph = [&] {
            shots = 0;
            return std::async(std::launch::async, [&] {
                const auto camera = openCaptureCamera(table.address("uri"));
                ThrownPatterns display(thrown);
                PoseCaptureSettings settings;
                settings.order = parsePattern("graycode", display.size());
                settings.board = parseCalibrationBoard("chess:9x7:25");
                settings.onShot = [&](const Shot&) { ++shots; };
                PoseCapture capture(*camera, display, settings);
                return keyOrWords([&] { return capture.capture("pose_1"); });
            });
        };
        for (const Mishap& mishap : mishaps) {
            std::future<std::string> said = photograph();
            const auto ended = [&] { return said.wait_for(0s) == std::future_status::ready; };
            ASSERT_TRUE(eventually([&] { return shots >= 9 || ended(); }, 60s)) << mishap.what;
            EXPECT_FALSE(ended()) << mishap.what << ", too early: seed " << seed;
            mishap.happens();
            ASSERT_TRUE(eventually(ended, 120s)) << mishap.what;
            mishap.ends();
            const std::string words = said.get();
            const bool isNamed = std::ranges::any_of(
                mishap.said, [&](const std::string& one) { return words.find(one) != std::string::npos; });
            ++all;
            named += isNamed ? 1 : 0;
            std::printf("%s, seed %s, at shot %d: %s%s\n", mishap.what, seed, shots.load(), words.c_str(),
                        isNamed ? "" : "   <-- NOT NAMED");
            std::fflush(stdout);
        }
        std::future<std::string> after = photograph();
        ASSERT_TRUE(eventually([&] { return after.wait_for(0s) == std::future_status::ready; }, 120s));
        EXPECT_EQ(after.get(), "sound") << "all is as it was: seed " << seed;
    }
    EXPECT_GE(10 * named, 9 * all);
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
    EXPECT_EQ(filesInCommon(), "") << "what the studio knows of the table went through its sockets";
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
