#pragma once

#include <string>
#include <vector>

#include "calibration/capture/device_bench.h"
#include "calibration/verify/room_check.h"
#include "core/base/progress.h"

namespace lumorph {

/// How a room is verified.
struct VerifyOptions {
    std::string pattern = "graycode"; ///< as `parsePattern` reads it
    int cameraWidth = 640;            ///< pixels: pictures of a larger camera are made smaller
    bool isJudged = true;             ///< a further bend is photographed, by which the correction is judged
};

/// A check from photographs to a corrected room.
struct VerifiedRoom {
    RoomCheck check;
    /// With what was found to have moved where it was found, its origin measured; else as it was believed.
    Installation installation;
    ErrorSummary fresh; ///< of light on a bend that the check did not see, by `installation`
    int photographs = 0;
    std::vector<std::string> figures; ///< sentences
};

/// The device's bends for a check: every second actuator half raised, then the others; so the light falls on places
/// that face all sides, and each servo shows once.
[[nodiscard]] std::vector<std::vector<double>> checkBends(const Rig& rig);

/// Has the device take its bends, each from rest, photographs it under patterns of each projector that is on by the
/// room's first camera, and checks that against what one believes. Throws InvalidInput for rooms without a projector or
/// a camera, and for pictures of another shape than the camera's; what the bench throws; Cancelled. What a camera
/// cannot see well enough becomes a check without a verdict.
[[nodiscard]] VerifiedRoom verifyRoom(const Rig& rig, const Installation& believed, DeviceBench& bench,
                                      const Progress& progress = {}, const VerifyOptions& options = {});

/// The room as a check photographs it: its first camera with at most so many columns.
[[nodiscard]] Installation photographedRoom(Installation room, int width);

} // namespace lumorph
