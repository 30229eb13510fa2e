#include "calibration/lab/lab_world.h"

#include <string>

#include "calibration/lab/lab_light.h"
#include "core/base/error.h"

namespace lumorph {
namespace {

glm::vec3 albedoOf(const glm::vec3& color) {
    return {lightOfSrgb(color.r), lightOfSrgb(color.g), lightOfSrgb(color.b)};
}

} // namespace

TriangleMesh deviceMesh(const ShowFrame& frame) {
    TriangleMesh mesh{*frame.devicePositions, frame.rig->restMesh().triangles};
    for (glm::vec3& point : mesh.positions) point = glm::vec3(frame.worldFromDevice * glm::vec4(point, 1.0F));
    return mesh;
}

TriangleMesh tableMesh(const Table& table) {
    const glm::vec2 half = 0.5F * table.size;
    return {{{-half.x, 0, -half.y}, {-half.x, 0, half.y}, {half.x, 0, half.y}, {half.x, 0, -half.y}},
            {{0, 1, 2}, {0, 2, 3}}};
}

LabWorld labWorld(const ShowFrame& frame, std::span<const Image> pictures) {
    const auto& projectors = frame.scene->projectors;
    if (pictures.size() != projectors.size())
        throw InvalidInput("virtual lab",
                           std::to_string(pictures.size()) + " pictures for " + std::to_string(projectors.size()) +
                               " projectors",
                           "give one for each");
    LabWorld world;
    world.surfaces.push_back({deviceMesh(frame), albedoOf(frame.scene->device.surfaceColor)});
    world.surfaces.push_back({tableMesh(frame.scene->table), albedoOf(frame.scene->table.surfaceColor)});
    for (std::size_t i = 0; i < projectors.size(); ++i)
        world.projectors.push_back(
            {projectors[i], projectors[i].enabled ? pictures[i] : Image(projectors[i].camera.size)});
    return world;
}

} // namespace lumorph
