#include "app/studio/devices/start_moves.h"

#include <algorithm>
#include <cmath>

namespace lumorph::studio {
namespace {

constexpr double kMiddlePulse = 1500.0; ///< to which stock firmware drives a servo when it is attached

/// From wherever it may stand to a pulse.
double farthest(const ServoSetup& servo, double pulse) {
    return std::max(pulse - servo.pulseMin, servo.pulseMax - pulse);
}

double jumpOf(const StartMove& move, const ServoSetup& servo, bool toMiddle) {
    if (move.driven) return 0.0;
    const double first = std::clamp(toMiddle ? kMiddlePulse : pulseOf(servo, move.to), servo.pulseMin, servo.pulseMax);
    if (!move.from) return farthest(servo, first);
    return toMiddle ? std::abs(first - pulseOf(servo, *move.from)) : 0.0;
}

} // namespace

std::vector<StartMove> startMoves(const LinkStatus& link, const DeviceProfile& profile,
                                  std::span<const double> wanted) {
    std::vector<StartMove> moves(profile.servos.size());
    for (std::size_t k = 0; k < moves.size(); ++k) {
        StartMove& move = moves[k];
        if (k < link.servos.size()) {
            const ServoStatus& servo = link.servos[k];
            move.driven = servo.attached;
            if (servo.attached || servo.known) move.from = std::clamp(servo.commanded, 0.0, 1.0);
        }
        move.to = k < wanted.size() ? std::clamp(wanted[k], 0.0, 1.0) : move.from.value_or(0.0);
        move.jump = jumpOf(move, profile.servos[k], link.controller.traits.jumpsOnAttach);
    }
    return moves;
}

bool startsFromReadPlaces(const LinkStatus& link) {
    return link.controller.traits.readsPosition && !link.controller.traits.jumpsOnAttach &&
           std::ranges::all_of(link.servos, [](const ServoStatus& one) { return one.attached || one.known; });
}

} // namespace lumorph::studio
