#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "calibration/decode/calibration_board.h"
#include "calibration/solve/crosshair_calibration.h"
#include "calibration/solve/procam_calibration.h"
#include "core/scene/installation.h"

namespace lumorph {

/// Where a calibration's devices belong in an installation, and how the room's world follows from one pose.
struct RoomPlacement {
    std::size_t projector = 0;    ///< of the installation; one more than there are is added
    std::size_t camera = 0;       ///< likewise
    double metresPerUnit = 0.001; ///< of the board's lengths
    /// The pose whose board lay flat on the table, printed side up: its plane is the world's y = 0. Nothing: the first.
    std::optional<std::string> tableView;
    glm::dvec2 middle{0.0}; ///< where the middle of the board's points lay on the table: world x and z, metres
    /// From the world's +x to the board's x axis (along a row of its points), about +Y, radians. Nothing: 0 or half a
    /// turn, whichever puts the projector nearer to where the installation has it; some boards look the same so.
    std::optional<double> turn;
    std::string date; ///< of the measurement, UTC; empty: now
};

/// The poses of `result` that can give the world, by name: those in which the board's pose is known.
[[nodiscard]] std::vector<std::string> tableViewsOf(const ProcamCalibration& result);

/// The world (metres, +Y up) from the camera's frame (the board's unit). Throws InvalidInput for a pose that is not
/// there, or a unit that is none.
[[nodiscard]] glm::dmat4 worldFromCamera(const ProcamCalibration& result, const CalibrationBoard& board,
                                         const Installation& installation, const RoomPlacement& placement);

/// The installation with projector and camera as calibrated: lenses and poses, each with its origin; all else as it
/// was. A calibration of a camera alone moves no projector. Throws InvalidInput where a device would stand below the
/// table, or the result is none (checkInstallation).
[[nodiscard]] Installation withCalibration(Installation installation, const ProcamCalibration& result,
                                           const CalibrationBoard& board, const RoomPlacement& placement = {});

/// The installation with what a file says (its lengths as `placement` says): as `withCalibration` where it has poses of
/// a board. Else nothing says where its camera stood, and lenses alone are taken over; a camera that the room lacks is
/// added where the projector stands. Throws as `withCalibration`.
[[nodiscard]] Installation withImport(Installation installation, const ProcamCalibration& result,
                                      const CalibrationBoard& board, const RoomPlacement& placement = {});

/// Whether a room has lenses and poses as `made` has them, of this projector, or where `made` has none of the camera.
[[nodiscard]] bool hasSameFigures(const Installation& room, const Installation& made, bool ofProjector,
                                  std::size_t index);

/// 95 % of light lands within this on the boards, millimetres, by views that were held out; lengths in millimetres.
/// Nothing without such views.
[[nodiscard]] std::optional<double> heldOutMillimetresOf(const ProcamCalibration& result);

/// The installation with a projector as crosshairs on points of the device (device frame) tell it: lens and pose, the
/// device lying where the installation has it; all else as it was. `points` is how many were aimed at, for the origin;
/// `date` as in RoomPlacement. Throws InvalidInput as above.
[[nodiscard]] Installation withCrosshairs(Installation installation, const CrosshairCalibration& result,
                                          std::size_t points, std::size_t projector = 0, const std::string& date = {});

/// A lens as the installation holds it.
[[nodiscard]] CalibratedCamera cameraOf(const CalibratedDevice& device);

} // namespace lumorph
