#include "calibration/verify/drift_watch.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "calibration/lab/check_lab.h"
#include "calibration/lab/lab_world.h"
#include "calibration/lab/moved_room.h"
#include "calibration/verify/output_watch.h"
#include "calibration/verify/verify_lab.h"
#include "core/loop/match_loop.h"
#include "core/loop/show_stage.h"
#include "core/render/gl/headless_context.h"
#include "core/render/spatial_renderer.h"
#include "core/scene/scene_assets.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/long_tests.h"

namespace lumorph::test {
namespace {

const Rig& watchedRig() {
    static const Rig rig = test::cutTablet();
    return rig;
}

/// A projector and a camera of few pixels: a show of eight hours is rendered.
Installation watchedRoom(int camera) {
    Installation room = defaultInstallation();
    CalibratedCamera& lamp = room.projectors.front().camera;
    lamp = withSize(lamp, {480, 270});
    room = withLabCamera(room);
    CalibratedCamera& eye = room.cameras.front().camera;
    eye = withSize(eye, {camera, camera * 4 / 5});
    return room;
}

/// What a show may look like: clouds of all sizes that drift, of other colours each few minutes.
class Clouds {
public:
    explicit Clouds(glm::ivec2 size) : size_(size) {
        std::mt19937 random(7);
        std::uniform_real_distribution<float> any(0.0F, 1.0F);
        for (int octave = 0; octave < 3; ++octave) {
            cv::Mat1f coarse(9 << octave, 16 << octave);
            for (float& value : coarse) value = any(random);
            cv::Mat1f fine;
            cv::resize(coarse, fine, {2 * size.x, 2 * size.y}, 0.0, 0.0, cv::INTER_CUBIC);
            octaves_.push_back(fine);
        }
    }
    /// `seconds` since the show began; `brightness` 0 is black.
    [[nodiscard]] Image at(double seconds, double brightness = 1.0) const {
        cv::Mat1f sum = cv::Mat1f::zeros(size_.y, size_.x);
        for (std::size_t i = 0; i < octaves_.size(); ++i) {
            const double way = 3.0 * seconds * (1.0 + 0.4 * static_cast<double>(i));
            const auto x = static_cast<int>(way) % size_.x, y = static_cast<int>(0.7 * way) % size_.y;
            sum += octaves_[i](cv::Rect(x, y, size_.x, size_.y)) * (0.5 / (1.0 + static_cast<double>(i)));
        }
        const double hue = 0.004 * seconds;
        const auto share = [hue](double phase) { return 0.7 + 0.3 * std::cos(hue + phase); };
        const double red = share(0.0), green = share(2.1), blue = share(4.2);
        Image image(size_);
        for (int row = 0; row < size_.y; ++row)
            for (int column = 0; column < size_.x; ++column) {
                const double light = 255.0 * brightness * std::clamp(static_cast<double>(sum(row, column)), 0.0, 1.0);
                image.at(column, row) = {static_cast<std::uint8_t>(light * red),
                                         static_cast<std::uint8_t>(light * green),
                                         static_cast<std::uint8_t>(light * blue), 255};
            }
        return image;
    }

private:
    glm::ivec2 size_;
    std::vector<cv::Mat1f> octaves_;
};

/// A show in a room that is not quite what the watch believes, photographed when asked.
class WatchedShow {
public:
    WatchedShow(Installation truth, int camera, std::uint32_t seed)
        : truth_(std::move(truth)), believed_(watchedRoom(camera)), clouds_(believed_.projectors.front().camera.size),
          random_(seed), seed_(seed) {}

    /// Bends change each ten minutes; a hand reaches in for a part of the time.
    [[nodiscard]] ShowLook look(double seconds, bool isHandThere = false, double brightness = 1.0) {
        const int bend = static_cast<int>(seconds / 600.0) % 3;
        std::vector<double> strokes(watchedRig().actuatorCount(), 0.0);
        for (std::size_t i = 0; i < strokes.size(); ++i)
            if (bend > 0 && i % 2 == static_cast<std::size_t>(bend - 1)) strokes[i] = 0.45;
        ShowLook look{seconds, {}, {clouds_.at(seconds, brightness)}, strokes};
        look.photograph = labFor(bend, isHandThere ? 1 + static_cast<int>(random_() % 3) : 0).photograph(look.sent);
        return look;
    }
    /// What the camera sees of another picture.
    [[nodiscard]] cv::Mat photograph(const Image& picture) {
        return labFor(0, 0).photograph(std::vector<Image>{picture});
    }
    [[nodiscard]] Image content(double seconds, double brightness = 1.0) const {
        return clouds_.at(seconds, brightness);
    }
    [[nodiscard]] const Installation& believed() const { return believed_; }
    [[nodiscard]] double chance() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
    void setTruth(const Installation& truth) {
        truth_ = truth;
        labs_.clear();
    }

private:
    CheckLab& labFor(int bend, int hand) {
        const auto known = labs_.find({bend, hand});
        if (known != labs_.end()) return known->second;
        std::vector<double> strokes(watchedRig().actuatorCount(), 0.0);
        for (std::size_t i = 0; i < strokes.size(); ++i)
            if (bend > 0 && i % 2 == static_cast<std::size_t>(bend - 1)) strokes[i] = 0.45;
        CheckLabOptions options;
        options.isLinear = false;
        const glm::vec3 eye(0.0F, 0.45F, 0.55F);
        const glm::vec3 places[] = {{0.1F, 0.08F, 0.02F}, {-0.05F, 0.12F, 0.0F}, {0.02F, 0.06F, 0.08F}};
        if (hand > 0) options.hands = {visitorHand(places[hand - 1], eye)};
        return labs_.try_emplace({bend, hand}, truth_, watchedRig(), strokes, options, seed_ + 17U).first->second;
    }

    Installation truth_, believed_;
    Clouds clouds_;
    std::mt19937 random_;
    std::uint32_t seed_;
    std::map<std::pair<int, int>, CheckLab> labs_;
};

Installation pushedRoom(const std::string& push, int camera, std::uint32_t seed) {
    const Installation room = watchedRoom(camera);
    return push.empty() ? room : pushed(room, watchedRig(), parseLabPush(push, watchedRig()), seed);
}

constexpr int kWatched = 320; // pixels of the camera
constexpr double kLookEvery = 5.0;

// Bar: a drift of 3 mm is found within 60 s, also while hands reach in.
TEST(DriftWatch, FindsThreeMillimetresWithinAMinute) {
    const std::uint32_t seeds = longTests() ? 6 : 1;
    for (const char* part : {"projector", "camera", "device"})
        for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
            WatchedShow show(pushedRoom("", kWatched, seed), kWatched, seed);
            DriftWatch watch(watchedRig(), show.believed());
            double now = 570.0; // a bend before and one after
            for (; now < 620.0; now += kLookEvery) {
                watch.look(show.look(now, show.chance() < 0.3));
                EXPECT_NE(watch.report().state, DriftReport::State::moved);
            }
            show.setTruth(pushedRoom(std::string(part) + ":3mm", kWatched, seed));
            const double pushedAt = now;
            while (now < pushedAt + 120.0 && watch.report().state != DriftReport::State::moved) {
                watch.look(show.look(now, show.chance() < 0.3));
                now += kLookEvery;
            }
            const DriftReport& report = watch.report();
            std::printf("%s: after %.0f s: %s (%.2f mm, sigma %.2f, %d cells)\n", part, now - pushedAt - kLookEvery,
                        report.sentence.c_str(), 1e3 * report.beside, 1e3 * report.sigma, report.cells);
            ASSERT_EQ(report.state, DriftReport::State::moved);
            EXPECT_LE(now - pushedAt, 60.0);
            EXPECT_EQ(report.part, part);
            EXPECT_TRUE(report.couldAlsoBe.empty());
            EXPECT_NEAR(report.beside, 3e-3, 1e-3);
        }
}

/// What the default scene sends: wood and paper, of which most is so faint that noise hides it.
Image faintPicture(const Installation& believed) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    MatchWish wish;
    wish.rig = std::make_shared<const Rig>(watchedRig());
    wish.driver = Driver::hand;
    wish.strokes.assign(watchedRig().actuatorCount(), 0.0);
    wish.scene = std::make_shared<const Scene>(defaultScene());
    wish.installation = std::make_shared<const Installation>(believed);
    wish.assets = loadSceneAssets(*wish.scene, {});
    const ManualClock clock;
    renderer.draw(ShowStage().frame(*MatchLoop(clock).step(wish, 0.0)));
    return renderer.readProjector(0);
}

// A watch begins anew with each edit of the room, and knows nothing of its camera's brightness then.
TEST(DriftWatch, ANewWatchOverFaintContentTellsThatTheProjectorHasMoved) {
    Installation truth = withLabCamera(defaultInstallation());
    InstalledProjector& lamp = truth.projectors.front();
    lamp.camera = withSize(lamp.camera, {960, 540});
    CalibratedCamera& eye = truth.cameras.front().camera;
    eye = withSize(eye, {kWatched, kWatched * eye.size.y / eye.size.x});
    const std::vector<double> strokes(watchedRig().actuatorCount(), 0.0);
    CheckLabOptions options;
    options.isLinear = false;
    std::map<double, Image> pictures;
    const auto watched = [&](double metres, std::uint32_t seed, const std::function<void(cv::Mat&)>& spoil) {
        Installation believed = truth;
        believed.projectors.front().camera.cameraFromWorld[3].x += metres;
        if (!pictures.contains(metres)) pictures.emplace(metres, faintPicture(believed));
        const std::vector<Image> sent{pictures.at(metres)};
        CheckLab lab(truth, watchedRig(), strokes, options, seed);
        DriftWatch watch(watchedRig(), believed);
        for (int k = 0; k < 6; ++k) {
            ShowLook look{kLookEvery * k, lab.photograph(sent), sent, strokes};
            if (spoil) spoil(look.photograph);
            watch.look(look);
        }
        std::printf("%.1f mm: %s (%.2f mm, %d cells)\n", 1e3 * metres, watch.report().sentence.c_str(),
                    1e3 * watch.report().beside, watch.report().cells);
        return watch.report();
    };
    for (const std::uint32_t seed : {41U, 42U}) {
        EXPECT_EQ(watched(0.0, seed, {}).state, DriftReport::State::good);
        for (const double metres : {2.5e-3, 3e-3}) {
            const DriftReport moved = watched(metres, seed, {});
            EXPECT_EQ(moved.state, DriftReport::State::moved);
            EXPECT_EQ(moved.part, "projector");
            EXPECT_NEAR(moved.beside, metres, 1e-3);
        }
    }
    // What covers the camera, or darkens it, is no drift, also where nothing is known yet.
    WatchedShow other(pushedRoom("", kWatched, 44), kWatched, 44);
    cv::Mat cloth(eye.size.y, eye.size.x, CV_8U);
    const auto covered = [&](const std::function<void(cv::Mat&)>& spoil) {
        for (const double metres : {0.0, 3e-3}) EXPECT_EQ(watched(metres, 45, spoil).state, DriftReport::State::blind);
    };
    covered([&](cv::Mat& picture) {
        cv::randn(cloth, 70, 3);
        picture = cloth;
    });
    covered([](cv::Mat& picture) { picture *= 0.03; });
    covered([&](cv::Mat& picture) { picture = other.photograph(other.content(4000.0)); });
    covered([](cv::Mat& picture) { cv::flip(picture, picture, 1); });
}

// Bar: half a millimetre is not reported.
TEST(DriftWatch, LeavesHalfAMillimetreAlone) {
    for (const char* part : {"projector", "camera", "device"}) {
        WatchedShow show(pushedRoom(std::string(part) + ":0.5mm", kWatched, 5), kWatched, 5);
        DriftWatch watch(watchedRig(), show.believed());
        double most = 0.0;
        for (double now = 500.0; now < 740.0; now += kLookEvery) {
            watch.look(show.look(now, show.chance() < 0.2));
            EXPECT_NE(watch.report().state, DriftReport::State::moved) << watch.report().sentence;
            if (watch.report().state == DriftReport::State::good) most = std::max(most, watch.report().beside);
        }
        std::printf("%s off by 0.5 mm: at most %.2f mm found in four minutes, said: %s\n", part, 1e3 * most,
                    watch.report().sentence.c_str());
        EXPECT_GT(most, 0.0);
    }
}

// Bar: no false alarm in eight hours, of which the short form shows three: a calibration that is off by 0.3 mm, a lamp
// that ages, daylight that comes and goes, hands, dark scenes, a camera that is dark or away for a while.
TEST(DriftWatch, RaisesNoFalseAlarmInEightHours) {
    constexpr int kSmall = 192;
    const double hours = longTests() ? 8.0 : 3.0;
    const double every = longTests() ? 5.0 : 10.0;
    WatchedShow show(pushedRoom("projector:0.3mm", kSmall, 11), kSmall, 11);
    DriftWatchOptions options;
    options.width = kSmall;
    DriftWatch watch(watchedRig(), show.believed(), options);
    std::map<DriftReport::State, int> states;
    double most = 0.0;
    const auto start = std::chrono::steady_clock::now();
    for (double now = 0.0; now < hours * 3600.0; now += every) {
        const double minute = now / 60.0;
        const bool isDark = std::fmod(minute, 47.0) < 2.0;
        ShowLook look = show.look(now, show.chance() < 0.15, isDark ? 0.02 : 1.0 - 0.15 * minute / (60.0 * hours));
        const double daylight = 12.0 + 12.0 * std::sin(0.013 * minute);
        look.photograph += cv::Scalar(daylight);
        if (std::fmod(minute, 101.0) < 1.0) look.photograph.release();
        if (std::fmod(minute, 89.0) < 1.0) look.photograph *= 0.02;
        watch.look(look);
        ++states[watch.report().state];
        if (watch.report().state == DriftReport::State::good) most = std::max(most, watch.report().beside);
        ASSERT_NE(watch.report().state, DriftReport::State::moved)
            << "after " << minute << " minutes: " << watch.report().sentence;
    }
    const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const int looks =
        states[DriftReport::State::good] + states[DriftReport::State::blind] + states[DriftReport::State::watching];
    std::printf("%.0f hours, %d looks in %.0f s: good %d, blind %d, watching %d; at most %.2f mm found\n", hours, looks,
                took, states[DriftReport::State::good], states[DriftReport::State::blind],
                states[DriftReport::State::watching], 1e3 * most);
    EXPECT_GT(states[DriftReport::State::good], looks * 8 / 10);
}

TEST(DriftWatch, SaysWhyItCannotTell) {
    WatchedShow show(pushedRoom("", kWatched, 2), kWatched, 2);
    DriftWatch watch(watchedRig(), show.believed());
    double now = 0.0;
    const auto obstacle = [&](const std::function<void(cv::Mat&)>& spoil, double brightness = 1.0) {
        ShowLook look = show.look(now += 5.0, false, brightness);
        spoil(look.photograph);
        watch.look(look);
        std::printf("%s\n", watch.report().sentence.c_str());
        EXPECT_EQ(watch.report().state, DriftReport::State::blind);
        return watch.report().obstacle ? std::string(keyOf(watch.report().obstacle->obstacle)) : std::string();
    };
    for (int i = 0; i < 3; ++i) watch.look(show.look(now += 5.0));
    EXPECT_EQ(watch.report().state, DriftReport::State::good);
    EXPECT_EQ(obstacle([](cv::Mat& picture) { picture.release(); }), "camera_lost");
    EXPECT_EQ(obstacle([](cv::Mat& picture) { picture *= 0.01; }), "too_dark");
    EXPECT_EQ(obstacle([](cv::Mat& picture) { cv::GaussianBlur(picture, picture, {}, 14.0); }), "blurred");
    EXPECT_EQ(obstacle([&](cv::Mat& picture) { picture = show.photograph(show.content(4000.0)); }), "covered");
    EXPECT_EQ(obstacle([](cv::Mat&) {}, 0.0), "no_light");
    EXPECT_EQ(obstacle([](cv::Mat& picture) { cv::resize(picture, picture, {100, 100}); }), "camera_lost");
}

// Bar: black and frozen outputs are told within ten seconds; dark or still content is no fault.
TEST(OutputWatch, TellsBlackAndFrozenWithinTenSeconds) {
    constexpr double kEvery = 2.0;
    WatchedShow show(pushedRoom("", kWatched, 3), kWatched, 3);
    double now = 100.0;
    const auto healthy = [&](OutputWatch& watch, double seconds) {
        for (const double end = now + seconds; now < end; now += kEvery) {
            watch.look(show.look(now, show.chance() < 0.3));
            EXPECT_NE(watch.report().state, OutputReport::State::black);
            EXPECT_NE(watch.report().state, OutputReport::State::frozen);
        }
    };
    const auto secondsUntil = [&](OutputWatch& watch, OutputReport::State fault, const Image& shown) {
        const double begin = now;
        for (; now < begin + 30.0; now += kEvery) {
            ShowLook look = show.look(now);
            look.photograph = show.photograph(shown);
            watch.look(look);
            if (watch.report().state == fault) return now - begin;
        }
        return 1e9;
    };
    OutputWatch watch(watchedRig(), show.believed());
    healthy(watch, 20.0);
    const double black = secondsUntil(watch, OutputReport::State::black, show.content(now, 0.0));
    healthy(watch, 0.0);
    for (int i = 0; i < 6; ++i, now += kEvery) watch.look(show.look(now));
    EXPECT_EQ(watch.report().state, OutputReport::State::shown);
    const double frozen = secondsUntil(watch, OutputReport::State::frozen, show.content(now - kEvery));
    std::printf("black found after %.0f s, frozen after %.0f s\n", black, frozen);
    EXPECT_LE(black, 10.0);
    EXPECT_LE(frozen, 10.0);

    OutputWatch fromTheStart(watchedRig(), show.believed());
    const double first = secondsUntil(fromTheStart, OutputReport::State::black, show.content(now, 0.0));
    std::printf("black from the start found after %.0f s\n", first);
    EXPECT_LE(first, 10.0);

    OutputWatch still(watchedRig(), show.believed());
    healthy(still, 10.0);
    for (const double end = now + 30.0; now < end; now += kEvery) { // still content
        ShowLook look = show.look(200.0);
        look.seconds = now;
        EXPECT_EQ(still.look(look).state, OutputReport::State::shown);
    }
    for (const double end = now + 30.0; now < end; now += kEvery) { // a dark scene
        still.look(show.look(now, false, 0.0));
        EXPECT_NE(still.report().state, OutputReport::State::black);
        EXPECT_NE(still.report().state, OutputReport::State::frozen);
    }
}

} // namespace
} // namespace lumorph::test
