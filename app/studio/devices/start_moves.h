#pragma once

#include <optional>
#include <span>
#include <vector>

#include "devices/controllers/device_profile.h"
#include "devices/controllers/servo_link_status.h"

namespace lumorph::studio {

/// What one servo will do when servos are started.
struct StartMove {
    bool driven = false;        ///< it has pulses already
    std::optional<double> from; ///< stroke at which it is, or was let go; nothing: nobody knows
    double to = 0.0;            ///< stroke of the pose to come
    double jump = 0.0; ///< microseconds that it may leap at its full speed the moment it starts; 0: it goes slowly
    bool operator==(const StartMove&) const = default;
};

/// One a servo of the profile. `wanted`: strokes that the show asks for; where it has none for a servo, it stays.
[[nodiscard]] std::vector<StartMove> startMoves(const LinkStatus& link, const DeviceProfile& profile,
                                                std::span<const double> wanted);

/// Whether a start may go without asking: every servo was read where it stands.
[[nodiscard]] bool startsFromReadPlaces(const LinkStatus& link);

} // namespace lumorph::studio
