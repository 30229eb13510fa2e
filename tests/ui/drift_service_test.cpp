#include "app/studio/calibration/drift_service.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>

#include <QElapsedTimer>
#include <gtest/gtest.h>

#include "calibration/lab/moved_room.h"
#include "calibration/verify/verify_lab.h"
#include "core/base/error.h"
#include "tests/support/cut_tablet.h"
#include "tests/ui/event_loop.h"

// The watch of a running show, without a window: pictures from a made-up show, photographs from the virtual lab.

namespace lumorph::studio {
namespace {

/// Soft spots of light that wander.
QImage spotsAt(double seconds) {
    QImage picture(480, 270, QImage::Format_RGB32);
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) {
            const double a = std::sin(0.11 * x + 0.4 * seconds) * std::sin(0.13 * y - 0.3 * seconds);
            const double b = std::sin(0.047 * x - 0.071 * y + 0.5 * seconds) * std::sin(0.031 * (x + y));
            const int light = static_cast<int>(127.0 + 70.0 * a + 55.0 * b);
            picture.setPixel(x, y, qRgb(light, light, light));
        }
    return picture;
}

/// A show whose clock the test moves.
class MadeUpShow : public SentShowSource {
public:
    MadeUpShow(std::shared_ptr<const Rig> rig, std::shared_ptr<const Installation> room, const double& seconds)
        : rig_(std::move(rig)), room_(std::move(room)), seconds_(seconds) {}
    std::optional<SentShow> now() override {
        return SentShow{rig_, room_, {spotsAt(seconds_)}, std::vector<double>(rig_->actuatorCount(), 0.2)};
    }

private:
    std::shared_ptr<const Rig> rig_;
    std::shared_ptr<const Installation> room_;
    const double& seconds_;
};

struct DriftServiceTest : testing::Test {
    std::shared_ptr<const Rig> rig = std::make_shared<const Rig>(test::cutTablet());
    std::shared_ptr<const Installation> room = [] {
        Installation small = defaultInstallation();
        small.projectors.front().camera = withSize(small.projectors.front().camera, {480, 270});
        return std::make_shared<const Installation>(withLabCamera(small));
    }();
    Notices notices;
    double seconds = 0.0;
    int checks = 0;

    DriftServiceTest() { test::needApplication(); }

    [[nodiscard]] std::unique_ptr<DriftService> serviceWith(ShowCamera camera) {
        return serviceChoosing([camera = std::move(camera)] { return camera; });
    }
    [[nodiscard]] std::unique_ptr<DriftService> serviceChoosing(ShowCameraChooser choose) {
        return std::make_unique<DriftService>(std::make_unique<MadeUpShow>(rig, room, seconds), std::move(choose),
                                              notices, [this] { ++checks; });
    }
    void lookFor(DriftService& service, double duration) {
        for (const double end = seconds + duration; seconds < end; seconds += 2.0) {
            service.look(seconds);
            ASSERT_TRUE(test::eventually([&] { return !service.isLooking(); }));
        }
    }
};

TEST_F(DriftServiceTest, TellsADriftByOneNoticeWithOneButton) {
    const auto service = serviceWith(labShowCamera(pushed(*room, *rig, {"projector", 3e-3, 0.0}, 2)));
    lookFor(*service, 60.0);
    EXPECT_EQ(service->drift().state, DriftReport::State::moved) << service->drift().sentence;
    EXPECT_EQ(service->output().state, OutputReport::State::shown);
    const std::vector<Notice> told = notices.at("calibrate");
    ASSERT_EQ(told.size(), 1U);
    EXPECT_TRUE(told.front().why.contains("projector")) << told.front().why.toStdString();
    ASSERT_EQ(told.front().actions.size(), 1U);
    told.front().actions.front().run();
    EXPECT_EQ(checks, 1);
    service->setWatching(true); // anew, as after a check
    EXPECT_TRUE(notices.at("calibrate").empty());
}

TEST_F(DriftServiceTest, TellsABlackOutputWithinTenSecondsAndTakesItBack) {
    bool isBlack = false;
    const ShowCamera lab = labShowCamera(*room);
    const auto service = serviceWith([&](const ShowLook& look, const SentShow& show, const Progress& progress) {
        ShowLook shown = look;
        if (isBlack) shown.sent = {Image(room->projectors.front().camera.size)};
        return lab(shown, show, progress);
    });
    lookFor(*service, 10.0);
    EXPECT_TRUE(notices.at("calibrate").empty());
    isBlack = true;
    lookFor(*service, 8.0);
    EXPECT_EQ(service->output().state, OutputReport::State::black);
    EXPECT_EQ(notices.at("calibrate").size(), 1U);
    isBlack = false;
    lookFor(*service, 6.0);
    EXPECT_TRUE(notices.at("calibrate").empty());
}

TEST_F(DriftServiceTest, TheLabsCameraSeesTheRigThatIsShown) {
    RigParts parts = rig->parts();
    for (glm::vec3& point : parts.restMesh.positions) point.y += 0.02F;
    const auto higher = std::make_shared<const Rig>(std::move(parts));
    const ShowCamera lab = labShowCamera(*room);
    ShowLook look;
    look.sent = {Image(room->projectors.front().camera.size, {255, 255, 255, 255})};
    const SentShow show{rig, room, {}, std::vector<double>(rig->actuatorCount(), 0.2)};
    const cv::Mat before = lab(look, show, {});
    const cv::Mat after = lab(look, {higher, show.room, {}, show.strokes}, {});
    EXPECT_GT(cv::norm(before, after, cv::NORM_INF), 30.0) << "its edges lie elsewhere";
}

/// A camera of this machine that gives no picture until the test lets it, and says when it is closed, and where.
struct StuckCamera {
    std::mutex mutex;
    std::condition_variable changed;
    bool isFree = false;
    int asked = 0;
    std::vector<std::thread::id> closedBy;

    /// Each is one opened camera.
    ShowCamera open() {
        struct Opened {
            StuckCamera& all;
            explicit Opened(StuckCamera& of) : all(of) {}
            Opened(const Opened&) = delete;
            Opened& operator=(const Opened&) = delete;
            ~Opened() {
                const std::scoped_lock lock(all.mutex);
                all.closedBy.push_back(std::this_thread::get_id());
            }
        };
        return [this, opened = std::make_shared<Opened>(*this)](const ShowLook&, const SentShow&,
                                                                const Progress&) -> cv::Mat {
            std::unique_lock lock(mutex);
            ++asked;
            changed.wait(lock, [this] { return isFree; });
            throw DeviceError("camera", "gives no more pictures", "plug it in again");
        };
    }
    [[nodiscard]] bool isAsked(int times) {
        const std::scoped_lock lock(mutex);
        return asked >= times;
    }
    [[nodiscard]] std::size_t closed() {
        const std::scoped_lock lock(mutex);
        return closedBy.size();
    }
    void free() {
        const std::scoped_lock lock(mutex);
        isFree = true;
        changed.notify_all();
    }
};

TEST_F(DriftServiceTest, StoppingWaitsForNoCamera) {
    StuckCamera camera;
    const auto service = serviceChoosing([&] { return camera.open(); });
    QElapsedTimer since;
    const auto timed = [&](const std::function<void()>& act) {
        since.start();
        act();
        EXPECT_LT(since.elapsed(), 200) << "milliseconds";
    };
    timed([&] { service->setWatching(true); });
    timed([&] { service->look(seconds); });
    ASSERT_TRUE(test::eventually([&] { return camera.isAsked(1); }));
    timed([&] { service->setWatching(false); });
    EXPECT_FALSE(service->isWatching());
    EXPECT_EQ(camera.closed(), 0U) << "it is still asked";
    timed([&] { service->setWatching(true); });
    timed([&] { service->look(seconds += 2.0); });
    timed([&] { service->setWatching(false); });
    EXPECT_FALSE(camera.isAsked(2)) << "not before the first has answered";

    camera.free();
    ASSERT_TRUE(test::eventually([&] { return !service->isLooking() && camera.closed() == 2; }))
        << "and the unused one";
    EXPECT_NE(camera.closedBy.back(), std::this_thread::get_id());
    EXPECT_EQ(service->output().state, OutputReport().state) << "what a stopped watch has seen is nobody's";
    service->setWatching(true);
    service->look(seconds += 2.0);
    ASSERT_TRUE(test::eventually([&] { return camera.isAsked(2) && !service->isLooking(); }));
    service->setWatching(false);
    ASSERT_TRUE(test::eventually([&] { return camera.closed() == 3; }));
    EXPECT_NE(camera.closedBy.back(), std::this_thread::get_id());
}

TEST_F(DriftServiceTest, TheEndWaitsForNoCamera) {
    QElapsedTimer since;
    std::atomic<bool> isAsked = false;
    auto service = serviceWith([&](const ShowLook&, const SentShow&, const Progress& progress) -> cv::Mat {
        isAsked = true; // a camera that gives no picture for long
        for (int i = 0; i < 10'000 && !progress.cancelled(); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        throw Cancelled();
    });
    service->look(seconds);
    ASSERT_TRUE(test::eventually([&] { return isAsked.load(); }));
    since.start();
    service.reset();
    EXPECT_LT(since.elapsed(), 50) << "milliseconds";
}

TEST_F(DriftServiceTest, SaysNothingWhereTheCameraIsAway) {
    const auto service = serviceWith([](const ShowLook&, const SentShow&, const Progress&) -> cv::Mat {
        throw DeviceError("camera", "it is away", "plug it in");
    });
    lookFor(*service, 20.0);
    EXPECT_EQ(service->drift().state, DriftReport::State::blind);
    ASSERT_TRUE(service->drift().obstacle);
    EXPECT_EQ(keyOf(service->drift().obstacle->obstacle), "camera_lost");
    EXPECT_EQ(service->output().state, OutputReport::State::blind);
    EXPECT_TRUE(notices.at("calibrate").empty());
}

} // namespace
} // namespace lumorph::studio
