#include "calibration/delays/flash_capture.h"

#include <chrono>
#include <cmath>
#include <future>
#include <memory>
#include <optional>
#include <stop_token>
#include <string_view>
#include <thread>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "calibration/capture/picture_light.h"

namespace lumorph {

namespace {

constexpr Microseconds kSettles{600'000}; // a picture is seen as it stays
constexpr Microseconds kAfter{700'000};   // the last flash, until nothing of it is on its way
constexpr double kLeastContrast = 8.0;    // grey levels
constexpr unsigned kSeed = 44;
constexpr double kLongestExposure = 1.0 / 30.0; // seconds
constexpr double kArrivalSigma = 0.03;          // seconds: telephones and network cameras take 20 to 100 ms to send

double secondsOf(Microseconds time) { return 1e-6 * static_cast<double>(time.count()); }

cv::Mat flatGrey(cv::Size size, int value) { return {size, CV_8U, cv::Scalar(value)}; }

/// Sleeps until then in short steps, so that it can be cancelled.
void waitUntil(Microseconds time, const Progress& progress) {
    constexpr Microseconds kStep{2'000};
    for (const SteadyClock clock; clock.now() < time; std::this_thread::sleep_for(kStep)) progress.throwIfCancelled();
}

/// What the camera sees of a picture that stays.
cv::Mat1f seenOf(CaptureCamera& camera, PatternDisplay& display, int value, const Progress& progress) {
    display.show(flatGrey(display.size(), value), progress);
    waitUntil(SteadyClock().now() + kSettles, progress);
    const cv::Mat seen = greyOf(camera.grab(progress));
    cv::Mat1f light;
    seen.convertTo(light, CV_32F);
    return light;
}

/// Where the projector's light is seen.
cv::Mat1b litPart(CaptureCamera& camera, PatternDisplay& display, const Progress& progress) {
    const cv::Mat1f white = seenOf(camera, display, 255, progress);
    const cv::Mat1f black = seenOf(camera, display, 0, progress);
    if (white.size() == black.size()) {
        const cv::Mat1f added = white - black;
        double most = 0.0;
        cv::Mat1f calm; // single hot pixels
        cv::blur(added, calm, {5, 5});
        cv::minMaxLoc(calm, nullptr, &most);
        if (most > kLeastContrast) return calm > 0.5 * most;
    }
    delays::refuse(Cause::flashNotSeen, "flashes", "the camera does not see the projector's light",
                   "let it see where that falls, and expose long enough");
}

/// When each picture was asked for, seconds after `origin`.
std::vector<FlashRecording::Flash> flash(PatternDisplay& display, Microseconds origin, int count,
                                         const Progress& progress) {
    const SteadyClock clock;
    const cv::Mat white = flatGrey(display.size(), 255), black = flatGrey(display.size(), 0);
    const double begin = secondsOf(clock.now() - origin) + 0.3;
    std::vector<FlashRecording::Flash> flashes;
    for (const FlashRecording::Flash& planned : planFlashes(count, begin, kSeed)) {
        FlashRecording::Flash asked;
        const auto show = [&](const cv::Mat& picture, double at) {
            waitUntil(origin + Microseconds(std::llround(1e6 * at)), progress);
            const double now = secondsOf(clock.now() - origin);
            display.show(picture, progress);
            return now;
        };
        asked.on = show(white, planned.on);
        // As long as it was meant to be, where the screen was slow to take it.
        asked.off = show(black, asked.on + (planned.off - planned.on));
        flashes.push_back(asked);
        progress.report(static_cast<double>(flashes.size()) / count, "flashing");
    }
    waitUntil(clock.now() + kAfter, progress);
    return flashes;
}

} // namespace

FlashRecording recordFlashes(CaptureCamera& camera, PatternDisplay& display, double drawSeconds,
                             const Progress& progress, int count) {
    const SteadyClock clock;
    progress.report(0.0, "looking where the light falls");
    display.show(flatGrey(display.size(), 255), progress);
    waitUntil(clock.now() + kSettles, progress);
    std::optional<double> exposure = findExposure(camera, progress);
    if (exposure && *exposure > kLongestExposure) { // dark pictures in time tell more than bright ones too late
        exposure = kLongestExposure;
        camera.setExposure(*exposure);
    }
    const cv::Mat1b lit = litPart(camera, display, progress);
    const Microseconds origin = clock.now();
    FlashRecording recording;
    recording.exposure = exposure.value_or(recording.exposure);
    // Another thread shows the flashes: PatternDisplay::show blocks, and camera frames would be missed meanwhile.
    const Progress part = progress.part(0.1, 1.0);
    std::stop_source ended;
    const Progress flashes([&part](double share, std::string_view stage) { part.report(share, stage); },
                           ended.get_token());
    std::future<std::vector<FlashRecording::Flash>> flashing =
        std::async(std::launch::async, [&] { return flash(display, origin, count, flashes); });
    const std::shared_ptr<void> ends(nullptr, [&ended](void*) { ended.request_stop(); }); // where the camera is lost
    while (flashing.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
        const cv::Mat picture = greyOf(camera.next(progress));
        const Microseconds taken =
            camera.takenAt().value_or(clock.now() - Microseconds(std::llround(1e6 * recording.exposure)));
        if (!camera.takenAt()) recording.arrivalSigma = kArrivalSigma;
        if (picture.size() != lit.size()) continue;
        recording.pictures.push_back({secondsOf(taken - origin), cv::mean(picture, lit)[0]});
    }
    recording.flashes = flashing.get();
    for (FlashRecording::Flash& flash : recording.flashes) flash.on -= drawSeconds, flash.off -= drawSeconds;
    display.clear();
    return recording;
}

} // namespace lumorph
