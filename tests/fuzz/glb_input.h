#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tests/support/gltf_builder.h"

namespace lumorph::fuzz {

/// The GLB an input stands for. An input that is not one itself is JSON, a zero byte and binary data:
/// the lengths in a GLB would otherwise undo most changes of the JSON.
inline std::vector<std::byte> glbOf(std::span<const std::byte> input) {
    const std::string text(reinterpret_cast<const char*>(input.data()), input.size());
    if (text.starts_with("glTF")) return {input.begin(), input.end()};
    const std::size_t end = std::min(text.find('\0'), text.size());
    const auto binary = input.subspan(std::min(end + 1, text.size()));
    return support::packGlb(text.substr(0, end), {binary.begin(), binary.end()});
}

} // namespace lumorph::fuzz
