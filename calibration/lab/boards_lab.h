#pragma once

#include <cstdint>
#include <string>

#include <glm/vec3.hpp>

#include "calibration/doctor/boards_capture.h"
#include "calibration/lab/board_lab.h"
#include "calibration/patterns/capture_order.h"
#include "core/base/progress.h"
#include "core/scene/installation.h"

namespace lumorph {

/// How boards are photographed in the lab before all projectors and cameras of a room, or before a mirror.
struct BoardsLabOptions {
    std::string board = "chess:9x7:25"; ///< millimetres
    std::string pattern = kFourStepPattern;
    int poses = 7; ///< the first lies flat on the table around the world's origin
    BoardLabOptions pictures;
    /// Somebody pushes the last projector by so many metres before the fourth pose.
    double push = 0.0;
};

/// All enabled projectors of `truth` light each pose one after the other, and all its cameras photograph it; without a
/// camera that of the lab. Throws InvalidInput without a projector, or where the board does not fit into what all see;
/// CaptureRefused as `readPose`; Cancelled.
[[nodiscard]] BoardsCapture captureBoardsInLab(const Installation& truth, std::uint32_t seed,
                                               const BoardsLabOptions& options = {}, const Progress& progress = {});

/// A plane mirror of the lab, world metres: the points X with normal . X = distance.
struct LabMirror {
    glm::dvec3 normal{0.0};
    double distance = 0.0;
};
/// How the lab has it: a mirror upright beside the table, and a camera with a wide lens that has the board and its
/// mirror image in one picture. `room`: the projector is its first. Gives the room with that camera.
[[nodiscard]] Installation mirrorRoomTruth(Installation room, LabMirror& mirror);

/// The first projector lights each pose, and the first camera photographs it by way of the mirror; then the mirror is
/// covered, and the camera sees the board past it where all of that is in its picture. Throws as above.
[[nodiscard]] MirrorCapture captureMirrorInLab(const Installation& truth, const LabMirror& mirror, std::uint32_t seed,
                                               const BoardsLabOptions& options = {}, const Progress& progress = {});

} // namespace lumorph
