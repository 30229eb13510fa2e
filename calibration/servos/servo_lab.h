#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "calibration/servos/servo_measurement.h"

namespace lumorph {

/// What can be wrong with the servos of the lab.
enum class ServoFault {
    swapped,  ///< the first two move each other's part
    reversed, ///< the second runs from the end of its range
    dead,     ///< the third stays at rest
    jammed    ///< the fourth meets a stop
};
/// "swapped", "reversed", "dead", "jammed". Throws InvalidInput.
[[nodiscard]] ServoFault parseServoFault(std::string_view text);
/// The actuators that have it, of so many.
[[nodiscard]] std::vector<std::size_t> faultyServos(ServoFault fault, std::size_t actuators);
/// Of a stroke: where the jammed servo stops.
inline constexpr double kLabStop = 0.55;

struct ServoLabOptions {
    std::optional<ServoFault> fault;
    int pixelStep = 7;         ///< camera pixels between two points
    double decodeSigma = 0.15; ///< projector pixels, of each coordinate of each point
    double strayShare = 0.005; ///< of points: read anyhow
};

/// The device of the lab with its true servos: what they are told, where they then really are, and what a camera sees
/// of it under structured light. A plain machine of commands; the same for the same seed.
class ServoLab {
public:
    /// Curves come from `truth` by the actuators' names; its first projector and camera light and see the device;
    /// without a camera that of `defaultLabCamera`. Throws InvalidInput without a projector.
    ServoLab(const Rig& rig, const Installation& truth, std::uint32_t seed, const ServoLabOptions& options);
    /// Moves them slowly from where they are.
    void command(std::span<const double> commanded);
    /// Where the parts really are, one stroke an actuator.
    [[nodiscard]] const std::vector<double>& real() const noexcept { return real_; }
    /// One pass of structured light, as decoded: rays from the camera, and the projector's pixels with their noise.
    [[nodiscard]] std::vector<ProjectorPoint> look();
    /// How many points of each actuator's part camera and projector would see at these strokes.
    [[nodiscard]] std::vector<int> seen(std::span<const double> strokes) const;
    [[nodiscard]] const CalibratedCamera& camera() const noexcept { return camera_; }
    [[nodiscard]] const CalibratedCamera& projector() const noexcept { return room_.projectors.front().camera; }

private:
    struct Ray {
        glm::dvec2 pixel;
        glm::dvec3 way;
    };
    template <typename Use> void eachLit(std::span<const double> strokes, const Use& use) const;

    Rig rig_;
    Installation room_;
    CalibratedCamera camera_;
    ServoLabOptions options_;
    std::vector<MeasuredServo> servos_;
    std::vector<Ray> rays_;
    std::vector<double> real_;
    std::uint32_t dice_;
};

} // namespace lumorph
