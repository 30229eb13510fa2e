#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/decode/refusal.h"
#include "calibration/servos/servo_plan.h"
#include "calibration/servos/stroke_solver.h"
#include "core/base/progress.h"
#include "core/scene/installation.h"

namespace lumorph {

/// What was seen in one step of a plan: places on everything that camera and projector see, world metres.
using ServoPass = std::vector<MeasuredPoint>;

/// A whole stroke of an actuator that does not turn counts as so many degrees.
inline constexpr double kDegreesOfUnturned = 60.0;

/// One servo as it was found.
struct ServoFinding {
    MeasuredServo curve;           ///< without points where it is dead, swapped or runs from the wrong end
    double degrees = 0.0;          ///< of its whole stroke
    double backlashDegrees = 0.0;  ///< mean way between rising and falling
    double backlashSigma = 0.0;    ///< standard deviation of that mean, degrees
    double curveSigma = 0.0;       ///< of a point of the curve, degrees: the median
    std::size_t moves = 0;         ///< the actuator whose part it moves; its own where it moves none
    std::optional<double> stopsAt; ///< commanded stroke at which it meets a stop before its range ends
};

/// What a measurement of all servos says.
struct ServoCalibration {
    std::vector<ServoFinding> servos;                     ///< one an actuator
    std::vector<std::optional<StrokeEstimate>> estimates; ///< one a pass; empty where too little was seen
    std::vector<Finding> findings;                        ///< dead, swapped, reversed and jammed servos, and doubts
    bool usable = false;       ///< each servo moves its own part, and the fresh states are met: curves may be applied
    double freshDegrees = 0.0; ///< median of what the curves say of states that they were not made of, degrees
    double freshWorst = 0.0;   ///< the largest
    double rms = 0.0;          ///< of points off the surface, metres: the median pass
};

/// Works out servos pass by pass, as a plan is carried out: in each pass the strokes of all of them (StrokeSolver), and
/// once each has moved alone, who moves what. Wiring that is wrong ends a measurement there.
class ServoSolver {
public:
    /// `worldFromDevice` is where the device is believed to lie. Throws InvalidInput for a plan without steps, or of
    /// another number of actuators.
    ServoSolver(const Rig& rig, const glm::dmat4& worldFromDevice, const ServoPlan& plan);
    ~ServoSolver();
    ServoSolver(ServoSolver&&) noexcept;
    ServoSolver& operator=(ServoSolver&&) noexcept;

    /// What was seen in the plan's next step. Throws CaptureRefused where the first pass shows nothing of the device,
    /// or those in which each servo moved alone show it elsewhere than believed; InvalidInput where no step is left.
    void take(const ServoPass& pass);
    /// Nothing is left to be seen: the plan has no more steps, or a servo is hidden, dead, swapped or reversed.
    [[nodiscard]] bool ended() const noexcept;
    /// The curve of each servo on the way up and down, its play, and where it stops. Throws InvalidInput before the
    /// end, CaptureRefused where most passes show nothing of the device or the device moved on the table.
    [[nodiscard]] ServoCalibration result() const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// The same of all passes of a plan, or of as many as there are until wiring that is wrong ends it. Throws what
/// ServoSolver throws; Cancelled.
[[nodiscard]] ServoCalibration solveServos(const Rig& rig, const glm::dmat4& worldFromDevice, const ServoPlan& plan,
                                           const std::vector<ServoPass>& passes, const Progress& progress = {});

/// The room with what was measured, where it is usable; else as it was.
[[nodiscard]] Installation withServos(const Installation& room, const ServoCalibration& measured,
                                      const std::string& method);

} // namespace lumorph
