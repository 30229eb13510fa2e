#pragma once

#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "calibration/decode/calibration_board.h"
#include "calibration/decode/refusal.h"
#include "calibration/patterns/capture_order.h"

namespace lumorph::test {

/// A capture in memory, and what is said of it: what an accident changes.
struct SpoiledCapture {
    std::vector<std::string> names;            ///< of poses
    std::vector<std::vector<cv::Mat>> poses;   ///< 8-bit grey, in the order's order
    CaptureOrder order;                        ///< what is said
    CalibrationBoard board;                    ///< likewise
    std::optional<double> millimetresOfUnit{}; ///< of the board's unit; nothing: 1
    [[nodiscard]] cv::Size camera() const { return poses.front().front().size(); }
};

/// One thing that happens to captures, and what a technician has to be told.
struct Accident {
    std::string name;
    /// The right cause, or one of several that are as right; none where the capture stays sound.
    std::vector<Cause> expected;
    /// Whether a capture that stays good may pass without a word: all but mistakes in what was said.
    bool mayPass = true;
    enum class Patterns { any, gray, phase } patterns = Patterns::any;
    std::function<void(SpoiledCapture&, std::mt19937&)> spoil;
    bool isAsked = false; ///< it may be right: accepted with a question, whatever it makes of the light
};

/// All kinds that are known, each with several amounts; the right key of each was written down before the code that
/// finds it.
[[nodiscard]] std::vector<Accident> accidents();

} // namespace lumorph::test
