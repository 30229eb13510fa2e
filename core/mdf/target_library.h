#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/mdf/placement.h"

namespace lumorph {

/// A shape that a device is asked for.
struct LibraryTarget {
    std::string name; ///< of its file, without the extension
    Target target;
    Box box; ///< of its mesh
};

/// Every mesh that lies in the folder itself (see `isMeshFile`), by name. Throws DataError naming the folder that is
/// not there or holds none.
[[nodiscard]] std::vector<std::filesystem::path> meshFilesIn(const std::filesystem::path& folder);

/// The meshes of some files, in their order; files of the same name but for the extension keep that in their names.
/// Throws DataError naming the file that cannot be read or has no volume; Cancelled.
[[nodiscard]] std::vector<LibraryTarget> readTargets(const std::vector<std::filesystem::path>& files,
                                                     const Progress& progress = {});

/// Every mesh that lies in the folder itself (see `isMeshFile`; an animated one as it is drawn), by name; two that
/// differ in their extension alone keep it in their names. Throws DataError naming the folder that is not there or
/// holds no mesh, or the file that cannot be read or has no volume; Cancelled.
[[nodiscard]] std::vector<LibraryTarget> readTargetLibrary(const std::filesystem::path& folder,
                                                           const Progress& progress = {});

/// How targets are put where the device can show them.
enum class TargetPlacing {
    automatic, ///< a target that holds the body at rest is a pose of a device and stays; any other is fitted
    fitted,    ///< as large as fits into the frame, standing on the device (`fitPlacement`)
    asIs,      ///< where its mesh is
};

/// Where a target stands for this body and frame. `body` holds the voxels of the device at rest.
[[nodiscard]] Placement placeTarget(const VoxelFrame& frame, float restSurface, const BitColumns& body,
                                    const LibraryTarget& target, TargetPlacing placing);

} // namespace lumorph
