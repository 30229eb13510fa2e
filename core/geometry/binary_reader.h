#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <span>

namespace lumorph {

/// A number at the start of `bytes`, which must hold at least sizeof(T) of them.
template <typename T>
[[nodiscard]] T readNumber(std::span<const std::byte> bytes, std::endian order = std::endian::little) noexcept {
    std::array<std::byte, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes.data(), sizeof(T));
    if (order != std::endian::native) std::ranges::reverse(raw);
    return std::bit_cast<T>(raw);
}

} // namespace lumorph
