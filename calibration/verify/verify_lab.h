#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "calibration/lab/check_lab.h"
#include "calibration/verify/room_check.h"
#include "core/base/progress.h"

namespace lumorph {

/// How a check is made in the virtual lab.
struct VerifyLabOptions {
    std::string pattern = "graycode"; ///< as `parsePattern` reads it
    int cameraWidth = 640;            ///< pixels: a larger camera takes smaller pictures
    CheckLabOptions pictures;
    bool isJudged = true; ///< a further bend is photographed, by which the correction is judged
};

/// A check in the virtual lab, from photographs to a corrected room.
struct VerifiedInLab {
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

/// An installation's camera, or where it has none that of the lab beside its first projector.
[[nodiscard]] Installation withLabCamera(Installation room);

/// Photographs the room as it truly is under patterns of each projector that is on, with the lab's noise, and checks it
/// against what one believes. Throws InvalidInput for rooms without a projector, Cancelled. What a camera cannot see
/// well enough becomes a check without a verdict.
[[nodiscard]] VerifiedInLab measureVerifyInLab(const Rig& rig, const Installation& believed, const Installation& truth,
                                               std::uint32_t seed, const Progress& progress = {},
                                               const VerifyLabOptions& options = {});

} // namespace lumorph
