#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "calibration/light/light_calibration.h"
#include "core/rig/rig.h"

namespace lumorph {

/// What can be wrong while light is measured in the lab.
enum class LightFault {
    saturated, ///< the camera's aperture is far too wide
    dark,      ///< its lens is nearly shut
    automatic, ///< it sets its exposure by itself
    ambient,   ///< somebody switches a lamp on meanwhile
    falling,   ///< the first projector makes less light of higher values, somewhere in the middle
    unseen     ///< the camera looks beside the device
};
/// "saturated", "dark", "automatic", "ambient", "falling", "unseen". Throws InvalidInput.
[[nodiscard]] LightFault parseLightFault(std::string_view text);

/// The lab's camera for light: three channels of 8 bits with a curve of its own.
struct LightLabOptions {
    double gamma = 2.3;       ///< of its curve
    double toe = 0.012;       ///< light, as a share of what is cut off, below which the curve is straight
    double shoulder = 0.12;   ///< by which bright light is held down
    double pedestal = 4.0;    ///< byte of no light at all
    double mixing = 0.03;     ///< what each channel sees of each of the other two
    glm::dvec3 balance{1.0};  ///< of its channels: what it shows of neutral light
    double vignetting = 0.2;  ///< of the light, lost in the corners
    double ambient = 0.03;    ///< the room's light, as a share of the first projector's full white
    double noise = 0.7;       ///< standard deviation of a byte
    double shotNoise = 0.008; ///< variance that each byte adds
    bool laysSheet = true;    ///< a sheet of white paper lies beside the device
    std::optional<LightFault> fault;
};

/// The lab photographed in flat light: the room as it truly is, its device at rest. The same seed and calls give the
/// same pictures.
class LightLab : public LightBench {
public:
    /// `camera` takes the pictures; `sheet` lies on the table, where there is one. Throws InvalidInput for a room
    /// without a projector.
    LightLab(const Installation& truth, const Rig& rig, const CalibratedCamera& camera,
             const std::optional<WhiteSheet>& sheet, const LightLabOptions& options, std::uint32_t seed);

    [[nodiscard]] cv::Mat photograph(const LightShow& show, double seconds) override;
    [[nodiscard]] double shortestExposure() const override { return 1.0 / 8000.0; }
    [[nodiscard]] double longestExposure() const override { return 0.5; }

private:
    [[nodiscard]] glm::dvec3 sent(std::size_t projector, const glm::ivec3& color) const;

    Installation truth_;
    LightLabOptions options_;
    glm::ivec2 size_;
    std::vector<std::vector<glm::vec3>> whites_; ///< a projector: a pixel's light under its full white, gains apart
    std::vector<glm::vec3> ambient_;             ///< a pixel's
    std::vector<float> fading_;                  ///< a pixel's share that the lens lets through
    std::vector<float> bytes_;                   ///< of the sensor's light in [0, 1], even steps
    double sensitivity_ = 1.0;                   ///< light of the sensor by radiance and seconds
    std::uint32_t seed_, pictures_ = 0;
};

/// The lab's camera for light in a room as it truly is: its first, or one as the lab has it, by `lightCamera`. Throws
/// InvalidInput for a room without a projector.
[[nodiscard]] CalibratedCamera lightLabCamera(const Installation& truth, const LightLabOptions& options = {});

} // namespace lumorph
