#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include <glm/gtc/quaternion.hpp>

#include "core/base/error.h"
#include "devices/protocol/opentrack.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lumorph;
    try {
        const Pose pose = opentrack::poseOf(opentrack::readPacket(std::as_bytes(std::span(data, size))));
        // Whatever was accepted must be a place in a room and a turn.
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(pose.position[axis]) <= 100.0)) std::abort();
        if (!(std::abs(glm::length(pose.rotation) - 1.0) < 1e-9)) std::abort();
    } catch (const DataError&) {
        // A refusal is what a broken packet is meant to get.
    }
    return 0;
}
