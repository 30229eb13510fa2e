#include "calibration/capture/capture_camera.h"

#include <algorithm>
#include <mutex>

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "calibration/capture/camera_controls.h"
#include "calibration/capture/genicam_camera.h"
#include "calibration/capture/mjpeg_camera.h"
#include "calibration/lab/board_lab.h"
#include "calibration/tracking/camera_source.h"
#include "core/base/clock.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr int kMostSkipped = 30; // frames that a driver may hold back

/// What goes wrong is told in words of ours.
void silenceVideo() {
    static std::once_flag once;
    std::call_once(once, [] { cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT); });
}

} // namespace

void requireReadable(const std::string& camera, cv::Size picture) {
    constexpr int kLeastSide = 200; // pixels: no board is read in less
    if (std::min(picture.width, picture.height) >= kLeastSide) return;
    throw DeviceError("camera " + camera,
                      "gives pictures of " + std::to_string(picture.width) + " x " + std::to_string(picture.height) +
                          " pixels",
                      "at least " + std::to_string(kLeastSide) + " along each side are needed: choose a larger size");
}

void CaptureCamera::setExposure(double /*seconds*/) {
    throw DeviceError("camera " + name(), "its exposure cannot be set from here", "use another camera");
}

namespace {

class DriverCamera final : public CaptureCamera {
public:
    DriverCamera(std::string path, cv::Size most) : path_(std::move(path)) {
        silenceVideo();
        const SourceFacts facts = lookAt(path_);
        if (!facts.permitted || !capture_.open(path_, cv::CAP_V4L2))
            throw DeviceError("camera " + path_, "cannot be opened", adviceFor(path_, facts));
        // Webcams send large pictures quickly only when they are compressed.
        capture_.set(cv::CAP_PROP_FOURCC, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'));
        if (!most.empty()) {
            capture_.set(cv::CAP_PROP_FRAME_WIDTH, most.width);
            capture_.set(cv::CAP_PROP_FRAME_HEIGHT, most.height);
        }
        capture_.set(cv::CAP_PROP_BUFFERSIZE, 1);
        for (int warming = 0; warming < 5; ++warming) read(); // automatics find their values before they are held
        automatics_ = switchAutomaticsOff(controlsOf(path_));
    }

    [[nodiscard]] cv::Mat grab(const Progress& progress) override {
        const Microseconds called = clock_.now();
        for (int skipped = 0; skipped < kMostSkipped; ++skipped) {
            progress.throwIfCancelled();
            const Microseconds asked = clock_.now();
            cv::Mat picture = read();
            const Microseconds arrived = clock_.now();
            const Microseconds told(static_cast<std::int64_t>(1e3 * capture_.get(cv::CAP_PROP_POS_MSEC)));
            // Drivers tell by the same clock when a frame began or ended; where it ended, its exposure began up to a
            // frame earlier.
            if (told > Microseconds(0) && told <= arrived && arrived - told < Microseconds(1'000'000)) {
                if (told - interval() >= called) return picture;
                continue;
            }
            // Without a time: a frame that was waited for began after the one before, which came after the call.
            const bool isWaitedFor = arrived - asked > Microseconds(interval().count() / 3);
            if (isWaitedFor && skipped >= 2) return picture;
        }
        throw DeviceError("camera " + path_, "gives only old frames", "unplug it and plug it in again");
    }
    [[nodiscard]] std::string name() const override { return path_; }
    [[nodiscard]] cv::Size size() const override { return size_; }
    [[nodiscard]] std::vector<std::string> automatics() const override { return automatics_; }
    [[nodiscard]] std::optional<Exposures> exposures() const override {
        const auto range = rangeOfExposure(path_);
        if (!range) return std::nullopt;
        // Longer than a frame would slow the pictures down.
        const double frame = 1e-6 * static_cast<double>(interval().count());
        return Exposures{range->first, std::clamp(frame, range->first, range->second)};
    }
    void setExposure(double seconds) override {
        if (!lumorph::setExposure(controlsOf(path_), seconds))
            throw DeviceError("camera " + path_,
                              "does not take an exposure of " + std::to_string(1e3 * seconds) + " ms",
                              "switch its automatic exposure off, or use another camera");
    }

private:
    cv::Mat read() {
        cv::Mat picture;
        bool isRead = false;
        try {
            isRead = capture_.read(picture);
        } catch (const cv::Exception& error) {
            throw DeviceError("camera " + path_, "its pictures cannot be used: " + error.err, "choose another camera");
        }
        if (!isRead || picture.empty())
            throw DeviceError("camera " + path_, "gives no more pictures", "plug it in again, then capture this pose");
        if (picture.depth() != CV_8U || (picture.channels() != 1 && picture.channels() != 3))
            throw DeviceError("camera " + path_, "gives pictures that are not 8-bit grey or colour",
                              "choose another format at the camera");
        requireReadable(path_, size_ = picture.size());
        return picture.clone(); // the driver's buffer is used again
    }
    [[nodiscard]] Microseconds interval() const {
        const double rate = capture_.get(cv::CAP_PROP_FPS);
        return Microseconds(static_cast<std::int64_t>(1e6 / (rate > 1.0 && rate < 1000.0 ? rate : 30.0)));
    }

    std::string path_;
    cv::VideoCapture capture_;
    cv::Size size_;
    SteadyClock clock_;
    std::vector<std::string> automatics_;
};

class LabCamera final : public CaptureCamera {
public:
    explicit LabCamera(BoardLab& lab) : lab_(lab) {}

    [[nodiscard]] cv::Mat grab(const Progress& progress) override {
        progress.throwIfCancelled();
        return lab_.photograph();
    }
    [[nodiscard]] std::string name() const override { return "virtual lab"; }
    [[nodiscard]] cv::Size size() const override { return {lab_.camera().size.x, lab_.camera().size.y}; }

private:
    BoardLab& lab_;
};

} // namespace

std::unique_ptr<CaptureCamera> openCaptureCamera(const std::string& path, cv::Size most) {
    if (isMjpegAddress(path)) return openMjpegCamera(path);
    if (isGenicamAddress(path)) return openGenicamCamera(path);
    return std::make_unique<DriverCamera>(path, most);
}

bool isSimulatedCamera(const std::string& address) {
    return address.starts_with("genicam://Aravis-Fake-") ||
           (isMjpegAddress(address) && address.ends_with("/lumorph-table"));
}

std::unique_ptr<CaptureCamera> openLabCamera(BoardLab& lab) { return std::make_unique<LabCamera>(lab); }

cv::Mat greyOf(const cv::Mat& picture) {
    if (picture.channels() == 1) return picture;
    cv::Mat grey;
    cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
    return grey;
}

Image imageOfGrey(const cv::Mat& grey) {
    Image image({grey.cols, grey.rows});
    auto* to = image.pixels().data();
    for (int y = 0; y < grey.rows; ++y)
        for (const uchar* from = grey.ptr(y); from != grey.ptr(y) + grey.cols; ++from, ++to)
            *to = {*from, *from, *from, 255};
    return image;
}

} // namespace lumorph
