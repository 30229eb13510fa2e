#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/rig/rig.h"

namespace lumorph {

/// How one actuator of a rig hangs on a controller.
struct ServoSetup {
    int channel = 0;
    double pulseMin = 1000.0; ///< microseconds; least and greatest that may ever be sent, 500 to 2500
    double pulseMax = 2000.0;
    bool reversed = false;        ///< rest at pulseMax
    double trim = 0.0;            ///< microseconds added, within the limits
    double maxVelocity = 1.0;     ///< strokes a second
    double maxAcceleration = 8.0; ///< strokes a second, a second
    double exitStroke = 0.0;      ///< where it goes at the end, in [0, 1]
    PulseCurve curve{};           ///< how the pulse goes from rest to full stroke
    bool operator==(const ServoSetup&) const = default;
};

enum class ControllerKind { firmata, lewansoul, maestro };

/// A device as its technician has set it up; saved by name.
struct DeviceProfile {
    std::string name;
    std::string address; ///< URI
    ControllerKind controller = ControllerKind::firmata;
    int controllerNumber = 12;       ///< of a Maestro: its device number
    bool maestroCrc = false;         ///< it expects a checksum
    std::string identity;            ///< of the very board it was set up with; empty: any
    bool confirmed = false;          ///< the user has said that it is one, whatever its firmware calls itself
    std::vector<ServoSetup> servos;  ///< one an actuator
    double commandsPerSecond = 50.0; ///< at most; the link's own limit holds too
    double staggerSeconds = 0.4;     ///< between one servo's start and the next
    double slowShare = 0.25;         ///< of all velocities, in slow mode
    double handDistance = 0.1;       ///< metres; a tracked hand that is nearer makes all slow; 0: none does
    bool restOnExit = true;          ///< servos go to their exitStrokes when the link ends
    bool operator==(const DeviceProfile&) const = default;
};

/// The least and the most that a value of a profile may be.
struct ProfileLimits {
    double least = 0.0;
    double most = 0.0;
};
namespace profile_limits {
// Beyond these, hobby servos run into their end stops or are driven by nobody.
inline constexpr ProfileLimits kPulse{500.0, 2500.0};
inline constexpr ProfileLimits kVelocity{0.001, 20.0};
inline constexpr ProfileLimits kAcceleration{0.001, 1000.0};
inline constexpr ProfileLimits kCommandsPerSecond{1.0, 400.0};
inline constexpr ProfileLimits kStaggerSeconds{0.0, 10.0};
inline constexpr ProfileLimits kSlowShare{0.01, 1.0};
inline constexpr ProfileLimits kControllerNumber{0.0, 127.0};
inline constexpr ProfileLimits kHandDistance{0.0, 1.0};
} // namespace profile_limits

/// A profile for a rig as its file describes its drives, on a board whose channels begin at `first` (`boardChannels`).
[[nodiscard]] DeviceProfile profileFor(const Rig& rig, int first = 0);
/// Width of the pulse for a stroke, whatever the limits; straight on beyond [0, 1]. And back.
[[nodiscard]] double freePulseOf(const ServoSetup& servo, double stroke) noexcept;
[[nodiscard]] double strokeOf(const ServoSetup& servo, double pulse) noexcept;
/// Width of the pulse for a stroke in [0, 1], within pulseMin and pulseMax whatever the trim.
[[nodiscard]] double pulseOf(const ServoSetup& servo, double stroke) noexcept;
/// Microseconds a second of a servo that moves as fast as it may, where its curve is steepest.
[[nodiscard]] double fastestPulse(const ServoSetup& servo) noexcept;
/// Throws InvalidInput that names the servo and the value: out of range, not finite, two servos on one channel.
void checkProfile(const DeviceProfile& profile);

/// As JSON; doubles come back bit for bit. `subject` names it in a DataError. Text that is not UTF-8 is mended.
[[nodiscard]] std::string profileText(const DeviceProfile& profile);
[[nodiscard]] DeviceProfile parseProfile(std::string_view text, const std::string& subject);
/// JSON files. Throw DataError with file and place; writing is atomic.
[[nodiscard]] DeviceProfile readProfile(const std::filesystem::path& file);
void writeProfile(const DeviceProfile& profile, const std::filesystem::path& file);

} // namespace lumorph
