#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/mdf/field.h"

namespace lumorph {

/// The field as a `.mdf` file: magic "LUMORPH\0MDF\0\0\0\0\0", version, then blocks of
/// {u32 kind, u32 reserved, u64 size, u64 stored size, u64 xxh64 of the stored bytes, zstd frame},
/// all little-endian. Equal fields give equal bytes. Throws InvalidInput for a field whose blocks hold
/// more than 1 GiB together.
[[nodiscard]] std::vector<std::byte> writeField(const Field& field);

/// Reads it back. Every length, index and checksum is checked before it is used, no block may
/// unpack to more than its kind can hold, nor all of them to more than 1 GiB by what their heads promise. Throws
/// DataError naming `name`, the block and the remedy.
[[nodiscard]] Field parseField(std::span<const std::byte> bytes, const std::string& name);

} // namespace lumorph
