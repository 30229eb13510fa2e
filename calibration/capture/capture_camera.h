#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "core/base/clock.h"
#include "core/base/image.h"
#include "core/base/progress.h"

namespace lumorph {

class BoardLab;

/// A source of camera pictures. One thread at a time.
class CaptureCamera {
public:
    virtual ~CaptureCamera() = default;

    /// The newest frame whose exposure began after the call, 8-bit grey or BGR; of what is recorded, the next one in
    /// its order. Throws DeviceError for a camera that gives none, DataError for a recording that is broken or has come
    /// to its end, Cancelled.
    [[nodiscard]] virtual cv::Mat grab(const Progress& progress) = 0;
    /// The next frame that comes, whenever its exposure began, for who wants all of them; throws as `grab`.
    [[nodiscard]] virtual cv::Mat next(const Progress& progress) { return grab(progress); }
    /// When the exposure of the picture that was given last began, by the steady clock; empty for a camera that does
    /// not say: then it came to be some time before that.
    [[nodiscard]] virtual std::optional<Microseconds> takenAt() const { return std::nullopt; }
    [[nodiscard]] virtual std::string name() const = 0;
    /// Pixels; empty before the first frame of a camera that does not say.
    [[nodiscard]] virtual cv::Size size() const = 0;
    /// Whether it sees what is shown now; recordings do not.
    [[nodiscard]] virtual bool isLive() const { return true; }
    /// Seconds that it can expose; empty: it cannot be told.
    struct Exposures {
        double shortest = 0.0, longest = 0.0;
    };
    [[nodiscard]] virtual std::optional<Exposures> exposures() const { return std::nullopt; }
    /// Throws DeviceError for a camera that cannot be told.
    virtual void setExposure(double seconds);
    /// Automatics that are on and could not be switched off: sentences that say what to do.
    [[nodiscard]] virtual std::vector<std::string> automatics() const { return {}; }
};

/// Throws DeviceError for pictures in which no board can be read: a side of less than 200 pixels.
void requireReadable(const std::string& camera, cv::Size picture);

/// A picture of a camera as 8-bit grey.
[[nodiscard]] cv::Mat greyOf(const cv::Mat& picture);
/// An 8-bit grey picture as an image.
[[nodiscard]] Image imageOfGrey(const cv::Mat& grey);

/// A camera of this machine, "/dev/video0", in the largest size that is at most `most` (empty: what it gives by
/// itself), an industrial one, "genicam://Basler-21438501", or one that sends MJPEG, "http://192.168.0.7:8080/video".
/// Exposure, white balance, focus and gain are fixed where they are, as far as the driver allows. Throws DeviceError
/// with what to do.
[[nodiscard]] std::unique_ptr<CaptureCamera> openCaptureCamera(const std::string& path, cv::Size most = {1920, 1080});

/// Whether an address is that of a camera which `lumorph-table` or Aravis poses as: what it tells is simulated.
[[nodiscard]] bool isSimulatedCamera(const std::string& address);

/// How cameras are opened, by their addresses; in any thread.
using CameraOpener = std::function<std::unique_ptr<CaptureCamera>(const std::string& address)>;

/// The virtual lab's; it outlives the camera.
[[nodiscard]] std::unique_ptr<CaptureCamera> openLabCamera(BoardLab& lab);

} // namespace lumorph
