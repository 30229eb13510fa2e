#pragma once

#include <span>
#include <vector>

#include "devices/protocol/osc_pose.h"
#include "devices/trackers/tracker.h"

namespace lumorph {

/// Puts the halves of poses together that come one by one.
class OscBodies {
public:
    /// The frame that the parts complete, or null: a body is told once its position and its rotation have both come
    /// anew, or its position alone while no rotations come. Of more than 32 names the later ones are left out.
    const TrackerFrame* take(std::span<const osc::PosePart> parts, Microseconds now);
    /// Something came, but never a position.
    [[nodiscard]] bool onlyRotations() const;

private:
    struct Halves {
        TrackedBody body;
        bool freshPosition = false;
        bool freshRotation = false;
        bool positioned = false;
        Microseconds rotated{0};
        bool everRotated = false;
    };
    Halves* of(const std::string& name);

    std::vector<Halves> halves_;
    TrackerFrame frame_;
};

} // namespace lumorph
