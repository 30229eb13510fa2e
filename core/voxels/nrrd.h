#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/voxels/bit_columns.h"
#include "core/voxels/voxel_frame.h"

namespace lumorph {

/// A dense grid of bytes, x fastest, then y, then z, with its place in space.
struct ByteGrid {
    VoxelFrame frame;
    std::vector<std::uint8_t> values;
};

/// A NRRD file (version 4, attached header, uint8, encoding raw) as ParaView and 3D Slicer read it:
/// sizes x y z, space directions = voxel side, space origin = centre of the first voxel, metres.
[[nodiscard]] std::vector<std::byte> writeNrrd(const ByteGrid& grid, const std::string& content);

/// Reads a three-dimensional uint8 NRRD with an attached header and raw encoding. Without `space
/// directions`, `spacings` count; with neither the voxel side is 1. Throws DataError naming `name`,
/// the header line and the remedy; never trusts a size.
[[nodiscard]] ByteGrid parseNrrd(std::span<const std::byte> bytes, const std::string& name);

/// Bits as bytes 0 and 1, and back (every byte but 0 counts).
[[nodiscard]] ByteGrid bytesOf(const VoxelFrame& frame, const BitColumns& bits);
[[nodiscard]] BitColumns bitsOf(const ByteGrid& grid);

} // namespace lumorph
