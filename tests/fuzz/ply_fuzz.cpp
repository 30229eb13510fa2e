#include <cstddef>
#include <cstdint>

#include "core/base/error.h"
#include "core/geometry/mesh_parsers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        (void)lumorph::parsePly(std::as_bytes(std::span(data, size)), "fuzz.ply");
    } catch (const lumorph::Error&) {
        return 0;
    }
    return 0;
}
