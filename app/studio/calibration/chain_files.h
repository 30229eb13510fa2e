#pragma once

#include "app/studio/calibration/chain.h"
#include "calibration/registration/registration.h"

namespace lumorph::studio {

// Links of the chain measured from recordings of a real tracker: poses as rows `time,x,y,z,qx,qy,qz,qw`, seconds and
// metres. All of them throw DataError for a file that is none, with its line, and CaptureRefused as what solves them.

/// Files: swings of the pointer in a dimple; then its tip set into three other dimples or more, each twice or more,
/// which the fit does not see. Where it rested is found by itself.
[[nodiscard]] Registration pointerFromFiles(const FileTask& task, const Progress& progress);

/// Files: a moved body in the tracker's world; a camera or board that is fixed to it, in the room's world. Each by its
/// own clock.
[[nodiscard]] Registration trackerFromFiles(const FileTask& task, const Progress& progress);

/// Files: the pointer, its tip resting on one point of the device after another; the device's body at the same time;
/// the points `name,x,y,z` in the device's frame, seven or more. One in four of them, three at least, is a check point.
[[nodiscard]] Registration deviceFromFiles(const FileTask& task, const Progress& progress);

} // namespace lumorph::studio
