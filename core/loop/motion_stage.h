#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/motion/delayed_strokes.h"
#include "core/motion/motion.h"
#include "core/rig/rig.h"
#include "core/scene/measured_servos.h"

namespace lumorph {

/// Last stages of a frame: the actuators move under their limits, and the device is deformed to where they are.
/// What moves under the limits are the commands: a measured servo is told what brings it where it is wanted, and where
/// it really is follows from its curve. So play is taken up as fast as the servo may move, and until that is done the
/// device is known to stand still.
/// A servo whose lag was measured moves that much after its command, and what is drawn for where it stands is seen only
/// when its light comes: its stroke is the one that it has then. Where the light comes first it follows from commands
/// that were given, else from those to come while the wish stays.
class MotionStage {
public:
    /// An actuator stays where it is when the rig has the same actuators as the one before. In an edit of that rig,
    /// which has the same `origin`, each goes on, as fast as it was: by its name, or where it was renamed by its place;
    /// one that is new is at rest. Else all are at rest.
    void follow(const std::shared_ptr<const Rig>& rig, const std::shared_ptr<const void>& origin);
    /// The servos as they were measured, from now on; null: as they are told. Commands stay as they are. `lightDelay`
    /// as in `lightAhead`.
    void use(const std::shared_ptr<const Installation>& installation, double lightDelay = 0.0);
    /// The actuators really stand there, one stroke each.
    void standAt(std::span<const double> strokes);
    /// Strokes that are wanted, within what measured servos reach.
    void limit(std::span<double> wanted) const noexcept { curves_.limit(wanted); }
    /// That, one an actuator; empty where no servo was measured.
    [[nodiscard]] std::span<const StrokeRange> reach() const noexcept { return curves_.reach(); }
    /// Moves towards the strokes that are really wanted; while stopped all hold still, and start softly afterwards.
    /// Servos have come only as far as the last command, however long ago it was given: after a step that is much
    /// longer than those before they start from there as after a rest, by a step as long as usual.
    void move(std::span<const double> wanted, double seconds, bool stopped);
    /// No command for `seconds`: the actuators stand where the last ones lead.
    void rest(double seconds);
    /// Within 1e-5 strokes of what is wanted they have arrived; then a motion ends exactly there.
    [[nodiscard]] bool arrived(std::span<const double> wanted) const;
    /// Nothing that was told is still on its way.
    [[nodiscard]] bool stands() const;
    /// Where the actuators really are.
    [[nodiscard]] std::span<const double> strokes() const noexcept { return seen_; }
    /// What their servos are told.
    [[nodiscard]] std::span<const double> commands() const noexcept { return motion_.positions(); }
    /// Positions of the rig's vertices; the same object while nothing moves.
    [[nodiscard]] const std::shared_ptr<const std::vector<glm::vec3>>& deformed();

private:
    void goOn(const MotionModel& last, const std::vector<double>& real, const Rig& from, const Rig& to);
    [[nodiscard]] bool isAt(std::span<const double> commands) const noexcept;
    void readServos();
    void readLags();
    /// The part of a step in which servos may be taken to move; for the rest of it they have stood.
    [[nodiscard]] double moving(double seconds);
    /// What is seen of strokes that were `before` and go on towards `aims`.
    void look(std::span<const double> before, std::span<const double> aims, double seconds);

    std::shared_ptr<const Rig> rig_;
    std::shared_ptr<const void> origin_;
    std::vector<MotionLimits> limits_;
    MotionModel motion_{{}};   ///< of the commands
    std::vector<double> real_; ///< where the commands lead, as soon as servos follow
    std::vector<double> seen_; ///< where they are when the light comes
    DelayedStrokes delayed_;
    std::shared_ptr<const Installation> installation_;
    ServoCurves curves_;
    double usual_ = 1.0 / 60.0; ///< seconds of a step, of late
    double light_ = 0.0;        ///< seconds from a frame to its light
    std::vector<double> lags_;  ///< one an actuator, 0: unknown; empty: of none
    std::vector<double> deformedAt_;
    std::shared_ptr<const std::vector<glm::vec3>> deformed_;
};

} // namespace lumorph
