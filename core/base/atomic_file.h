#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace lumorph {

/// Replaces `file` by `bytes` all at once: they are written beside it, flushed to the disk, and
/// renamed. On failure the old file is untouched and nothing is left behind. A symbolic link stays a
/// link: what it points to is replaced. A device or pipe (`/dev/stdout`) is written to directly.
/// Throws DeviceError naming the file and the system's reason.
void writeFileAtomically(const std::filesystem::path& file, std::span<const std::byte> bytes);

/// Throws the DeviceError of a file that cannot be written; `reason` is the system's error number.
[[noreturn]] void throwWriteError(const std::filesystem::path& file, int reason);

} // namespace lumorph
