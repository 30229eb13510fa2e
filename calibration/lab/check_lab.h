#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "calibration/lab/board_lab.h"
#include "calibration/lab/lab.h"
#include "core/base/image.h"
#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph {

/// How the lab's camera photographs a show.
struct CheckLabOptions {
    BoardLabOptions pictures;
    double exposure = 1.0;           ///< as a share of the right one
    double shake = 0.0;              ///< standard deviation of blur, camera pixels, beside that of `pictures`
    std::vector<TriangleMesh> hands; ///< in the light and before the camera, world metres
    bool isLinear = true;            ///< what is shown is light, as patterns need it; else by the projector's own curve
};

/// The virtual lab's photographer of device and table under what projectors show: the room as it truly is, the device
/// as its true servos let it stand when they are told `commanded` from below. One thread at a time; the same seed and
/// calls give the same pictures.
class CheckLab {
public:
    /// The first camera takes the pictures. Throws InvalidInput for a room without a camera or a projector, strokes
    /// that are not one number from 0 to 1 an actuator, or where the camera sees nothing that a projector can light.
    CheckLab(const Installation& truth, const Rig& rig, std::span<const double> commanded,
             const CheckLabOptions& options = {}, std::uint32_t seed = 1);

    /// 8-bit grey, one projector showing grey of its size, the others dark.
    [[nodiscard]] cv::Mat photograph(std::size_t projector, const cv::Mat& grey);
    /// Under one picture a projector, each of its size.
    [[nodiscard]] cv::Mat photograph(std::span<const Image> sent);

private:
    [[nodiscard]] cv::Mat develop();

    CheckLabOptions options_;
    std::unique_ptr<Lab> lab_;
    LabSight sight_;
    std::vector<Image> dark_;
    double exposure_ = 1.0; ///< grey levels of radiance 1
    std::uint32_t seed_ = 1, pictures_ = 0;
};

/// Where actuators truly stand that were told `commanded` from below.
[[nodiscard]] std::vector<double> risenStrokes(const Installation& truth, const Rig& rig,
                                               std::span<const double> commanded);

} // namespace lumorph
