#include "calibration/capture/genicam_camera.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>
#include <thread>
#include <utility>

#include <arv.h>
#include <opencv2/imgproc.hpp>

#include "core/base/error.h"

namespace lumorph {

namespace {

using namespace std::chrono_literals;

constexpr std::string_view kGenicamScheme = "genicam://";
constexpr guint kBuffers = 4;
constexpr guint64 kPopWait = 50'000; ///< microseconds between looks at whether it is still wanted
constexpr auto kFrameWithin = 10s;   ///< for a picture
constexpr auto kOthersLeave = 5s;
constexpr int kMostIncomplete = 20;
constexpr int kFirstFrames =
    3;                       ///< after a start: their way takes longer, and how long it usually takes is not known yet
constexpr gint64 kDrift = 5; ///< microseconds a frame, of the camera's clock against this machine's

struct Unref {
    void operator()(void* object) const {
        if (object) g_object_unref(object);
    }
};
template <typename T> using Owned = std::unique_ptr<T, Unref>;

/// What an Aravis call says went wrong.
class Failure {
public:
    ~Failure() { g_clear_error(&error_); }
    Failure() = default;
    Failure(const Failure&) = delete;
    Failure& operator=(const Failure&) = delete;
    GError** place() {
        g_clear_error(&error_);
        return &error_;
    }
    explicit operator bool() const { return error_ != nullptr; }
    [[nodiscard]] std::string why() const { return error_ ? error_->message : ""; }

private:
    GError* error_ = nullptr;
};

/// One list of devices for the whole process, not for several threads at once.
std::mutex& listMutex() {
    static std::mutex mutex;
    return mutex;
}

/// A camera obeys one at a time, and whoever leaves it stops it: within this process the next one waits until the one
/// before has left.
class Lease {
public:
    explicit Lease(std::string id) : id_(std::move(id)) {
        std::unique_lock lock(mutex());
        isMine_ = left().wait_for(lock, kOthersLeave, [&] { return !taken().contains(id_); });
        if (isMine_) taken().insert(id_);
    }
    ~Lease() {
        const std::scoped_lock lock(mutex());
        if (isMine_) taken().erase(id_);
        left().notify_all();
    }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    [[nodiscard]] bool isMine() const { return isMine_; }

private:
    static std::mutex& mutex() {
        static std::mutex one;
        return one;
    }
    static std::condition_variable& left() {
        static std::condition_variable one;
        return one;
    }
    static std::set<std::string>& taken() {
        static std::set<std::string> ids;
        return ids;
    }

    std::string id_;
    bool isMine_ = false;
};

/// How a pixel format becomes 8-bit grey or BGR.
struct Format {
    ArvPixelFormat format;
    int depth; ///< of OpenCV
    int channels;
    int shift;      ///< bits that are left out of 16
    int conversion; ///< cv::cvtColor's; -1: none
};
/// Those that are read, the best first.
constexpr std::array kFormats{Format{ARV_PIXEL_FORMAT_MONO_8, CV_8U, 1, 0, -1},
                              Format{ARV_PIXEL_FORMAT_BAYER_RG_8, CV_8U, 1, 0, cv::COLOR_BayerBG2BGR},
                              Format{ARV_PIXEL_FORMAT_BAYER_BG_8, CV_8U, 1, 0, cv::COLOR_BayerRG2BGR},
                              Format{ARV_PIXEL_FORMAT_BAYER_GR_8, CV_8U, 1, 0, cv::COLOR_BayerGB2BGR},
                              Format{ARV_PIXEL_FORMAT_BAYER_GB_8, CV_8U, 1, 0, cv::COLOR_BayerGR2BGR},
                              Format{ARV_PIXEL_FORMAT_BGR_8_PACKED, CV_8U, 3, 0, -1},
                              Format{ARV_PIXEL_FORMAT_RGB_8_PACKED, CV_8U, 3, 0, cv::COLOR_RGB2BGR},
                              Format{ARV_PIXEL_FORMAT_MONO_16, CV_16U, 1, 8, -1},
                              Format{ARV_PIXEL_FORMAT_MONO_14, CV_16U, 1, 6, -1},
                              Format{ARV_PIXEL_FORMAT_MONO_12, CV_16U, 1, 4, -1},
                              Format{ARV_PIXEL_FORMAT_MONO_10, CV_16U, 1, 2, -1}};

cv::Mat pictureOf(ArvBuffer* buffer, const Format& format) {
    std::size_t size = 0;
    const void* data = arv_buffer_get_image_data(buffer, &size);
    const int width = arv_buffer_get_image_width(buffer), height = arv_buffer_get_image_height(buffer);
    const int type = CV_MAKETYPE(format.depth, format.channels);
    if (!data || width <= 0 || height <= 0 ||
        size < static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * CV_ELEM_SIZE(type))
        return {};
    const cv::Mat raw(height, width, type, const_cast<void*>(data)); // NOLINT: it is read alone
    cv::Mat picture;
    if (format.shift > 0)
        raw.convertTo(picture, CV_8U, 1.0 / (1 << format.shift));
    else if (format.conversion >= 0)
        cv::cvtColor(raw, picture, format.conversion);
    else
        picture = raw.clone(); // the buffer is used again
    return picture;
}

class GenicamCamera final : public CaptureCamera {
public:
    explicit GenicamCamera(const std::string& address)
        : address_(address), id_(address.substr(kGenicamScheme.size())), lease_(id_) {
        if (!lease_.isMine()) throw error("is in use here already", "end the other measurement that looks through it");
        open({});
    }
    ~GenicamCamera() override { close(); }

    [[nodiscard]] cv::Mat grab(const Progress& progress) override { return frameSince(g_get_real_time(), progress); }
    [[nodiscard]] cv::Mat next(const Progress& progress) override { return frameSince(0, progress); }
    [[nodiscard]] std::optional<Microseconds> takenAt() const override {
        if (began_ == 0) return std::nullopt;
        return SteadyClock().now() - Microseconds(g_get_real_time() - began_); // that clock may be set
    }
    [[nodiscard]] std::string name() const override { return address_; }
    [[nodiscard]] cv::Size size() const override { return size_; }
    [[nodiscard]] std::optional<Exposures> exposures() const override { return exposures_; }
    void setExposure(double seconds) override {
        Failure failure;
        arv_camera_set_exposure_time(camera_.get(), 1e6 * seconds, failure.place());
        if (failure)
            throw error("does not take an exposure of " + std::to_string(1e3 * seconds) + " ms: " + failure.why(),
                        "choose another exposure, or another camera");
        exposure_ = static_cast<gint64>(1e6 * seconds);
    }
    [[nodiscard]] std::vector<std::string> automatics() const override { return automatics_; }

private:
    [[nodiscard]] DeviceError error(const std::string& why, const std::string& remedy) const {
        return {"camera " + address_, why, remedy};
    }

    /// The next whole frame whose exposure began at `earliest` or later, microseconds of this machine's clock.
    [[nodiscard]] cv::Mat frameSince(gint64 earliest, const Progress& progress) {
        const auto until = std::chrono::steady_clock::now() + kFrameWithin;
        int incomplete = 0;
        while (std::chrono::steady_clock::now() < until) {
            progress.throwIfCancelled();
            if (isLost_) reopen(progress, until);
            ArvBuffer* buffer = arv_stream_timeout_pop_buffer(stream_.get(), kPopWait);
            if (!buffer) continue;
            const bool isWhole = arv_buffer_get_status(buffer) == ARV_BUFFER_STATUS_SUCCESS;
            cv::Mat picture;
            const gint64 began = isWhole ? exposureEnd(buffer) - exposure_ : 0;
            if (isWhole && began >= earliest && ++frames_ > kFirstFrames) picture = pictureOf(buffer, *format_);
            arv_stream_push_buffer(stream_.get(), buffer);
            if (!picture.empty()) {
                began_ = began;
                return picture;
            }
            if (!isWhole && ++incomplete >= kMostIncomplete) break;
        }
        if (incomplete > 0)
            throw error("its pictures arrive incomplete",
                        "use a network of its own for it, or raise the MTU of the network card to 9000");
        throw error("gives no picture within 10 seconds", "look at its cable and power, and at its trigger settings");
    }
    /// Microseconds of this machine's clock, the end of its exposure at the latest: the camera's own time, by the frame
    /// that came soonest after it. The machine may have been busy when this one came.
    gint64 exposureEnd(ArvBuffer* buffer) {
        const auto arrived = static_cast<gint64>(arv_buffer_get_system_timestamp(buffer) / 1000);
        const auto told = static_cast<gint64>(arv_buffer_get_timestamp(buffer) / 1000);
        if (told == 0 || told == std::exchange(toldBefore_, told)) return arrived; // it has no clock
        ahead_ = ahead_ ? std::min(*ahead_ + kDrift, arrived - told) : arrived - told;
        return told + *ahead_;
    }

    void open(const Progress& progress) {
        progress.throwIfCancelled();
        Failure failure;
        {
            const std::lock_guard lock(listMutex());
            arv_update_device_list();
            camera_.reset(arv_camera_new(id_.c_str(), failure.place()));
        }
        if (!camera_)
            throw error("is not there, or another program has it" + (failure ? ": " + failure.why() : std::string()),
                        "look at its cable and power; for a network camera at whether this machine is in its network");
        progress.throwIfCancelled();
        chooseFormat();
        switchAutomaticsOff();
        start();
    }

    void chooseFormat() {
        Failure failure;
        guint count = 0;
        gint64* formats = arv_camera_dup_available_pixel_formats(camera_.get(), &count, failure.place());
        const std::vector<gint64> available(formats, formats + (formats ? count : 0));
        g_free(formats);
        const auto* const found = std::ranges::find_if(kFormats, [&](const Format& one) {
            return std::ranges::find(available, static_cast<gint64>(one.format)) != available.end();
        });
        if (found == kFormats.end())
            throw error("has no pixel format that is read here", "use one with Mono8, Bayer 8 or RGB8");
        format_ = *found;
        arv_camera_set_pixel_format(camera_.get(), found->format, failure.place());
        if (failure) throw error("does not take its pixel format: " + failure.why(), "plug it in again");
        gint width = 0, height = 0;
        arv_camera_get_sensor_size(camera_.get(), &width, &height, failure.place());
        if (!failure) arv_camera_set_region(camera_.get(), 0, 0, width, height, failure.place());
        gint x = 0, y = 0; // some cannot be told
        arv_camera_get_region(camera_.get(), &x, &y, &width, &height, failure.place());
        requireReadable(address_, size_ = {width, height});
    }

    void switchAutomaticsOff() {
        automatics_.clear();
        ArvCamera* camera = camera_.get();
        Failure failure;
        const auto still = [&](const char* what) {
            if (failure)
                automatics_.push_back(std::string("The camera keeps its automatic ") + what + ": " + failure.why());
        };
        arv_camera_clear_triggers(camera, failure.place());
        if (arv_camera_is_exposure_auto_available(camera, failure.place())) {
            arv_camera_set_exposure_time_auto(camera, ARV_AUTO_OFF, failure.place());
            still("exposure");
        }
        if (arv_camera_is_gain_auto_available(camera, failure.place())) {
            arv_camera_set_gain_auto(camera, ARV_AUTO_OFF, failure.place());
            still("gain");
        }
        if (arv_camera_is_feature_available(camera, "BalanceWhiteAuto", failure.place())) {
            arv_camera_set_string(camera, "BalanceWhiteAuto", "Off", failure.place());
            still("white balance");
        }
        exposures_.reset();
        if (!arv_camera_is_exposure_time_available(camera, failure.place())) return;
        double shortest = 0.0, longest = 0.0;
        arv_camera_get_exposure_time_bounds(camera, &shortest, &longest, failure.place());
        const double now = arv_camera_get_exposure_time(camera, failure.place());
        exposure_ = static_cast<gint64>(now);
        constexpr double kLongest = 0.5; // seconds: a sequence of forty pictures is to end today
        exposures_ = Exposures{1e-6 * shortest, std::min(kLongest, 1e-6 * longest)};
    }

    void start() {
        Failure failure;
        if (arv_camera_is_gv_device(camera_.get())) {
            arv_camera_gv_set_packet_size_adjustment(camera_.get(), ARV_GV_PACKET_SIZE_ADJUSTMENT_ONCE);
            arv_camera_gv_set_stream_options(camera_.get(), ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
        }
        stream_.reset(arv_camera_create_stream(camera_.get(), &GenicamCamera::takePartFirst, nullptr, failure.place()));
        if (!stream_) throw error("cannot send pictures: " + failure.why(), "close other programs that use it");
        const guint payload = arv_camera_get_payload(camera_.get(), failure.place());
        if (ARV_IS_GV_STREAM(stream_.get())) // packets wait there while this machine is busy
            g_object_set(stream_.get(), "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED, "socket-buffer-size",
                         static_cast<gint>(std::min<guint>(4 * payload, 64U << 20U)), nullptr);
        for (guint k = 0; k < kBuffers; ++k) arv_stream_push_buffer(stream_.get(), arv_buffer_new_allocate(payload));
        arv_camera_set_acquisition_mode(camera_.get(), ARV_ACQUISITION_MODE_CONTINUOUS, failure.place());
        isLost_ = false;
        frames_ = 0;
        ahead_.reset();
        lostSignal_ = g_signal_connect(
            arv_camera_get_device(camera_.get()), "control-lost",
            G_CALLBACK(+[](ArvDevice* /*device*/, std::atomic<bool>* lost) { *lost = true; }), &isLost_);
        arv_camera_start_acquisition(camera_.get(), failure.place());
        if (failure) throw error("does not start: " + failure.why(), "plug it in again");
    }

    /// A packet that is fetched late is a packet lost: its thread goes before others where the system allows it.
    static void takePartFirst(void* /*none*/, ArvStreamCallbackType type, ArvBuffer* /*buffer*/) {
        if (type == ARV_STREAM_CALLBACK_TYPE_INIT) arv_make_thread_high_priority(-10);
    }

    void close() {
        if (camera_ && lostSignal_ != 0)
            g_signal_handler_disconnect(arv_camera_get_device(camera_.get()), std::exchange(lostSignal_, 0));
        Failure failure;
        if (camera_ && stream_) arv_camera_stop_acquisition(camera_.get(), failure.place());
        stream_.reset();
        camera_.reset();
    }

    /// It went away: waits until it is back.
    void reopen(const Progress& progress, std::chrono::steady_clock::time_point until) {
        while (true) {
            close();
            try {
                return open(progress);
            } catch (const DeviceError&) {
                if (std::chrono::steady_clock::now() >= until) throw;
            }
            std::this_thread::sleep_for(200ms);
        }
    }

    std::string address_, id_;
    Lease lease_; ///< given back after all that follows
    Owned<ArvCamera> camera_;
    Owned<ArvStream> stream_;
    std::optional<Format> format_;
    cv::Size size_;
    gint64 exposure_ = 0; ///< microseconds
    gint64 began_ = 0;    ///< of the last picture, microseconds of the machine's clock; 0: there was none
    gint64 toldBefore_ = 0;
    int frames_ = 0;              ///< since it was started
    std::optional<gint64> ahead_; ///< of this machine's clock before the camera's, microseconds
    std::optional<Exposures> exposures_;
    std::vector<std::string> automatics_;
    std::atomic<bool> isLost_{false};
    gulong lostSignal_ = 0;
};

} // namespace

bool isGenicamAddress(const std::string& address) { return address.starts_with(kGenicamScheme); }

std::vector<CameraInfo> listGenicamCameras() {
    const std::lock_guard lock(listMutex());
    arv_update_device_list();
    std::vector<CameraInfo> cameras;
    const auto text = [](const char* of) { return std::string(of ? of : ""); };
    for (unsigned i = 0; i < arv_get_n_devices(); ++i) {
        const std::string serial = text(arv_get_device_serial_nbr(i));
        cameras.push_back({std::string(kGenicamScheme) + text(arv_get_device_id(i)),
                           text(arv_get_device_vendor(i)) + " " + text(arv_get_device_model(i)) +
                               (serial.empty() ? "" : ", " + serial)});
    }
    return cameras;
}

std::unique_ptr<CaptureCamera> openGenicamCamera(const std::string& address) {
    return std::make_unique<GenicamCamera>(address);
}

} // namespace lumorph
