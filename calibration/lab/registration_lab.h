#pragma once

#include <cstdint>

#include "calibration/lab/tracker_lab.h"
#include "calibration/registration/registration.h"
#include "calibration/solve/observations.h"
#include "core/rig/rig.h"

/// What tracker, pointer, device and eye are registered by, recorded in the virtual lab: what a visitor would be asked
/// to do is done in the true room, with the noise of tracker and hands.
namespace lumorph {

struct RegistrationLabOptions {
    std::size_t dots = 12, landmarks = 16, alignments = 8, fresh = 4;
    LabErrors errors;
    LabHands hands;
    TrackerFault fault = TrackerFault::none;
};

// What is recorded. `believed` says where dots are shown and the device is thought to lie, `truth` where they are.

[[nodiscard]] PointerCapture capturePointerInLab(const Installation& truth, std::uint32_t seed,
                                                 const RegistrationLabOptions& options = {});
/// Throws InvalidInput without a projector, or where it lights no table beside the device.
[[nodiscard]] DotCapture captureDotsInLab(const Rig& rig, const Installation& believed, const Installation& truth,
                                          std::uint32_t seed, const RegistrationLabOptions& options = {});
[[nodiscard]] LandmarkCapture captureLandmarksInLab(const Rig& rig, const Installation& truth, std::uint32_t seed,
                                                    const RegistrationLabOptions& options = {});
/// Structured light on the device at rest as it is decoded, while its body is tracked; and landmarks as fresh points.
struct LitDeviceCapture {
    std::vector<ProjectorPoint> light;
    PoseTrack body; ///< in the tracker's world
    std::vector<TouchedLandmark> fresh;
};
/// Its flaps are as high as the play of the true servos leaves them; by the first camera (or the lab's) and projector,
/// with a tenth of a pixel of noise at both ends.
[[nodiscard]] LitDeviceCapture captureLitDeviceInLab(const Rig& rig, const Installation& truth, std::uint32_t seed,
                                                     const RegistrationLabOptions& options = {});
/// The device's shape at rest as a room believes its servos to leave it, device frame.
[[nodiscard]] TriangleMesh shapeAtRest(const Rig& rig, const Installation& believed);
[[nodiscard]] EyeCapture captureEyeInLab(const Rig& rig, const Installation& believed, const Installation& truth,
                                         std::uint32_t seed, const RegistrationLabOptions& options = {});

} // namespace lumorph
