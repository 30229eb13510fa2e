#pragma once

#include <utility>
#include <vector>

#include "core/rig/rig.h"

namespace lumorph::test {

/// A rig of loose points (at least three), every actuator moving all of them fully.
inline RigParts pointParts(std::vector<glm::vec3> points, std::vector<Deformer> deformers) {
    RigParts parts;
    parts.name = "points";
    parts.restMesh.positions = std::move(points);
    parts.restMesh.triangles = {{0, 1, 2}};
    for (Deformer& deformer : deformers) {
        Actuator actuator;
        actuator.name = "actuator " + std::to_string(parts.actuators.size());
        if (!std::holds_alternative<SkinJoint>(deformer))
            for (std::uint32_t v = 0; v < parts.restMesh.positions.size(); ++v)
                actuator.influences.push_back({v, 1.0F});
        actuator.deformer = std::move(deformer);
        parts.actuators.push_back(std::move(actuator));
    }
    return parts;
}

inline std::vector<glm::vec3> positionsAt(const Rig& rig, const std::vector<double>& strokes) {
    return deformed(rig, strokes).positions;
}

} // namespace lumorph::test
