#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lumorph {

/// Controls of a camera's driver, by V4L2's numbers.
struct CameraControls {
    std::function<std::optional<int>(unsigned control)> get; ///< empty: it has no such control
    std::function<bool(unsigned control, int value)> set;    ///< false: refused
};

/// Those of a camera of this machine, which may be streaming; one that cannot be opened has none.
[[nodiscard]] CameraControls controlsOf(const std::string& path);

/// Seconds between which a camera of this machine can expose by hand; empty: its driver has no such control.
[[nodiscard]] std::optional<std::pair<double, double>> rangeOfExposure(const std::string& path);
/// False: refused, or not kept.
[[nodiscard]] bool setExposure(const CameraControls& controls, double seconds);

/// Switches all that changes pictures by itself off: exposure, gain, white balance, focus and such stay where they are.
/// What stays on is named, with what to do.
[[nodiscard]] std::vector<std::string> switchAutomaticsOff(const CameraControls& controls);

} // namespace lumorph
