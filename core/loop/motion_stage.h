#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/motion/motion.h"
#include "core/rig/rig.h"

namespace lumorph {

/// Last stages of a frame: the actuators move under their limits, and the device is deformed to where they are.
class MotionStage {
public:
    /// An actuator stays where it is when the rig has the same actuators as the one before. In an edit of that rig,
    /// which has the same `origin`, each goes on, as fast as it was: by its name, or where it was renamed by its place;
    /// one that is new is at rest. Else all are at rest.
    void follow(const std::shared_ptr<const Rig>& rig, const std::shared_ptr<const void>& origin);
    /// The actuators stand there, one stroke each.
    void standAt(std::span<const double> strokes) { motion_.reset(strokes); }
    /// Moves towards the wanted strokes; while stopped all hold still, and start softly afterwards.
    void move(std::span<const double> wanted, double seconds, bool stopped);
    /// Within 1e-5 strokes of what is wanted they have arrived; then a motion ends exactly there.
    [[nodiscard]] bool arrived(std::span<const double> wanted) const noexcept;
    [[nodiscard]] std::span<const double> strokes() const noexcept { return motion_.positions(); }
    /// Positions of the rig's vertices; the same object while nothing moves.
    [[nodiscard]] const std::shared_ptr<const std::vector<glm::vec3>>& deformed();

private:
    void goOn(const MotionModel& last, const Rig& from, const Rig& to);

    std::shared_ptr<const Rig> rig_;
    std::shared_ptr<const void> origin_;
    std::vector<MotionLimits> limits_;
    MotionModel motion_{{}};
    std::vector<double> deformedAt_;
    std::shared_ptr<const std::vector<glm::vec3>> deformed_;
};

} // namespace lumorph
