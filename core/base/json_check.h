#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace lumorph {

/// Bounds on a JSON text that comes from outside.
struct JsonLimits {
    std::size_t bytes = std::size_t{64} << 20;
    std::size_t depth = 64;
    std::size_t values = 1'000'000;
};

/// What keeps a text from being parsed without harm, as the end of a sentence about its file ("nests JSON deeper than
/// 64 levels"); empty when nothing does. One pass without recursion that keeps nothing.
[[nodiscard]] std::string jsonProblem(std::string_view text, const JsonLimits& limits = {});

} // namespace lumorph
