#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/rig/rig_file.h"
#include "tests/fuzz/glb_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lumorph;
    constexpr std::size_t kMaxInput = 1 << 16;
    if (size > kMaxInput) return 0;
    try {
        const Rig rig = readRigGlb(fuzz::glbOf(std::as_bytes(std::span(data, size))), "fuzz.glb");
        if (rig.restMesh().positions.size() > 10'000) return 0; // valid but slow
        // What was accepted must deform without harm and stay where its reach says.
        const std::vector<double> full(rig.actuatorCount(), 1.0);
        std::vector<glm::vec3> positions(rig.restMesh().positions.size());
        rig.deform(full, positions);
        const Box box = boundingBox(positions);
        const float slack = 1e-3F * (1.0F + glm::length(rig.reach().size()));
        for (int axis = 0; axis < 3 && !box.empty(); ++axis)
            if (box.min[axis] < rig.reach().min[axis] - slack || box.max[axis] > rig.reach().max[axis] + slack)
                std::abort();
    } catch (const Error&) {
        // A refusal is what a broken file is meant to get.
    }
    return 0;
}
