#pragma once

#include <filesystem>

#include "core/base/progress.h"
#include "core/mdf/field.h"

namespace lumorph {

/// Writes the field as NRRD files for ParaView, 3D Slicer or a script into `folder` (made if needed):
/// for each actuator K from 0 `actuator-K-v0.nrrd`, `-v1`, `-base`, `-top` (v0 = v1 = 255 where it
/// changes nothing; base and top in 1/255), `background.nrrd` (P in 1/255) and `body.nrrd` (0 or 1).
/// All uint8, x fastest. Throws DeviceError when the disk refuses, Cancelled between two
/// files; what is written by then stays.
void exportField(const Field& field, const std::filesystem::path& folder, const Progress& progress = {});

} // namespace lumorph
