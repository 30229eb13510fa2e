#pragma once

#include <filesystem>

#include "core/base/image.h"

namespace lumorph {

/// Writes an opaque picture as a PNG of three channels, packed as small as it gets.
void writeOpaquePng(const Image& image, const std::filesystem::path& file);

} // namespace lumorph
