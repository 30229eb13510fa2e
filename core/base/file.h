#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace lumorph {

/// The whole content of a file; an empty file gives no bytes.
/// Throws DataError naming the file when it is missing, not readable, a folder, or larger than
/// `maxBytes`; memory is taken for what is there, never for more than `maxBytes`.
[[nodiscard]] std::vector<std::byte> readFile(const std::filesystem::path& file, std::size_t maxBytes);

} // namespace lumorph
