#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <string_view>

#include "calibration/decode/calibration_board.h"
#include "calibration/lab/true_room.h"
#include "calibration/registration/registration.h"

namespace lumorph {

/// What the lab's visitors do with their hands and heads, as standard deviations along each axis.
struct LabHands {
    double dotMillimetres = 0.5;       ///< of a tip beside the dot that it touches
    double landmarkMillimetres = 0.25; ///< likewise beside a corner of the device
    double tremorMillimetres = 0.3;    ///< to and fro during a touch
    double aimPixels = 2.0;            ///< of a tip beside the mark that it covers, in an eye's picture of `kEyeFocal`
    double touchSeconds = 1.2;
};
inline constexpr double kEyeFocal = 1500.0; ///< pixels: that of a tracked eye's picture, unless it is said otherwise

/// What may be wrong with all that the tracker records.
enum class TrackerFault {
    none,
    dropsOut,        ///< it sees nothing for half a second
    swapsBodies,     ///< for a third of the time it takes another body for this one
    clockJumpsBack,  ///< by a quarter of a second
    clockJumpsAhead, ///< by a minute
    leftHanded,
    centimetres,
    doubledRows,
    notANumber
};
/// By its key: "drops_out", "left_handed" and so on. Throws InvalidInput.
[[nodiscard]] TrackerFault parseTrackerFault(std::string_view key);
/// All keys, for help and messages.
[[nodiscard]] std::string trackerFaultKeys();
[[nodiscard]] PoseTrack withFault(PoseTrack track, TrackerFault fault);

/// The virtual lab's tracker: records true bodies in its own world, with the noise of LabErrors, 60 times a second. The
/// same seed and calls give the same recordings.
class TrackerLab {
public:
    TrackerLab(Installation truth, std::uint32_t seed, const LabErrors& errors = {}, const LabHands& hands = {},
               TrackerFault fault = TrackerFault::none);

    /// A body in the room at times from 0 on.
    using Motion = std::function<Pose(double)>;
    /// Seconds of it from now on; time goes on by `pass`.
    [[nodiscard]] PoseTrack record(const Motion& worldFromBody, double seconds, bool pass = true);

    /// The pointer swung in a dimple at `place`.
    [[nodiscard]] PoseTrack swing(const glm::dvec3& place, double seconds = 15.0);
    /// Its tip held on a dot of the table, in a dimple, or on a point of the device, whose body is recorded too.
    [[nodiscard]] Touch touchDot(const std::string& name, const glm::dvec3& place);
    [[nodiscard]] Touch touchDimple(const std::string& name, const glm::dvec3& place);
    [[nodiscard]] Touch touchDevice(const std::string& name, const glm::dvec3& onModel);
    /// The tip held between the eye, which is at `eye`, and a mark, a good third of the way; the head is turned about
    /// the way that it looks by up to so many degrees.
    [[nodiscard]] Alignment align(const std::string& name, const glm::dvec3& mark, const glm::dvec3& eye,
                                  double turnDegrees = 18.0);
    /// The device's body at rest.
    [[nodiscard]] PoseTrack recordDevice(double seconds);

    /// A tracked board moved by hand in the air where the camera sees it, and its poses as the camera finds them, from
    /// `pointsOf` it with noise; the camera's clock is `clockOffset` ahead. `turns` scales the turns about the room's
    /// axes.
    [[nodiscard]] BoardCapture moveBoard(const CalibratedCamera& camera, const CalibrationBoard& board,
                                         double metresPerUnit, const glm::dvec3& turns = glm::dvec3(0.5),
                                         double seconds = 40.0, double clockOffset = 3.2);

private:
    [[nodiscard]] Touch hold(const std::string& name, const glm::dvec3& place, bool onDevice);
    [[nodiscard]] glm::dvec3 dice(double sigma);
    [[nodiscard]] Motion trembling(const glm::dvec3& place, const glm::dquat& turn);
    [[nodiscard]] Pose seenBoard(const CalibratedCamera& camera, const std::vector<cv::Point3d>& points,
                                 const Pose& worldFromBoard);

    Installation truth_;
    LabErrors errors_;
    LabHands hands_;
    TrackerFault fault_;
    std::mt19937 engine_;
    Pose trackerFromWorld_, worldFromDeviceBody_;
    glm::dvec3 tip_{0.0};
    double now_ = 100.0; ///< seconds by the tracker's clock
};

} // namespace lumorph
