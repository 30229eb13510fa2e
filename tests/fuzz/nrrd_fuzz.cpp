#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "core/base/error.h"
#include "core/voxels/nrrd.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lumorph;
    try {
        const ByteGrid grid = parseNrrd(std::as_bytes(std::span(data, size)), "fuzz.nrrd");
        // A grid that was accepted has a byte for each voxel.
        if (grid.values.size() != grid.frame.voxelCount()) std::abort();
        if (bitsOf(grid).count() > grid.values.size()) std::abort();
    } catch (const Error&) {
        // A refusal is what a broken file is meant to get.
    }
    return 0;
}
