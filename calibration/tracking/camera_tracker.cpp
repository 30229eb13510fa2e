#include "calibration/tracking/camera_tracker.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>

#include "calibration/tracking/board_watch.h"
#include "calibration/tracking/camera_source.h"

namespace lumorph {
namespace {

constexpr std::chrono::seconds kAgain{1};
constexpr std::size_t kRemembered = 100;          // pictures
constexpr Microseconds kPreviewEvery{150'000};    // of as many as a person can tell apart
constexpr Microseconds kAskedLately{1'000'000};   // nobody draws for nobody
constexpr Microseconds kOldestPicture{1'000'000}; // what a driver says may be nonsense
constexpr int kPreviewWidth = 320;
constexpr int kCameraWidth = 1280, kCameraHeight = 720;

} // namespace

struct CameraTracker::Data {
    explicit Data(CameraTrackerOptions wanted)
        : options(std::move(wanted)), live(isCameraPath(options.address.source)), watch(options.address) {}

    void run(const std::stop_token& stop);
    [[nodiscard]] bool openSource(cv::VideoCapture& capture) const;
    void follow(cv::VideoCapture& capture, const std::stop_token& stop);
    [[nodiscard]] bool next(cv::VideoCapture& capture, cv::Mat& picture) const;
    void look(const cv::Mat& picture, Microseconds seen);
    void tell(const BoardView& view, glm::ivec2 size);
    void advise(std::string text, bool open);
    void end();
    void wait(const std::stop_token& stop, std::chrono::microseconds pause);

    CameraTrackerOptions options;
    bool live; ///< a camera, not a file
    BoardWatch watch;
    Microseconds nextPreview{0};
    std::atomic<std::int64_t> asked = 0; ///< when somebody wanted the status
    mutable std::mutex mutex;
    std::condition_variable_any changed;
    CameraTrackerStatus status;
    std::deque<Microseconds> times; ///< of the pictures of the last second
    std::deque<bool> found;         ///< of the last hundred
    std::jthread thread;            ///< last, so that it ends before what it uses
};

void CameraTracker::Data::advise(std::string text, bool open) {
    const std::scoped_lock lock(mutex);
    status.advice = std::move(text);
    status.open = open;
    if (open) return;
    status.sighting.reset();
    status.picturesPerSecond = 0.0;
    times.clear();
}

void CameraTracker::Data::end() {
    advise("The video has come to its end. Write repeat=yes into the address to let it begin anew.", false);
    const std::scoped_lock lock(mutex);
    status.ended = true;
}

void CameraTracker::Data::wait(const std::stop_token& stop, std::chrono::microseconds pause) {
    std::unique_lock lock(mutex);
    changed.wait_for(lock, stop, pause, [] { return false; });
}

bool CameraTracker::Data::openSource(cv::VideoCapture& capture) const {
    const std::string& source = options.address.source;
    if (!live) return capture.open(source, cv::CAP_FFMPEG);
    if (!capture.open(source, cv::CAP_V4L2)) return false;
    // Webcams send large pictures quickly only when they are compressed.
    capture.set(cv::CAP_PROP_FOURCC, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'));
    capture.set(cv::CAP_PROP_FRAME_WIDTH, kCameraWidth);
    capture.set(cv::CAP_PROP_FRAME_HEIGHT, kCameraHeight);
    capture.set(cv::CAP_PROP_BUFFERSIZE, 1); // old pictures are worth nothing
    return true;
}

void CameraTracker::Data::run(const std::stop_token& stop) {
    // What goes wrong is told in words of ours.
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    while (!stop.stop_requested()) {
        cv::VideoCapture capture;
        const std::string& source = options.address.source;
        const SourceFacts facts = lookAt(source);
        try {
            if (facts.permitted && openSource(capture)) {
                follow(capture, stop);
                if (stop.stop_requested() || status.ended) return;
                advise("The camera at " + source + " gives no more pictures. Plug it in again; it is found by itself.",
                       false);
            } else {
                advise(adviceFor(source, facts), false);
            }
        } catch (const std::exception& error) {
            advise("The pictures of " + source + " cannot be used: " + error.what() + ".", false);
        }
        wait(stop, kAgain);
    }
}

/// False at the end.
bool CameraTracker::Data::next(cv::VideoCapture& capture, cv::Mat& picture) const {
    if (capture.read(picture) && !picture.empty()) return true;
    return !live && options.address.repeat && capture.open(options.address.source, cv::CAP_FFMPEG) &&
           capture.read(picture) && !picture.empty();
}

void CameraTracker::Data::follow(cv::VideoCapture& capture, const std::stop_token& stop) {
    const double rate = capture.get(cv::CAP_PROP_FPS);
    const Microseconds period(live || !(rate > 0.1) ? 0 : static_cast<std::int64_t>(1e6 / rate));
    Microseconds due = options.clock->now();
    cv::Mat picture;
    while (!stop.stop_requested()) {
        if (!next(capture, picture)) {
            if (!live) end();
            return;
        }
        Microseconds seen = options.clock->now();
        if (live) { // the driver tells when, by the clock that is ours too
            const Microseconds told(static_cast<std::int64_t>(1e3 * capture.get(cv::CAP_PROP_POS_MSEC)));
            if (told <= seen && seen - told < kOldestPicture) seen = told;
        }
        look(picture, seen);
        due += period;
        const Microseconds now = options.clock->now();
        if (live || due < now - kOldestPicture) due = now; // it cannot keep up, and does not try to catch up
        if (due > now) wait(stop, due - now);
    }
}

void CameraTracker::Data::look(const cv::Mat& picture, Microseconds seen) {
    const BoardView view = watch.look(picture);
    BoardPicture told{0, seen, view.world};
    {
        const std::scoped_lock lock(mutex);
        told.number = status.pictures + 1;
    }
    tell(view, {picture.cols, picture.rows});
    if (options.onPicture) options.onPicture(told);
}

void CameraTracker::Data::tell(const BoardView& view, glm::ivec2 size) {
    const Microseconds now = options.clock->now();
    std::shared_ptr<const Image> preview;
    if (now >= nextPreview && now - Microseconds(asked) < kAskedLately) {
        preview = std::make_shared<const Image>(watch.preview(kPreviewWidth));
        nextPreview = now + kPreviewEvery;
    }
    const std::scoped_lock lock(mutex);
    times.push_back(now);
    while (times.front() <= now - std::chrono::seconds(1)) times.pop_front();
    found.push_back(view.sighting.has_value());
    if (found.size() > kRemembered) found.pop_front();
    ++status.pictures;
    status.open = true;
    status.size = size;
    status.sighting = view.sighting;
    status.picturesPerSecond = static_cast<double>(times.size());
    status.foundShare =
        static_cast<double>(std::count(found.begin(), found.end(), true)) / static_cast<double>(found.size());
    status.advice = view.advice;
    status.assumptions = watch.assumptions();
    if (preview) status.preview = std::move(preview);
}

CameraTracker::CameraTracker(CameraTrackerOptions options) : data_(std::make_unique<Data>(std::move(options))) {
    data_->asked = data_->options.clock->now().count();
    data_->status.assumptions = data_->watch.assumptions();
    data_->thread = std::jthread([data = data_.get()](const std::stop_token& stop) { data->run(stop); });
}

CameraTracker::~CameraTracker() = default;

CameraTrackerStatus CameraTracker::status() const {
    data_->asked = data_->options.clock->now().count();
    const std::scoped_lock lock(data_->mutex);
    return data_->status;
}

} // namespace lumorph
