#include "calibration/capture/camera_controls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace lumorph {

namespace {

constexpr double kExposureUnit = 1e-4; // seconds, of V4L2_CID_EXPOSURE_ABSOLUTE

/// Something a camera changes by itself.
struct Automatic {
    unsigned control;
    int off;
    const char* name;
};

constexpr std::array kAutomatics{
    Automatic{V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL, "exposure"},
    Automatic{V4L2_CID_EXPOSURE_AUTO_PRIORITY, 0, "frame rate by exposure"},
    Automatic{V4L2_CID_AUTOGAIN, 0, "gain"},
    Automatic{V4L2_CID_AUTO_WHITE_BALANCE, 0, "white balance"},
    Automatic{V4L2_CID_FOCUS_AUTO, 0, "focus"},
    Automatic{V4L2_CID_AUTOBRIGHTNESS, 0, "brightness"},
    Automatic{V4L2_CID_HUE_AUTO, 0, "hue"},
    Automatic{V4L2_CID_WIDE_DYNAMIC_RANGE, 0, "wide dynamic range"},
    Automatic{V4L2_CID_IMAGE_STABILIZATION, 0, "image stabilisation"},
};

bool isOff(const CameraControls& controls, const Automatic& automatic) {
    const std::optional<int> value = controls.get(automatic.control);
    return !value || *value == automatic.off ||
           (automatic.control == V4L2_CID_EXPOSURE_AUTO && *value == V4L2_EXPOSURE_SHUTTER_PRIORITY);
}

} // namespace

CameraControls controlsOf(const std::string& path) {
    const int opened = open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK);
    const auto close = [](const int* file) {
        if (*file >= 0) ::close(*file);
        delete file;
    };
    const std::shared_ptr<const int> file(new int(opened), close);
    return {[file](unsigned control) -> std::optional<int> {
                v4l2_control value{control, 0};
                if (*file < 0 || ioctl(*file, VIDIOC_G_CTRL, &value) != 0) return std::nullopt;
                return value.value;
            },
            [file](unsigned control, int wanted) {
                v4l2_control value{control, wanted};
                return *file >= 0 && ioctl(*file, VIDIOC_S_CTRL, &value) == 0;
            }};
}

std::optional<std::pair<double, double>> rangeOfExposure(const std::string& path) {
    const int opened = open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK);
    if (opened < 0) return std::nullopt;
    v4l2_queryctrl asked{};
    asked.id = V4L2_CID_EXPOSURE_ABSOLUTE;
    const bool isThere = ioctl(opened, VIDIOC_QUERYCTRL, &asked) == 0 && (asked.flags & V4L2_CTRL_FLAG_DISABLED) == 0;
    close(opened);
    if (!isThere || asked.maximum <= asked.minimum) return std::nullopt;
    return std::pair(kExposureUnit * std::max(asked.minimum, 1), kExposureUnit * asked.maximum);
}

bool setExposure(const CameraControls& controls, double seconds) {
    const int wanted = static_cast<int>(std::lround(seconds / kExposureUnit));
    return controls.set(V4L2_CID_EXPOSURE_ABSOLUTE, wanted) && controls.get(V4L2_CID_EXPOSURE_ABSOLUTE) == wanted;
}

std::vector<std::string> switchAutomaticsOff(const CameraControls& controls) {
    std::vector<std::string> left;
    for (const Automatic& automatic : kAutomatics) {
        if (isOff(controls, automatic)) continue;
        controls.set(automatic.control, automatic.off);
        // Some drivers know manual exposure by another name, and some take a value and do not keep it.
        if (automatic.control == V4L2_CID_EXPOSURE_AUTO && !isOff(controls, automatic))
            controls.set(automatic.control, V4L2_EXPOSURE_SHUTTER_PRIORITY);
        if (!isOff(controls, automatic))
            left.push_back("The camera's automatic " + std::string(automatic.name) +
                           " stays on. Switch it off at the camera or with v4l2-ctl, and keep it off while you "
                           "calibrate.");
    }
    return left;
}

} // namespace lumorph
