#pragma once

#include <cstdint>
#include <vector>

namespace lumorph {

/// The fibres of paper as a picture that repeats without seams: `side` x `side` grey values around 128, always the
/// same. `side` is at least 16.
[[nodiscard]] std::vector<std::uint8_t> paperFibre(int side);

} // namespace lumorph
