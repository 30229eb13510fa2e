#include "calibration/tracking/camera_tracker.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

namespace lumorph {
namespace {

constexpr std::chrono::seconds kAgain{1};
constexpr std::size_t kRemembered = 100; // pictures
constexpr double kPoorFit = 1.5;         // pixels

bool isNumber(const std::string& text) {
    return !text.empty() && text.size() < 4 &&
           std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool isCamera(const std::string& source) { return isNumber(source) || source.starts_with("/dev/"); }

bool openSource(cv::VideoCapture& capture, const CameraTrackerOptions& options) {
    const bool opened =
        isNumber(options.source) ? capture.open(std::stoi(options.source), cv::CAP_V4L2) : capture.open(options.source);
    if (opened && isCamera(options.source)) {
        capture.set(cv::CAP_PROP_FRAME_WIDTH, options.camera.size.x);
        capture.set(cv::CAP_PROP_FRAME_HEIGHT, options.camera.size.y);
        capture.set(cv::CAP_PROP_BUFFERSIZE, 1); // old pictures are worth nothing
    }
    return opened;
}

} // namespace

struct CameraTracker::Data {
    explicit Data(CameraTrackerOptions wanted) : options(std::move(wanted)), finder(options.board, options.camera) {}

    void run(const std::stop_token& stop);
    void watch(cv::VideoCapture& capture, const std::stop_token& stop);
    void look(const cv::Mat& picture);
    void tell(const std::optional<BoardSighting>& sighting);
    void advise(std::string text, bool open);
    void wait(const std::stop_token& stop, std::chrono::microseconds pause);

    CameraTrackerOptions options;
    BoardFinder finder;
    cv::Mat grey;
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
}

void CameraTracker::Data::wait(const std::stop_token& stop, std::chrono::microseconds pause) {
    std::unique_lock lock(mutex);
    changed.wait_for(lock, stop, pause, [] { return false; });
}

void CameraTracker::Data::run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
        cv::VideoCapture capture;
        if (openSource(capture, options)) {
            advise({}, true);
            watch(capture, stop);
            if (status.ended) return;
            advise("The camera " + options.source + " gives no more pictures; plug it in again.", false);
        } else {
            advise("The camera or file " + options.source +
                       " cannot be opened; check that it is there and that no other program uses it.",
                   false);
        }
        wait(stop, kAgain);
    }
}

void CameraTracker::Data::watch(cv::VideoCapture& capture, const std::stop_token& stop) {
    const bool live = isCamera(options.source);
    const double rate = capture.get(cv::CAP_PROP_FPS);
    const Microseconds period(live || !(rate > 0.0) ? 0 : static_cast<std::int64_t>(1e6 / rate));
    Microseconds due = options.clock->now();
    cv::Mat picture;
    while (!stop.stop_requested()) {
        if (!capture.read(picture) || picture.empty()) {
            if (live || (options.repeat && capture.open(options.source))) {
                if (live) return;
                continue;
            }
            const std::scoped_lock lock(mutex);
            status.ended = true;
            status.open = false;
            return;
        }
        look(picture);
        due += period;
        const Microseconds left = due - options.clock->now();
        if (left > Microseconds{0}) wait(stop, left);
    }
}

void CameraTracker::Data::look(const cv::Mat& picture) {
    const Microseconds seen = options.clock->now();
    const glm::ivec2 size = options.camera.size;
    if (picture.cols != size.x || picture.rows != size.y) {
        tell(std::nullopt);
        advise("The camera gives pictures of " + std::to_string(picture.cols) + " x " + std::to_string(picture.rows) +
                   ", but was calibrated at " + std::to_string(size.x) + " x " + std::to_string(size.y) +
                   "; calibrate it at this size.",
               true);
        return;
    }
    if (picture.channels() == 1)
        picture.copyTo(grey);
    else
        cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
    if (!grey.isContinuous()) grey = grey.clone();
    const auto sighting = finder.find({grey.ptr<std::uint8_t>(), grey.total()});
    PoseSample sample{seen, sighting.has_value(), {}};
    if (sighting) sample.pose = worldFromDevice(*sighting, options.camera, options.deviceFromBoard);
    if (options.onPose) options.onPose(sample);
    tell(sighting);
}

void CameraTracker::Data::tell(const std::optional<BoardSighting>& sighting) {
    const Microseconds now = options.clock->now();
    const std::scoped_lock lock(mutex);
    times.push_back(now);
    while (times.front() <= now - std::chrono::seconds(1)) times.pop_front();
    found.push_back(sighting.has_value());
    if (found.size() > kRemembered) found.pop_front();
    ++status.pictures;
    status.sighting = sighting;
    status.picturesPerSecond = static_cast<double>(times.size());
    status.foundShare =
        static_cast<double>(std::count(found.begin(), found.end(), true)) / static_cast<double>(found.size());
    status.advice.clear();
    if (!sighting)
        status.advice = "The board is not to be seen; turn it to the camera, and give it even light.";
    else if (sighting->reprojectionError > kPoorFit)
        status.advice = "The board does not fit its picture well; measure its squares, and calibrate the camera.";
}

CameraTracker::CameraTracker(CameraTrackerOptions options) : data_(std::make_unique<Data>(std::move(options))) {
    data_->thread = std::jthread([data = data_.get()](const std::stop_token& stop) { data->run(stop); });
}

CameraTracker::~CameraTracker() = default;

CameraTrackerStatus CameraTracker::status() const {
    const std::scoped_lock lock(data_->mutex);
    return data_->status;
}

} // namespace lumorph
