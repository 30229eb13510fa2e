#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "calibration/verify/room_surface.h"
#include "core/base/image.h"
#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph {

/// Which light falls where in a small camera picture, while the device stands at some strokes.
struct ShowSight {
    std::vector<double> strokes;
    std::vector<cv::Mat1f> share; ///< one a projector: how bright its white is; 0 where none falls
    std::vector<cv::Mat2f> panel; ///< one a projector: the pixel that lights it
    cv::Mat1i surface;            ///< 0 the device, 1 the table, -1 neither
    std::vector<double> coarser;  ///< one a projector: its pixels a pixel of this picture
    std::shared_ptr<const RoomSurface> rays;
};

/// Pictures that projectors send, as grey light and as coarse as the camera sees them.
struct CoarseShow {
    std::vector<cv::Mat1f> light; ///< one a projector; empty: it is dark
};

/// What a camera should see of a show, by the room as it is believed to be. Pictures are small and grey: a watch has
/// all evening. One thread at a time.
class ShowPrediction {
public:
    /// Throws InvalidInput for a room without that camera or without a projector.
    ShowPrediction(const Rig& rig, const Installation& believed, int width = 320, std::size_t camera = 0);

    /// Kept until the strokes (where the actuators are believed to stand) are others.
    [[nodiscard]] const ShowSight& sight(std::span<const double> strokes);
    /// The light that comes back from what projectors send (one picture each, of its size; an empty one is dark),
    /// without the room's; up to a factor. Throws InvalidInput for other sizes.
    [[nodiscard]] cv::Mat1f predict(std::span<const Image> sent, std::span<const double> strokes);
    /// The same in two steps, of which the first serves several predictions.
    [[nodiscard]] CoarseShow coarse(std::span<const Image> sent, std::span<const double> strokes);
    [[nodiscard]] cv::Mat1f predict(const CoarseShow& sent, std::span<const double> strokes);
    /// A photograph, 8-bit grey or BGR, as small. Throws InvalidInput for one of another shape.
    [[nodiscard]] cv::Mat1f shrink(const cv::Mat& photograph) const;

    /// The room, its camera as small as the pictures.
    [[nodiscard]] const Installation& room() const noexcept { return room_; }
    [[nodiscard]] const Rig& rig() const noexcept { return rig_; }
    [[nodiscard]] std::size_t camera() const noexcept { return camera_; }
    [[nodiscard]] cv::Size size() const;

private:
    Rig rig_;
    Installation room_;
    std::size_t camera_;
    ShowSight sight_;
};

} // namespace lumorph
