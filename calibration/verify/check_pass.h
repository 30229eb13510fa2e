#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "calibration/patterns/capture_order.h"
#include "calibration/verify/moved_part.h"

namespace lumorph {

/// Why a check or a watch says nothing, rather than something wrong. `--json` names it by the key in quotes.
enum class Obstacle {
    cameraLost,  ///< "camera_lost": it gives no pictures, or too few
    tooDark,     ///< "too_dark": the camera sees nothing at all
    noLight,     ///< "no_light": it sees the room, but none of the projector's light
    overexposed, ///< "overexposed"
    covered,     ///< "covered": something stands in the light or in the camera's sight
    blurred,     ///< "blurred": the camera is out of focus
    unsteady,    ///< "unsteady": pictures came late, or something moved while they were taken
    unexplained  ///< "unexplained": what is seen fits no motion of what is there
};
[[nodiscard]] std::string_view keyOf(Obstacle obstacle);

struct NoVerdict {
    Obstacle obstacle = Obstacle::cameraLost;
    std::string why, remedy; ///< sentences without an end
};
/// "why; remedy."
[[nodiscard]] std::string sentenceOf(const NoVerdict& reason);

/// Where a room believes the light of one projector to be in a camera's picture: a grid of camera pixels.
struct ExpectedLight {
    cv::Size picture;
    std::vector<cv::Point> pixels;
    std::vector<bool> onDevice; ///< one a pixel
    double panelPixels = 1.0;   ///< projector pixels a camera pixel, in the middle of them
};
/// Every `step`th camera pixel whose believed place is lit. Strokes are where the actuators are believed to stand.
[[nodiscard]] ExpectedLight expectedLight(const Rig& rig, const Installation& believed, std::span<const double> strokes,
                                          std::size_t projector, std::size_t camera = 0, int step = 8);

/// Light that was read from one structured-light pass, or why it was not.
struct ReadPass {
    std::vector<LitPoint> points;
    std::optional<NoVerdict> obstacle;
};
/// Reads the images of one pass by one projector, 8-bit grey, in the order's order; a camera that failed gives fewer
/// or empty ones. Never throws for what was photographed.
[[nodiscard]] ReadPass readPass(const std::vector<cv::Mat>& images, const CaptureOrder& order,
                                const ExpectedLight& expected, std::size_t projector = 0);

} // namespace lumorph
