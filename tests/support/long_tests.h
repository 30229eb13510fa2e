#pragma once

#include <cstdlib>
#include <string_view>

namespace lumorph::test {

/// Whether tables of many trials are to run whole: LUMORPH_LONG_TESTS=1.
inline bool longTests() {
    const char* wish = std::getenv("LUMORPH_LONG_TESTS");
    return wish != nullptr && std::string_view(wish) == "1";
}

} // namespace lumorph::test
