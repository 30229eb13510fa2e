#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include <glm/gtc/quaternion.hpp>

#include "core/base/error.h"
#include "devices/protocol/osc_pose.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lumorph;
    try {
        for (const osc::PosePart& part : osc::readPoseParts(std::as_bytes(std::span(data, size)))) {
            if (part.body.empty() || part.body.size() > 64) std::abort();
            for (int axis = 0; axis < 3; ++axis)
                if (!(std::abs(part.value[axis]) <= 3600.0)) std::abort();
            if (!(std::abs(glm::length(osc::rotationOf(part.value)) - 1.0) < 1e-9)) std::abort();
        }
    } catch (const DataError&) {
        // A refusal is what a broken packet is meant to get.
    }
    return 0;
}
