#pragma once

#include <filesystem>

#include "core/base/atomic_file.h"
#include "core/rig/rig_file.h"
#include "core/rig/templates/bundled_rigs.h"

namespace lumorph::test {

/// The tablet of six flaps that are cut out of its top, made by its template and not read from the bundled file. For
/// tests that need a device with a known shape, or numbers that follow from it, but are not about the bundled tablet.
[[nodiscard]] inline Rig cutTablet() { return cutTabletRig(); }

/// The same as a file `tablet.glb` in a folder. Returns its path.
inline std::filesystem::path writeCutTablet(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "tablet.glb";
    writeFileAtomically(file, writeRigGlb(cutTablet()));
    return file;
}

} // namespace lumorph::test
