#include "calibration/lab/lab_world.h"

#include <cstdint>
#include <string>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "calibration/lab/lab_light.h"
#include "core/base/error.h"

namespace lumorph {
namespace {

/// A box of half sizes along three axes of its own.
void addBox(TriangleMesh& mesh, const glm::vec3& centre, const glm::mat3& axes, const glm::vec3& half) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i < 8; ++i)
        mesh.positions.push_back(
            centre + axes * (half * glm::vec3((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1)));
    for (const glm::uvec3& t : {glm::uvec3{0, 4, 6},
                                {0, 6, 2},
                                {1, 3, 7},
                                {1, 7, 5},
                                {0, 1, 5},
                                {0, 5, 4},
                                {2, 6, 7},
                                {2, 7, 3},
                                {0, 2, 3},
                                {0, 3, 1},
                                {4, 5, 7},
                                {4, 7, 6}})
        mesh.triangles.push_back(first + t);
}

} // namespace

TriangleMesh visitorHand(const glm::vec3& place, const glm::vec3& visitor) {
    constexpr glm::vec3 kPalm(0.09F, 0.025F, 0.18F);
    constexpr glm::vec3 kForearm(0.06F, 0.06F, 0.3F);
    constexpr float kRise = 0.3F; // of the forearm, metres a metre
    glm::vec3 way(visitor.x - place.x, 0.0F, visitor.z - place.z);
    way = glm::length(way) > 1e-4F ? glm::normalize(way) : glm::vec3(0.0F, 0.0F, 1.0F);
    const glm::vec3 up(0.0F, 1.0F, 0.0F);
    const glm::vec3 side = glm::cross(up, way);
    TriangleMesh mesh;
    addBox(mesh, place, {side, up, way}, 0.5F * kPalm);
    const glm::vec3 arm = glm::normalize(way + kRise * up);
    addBox(mesh, place + 0.5F * kPalm.z * way + 0.5F * kForearm.z * arm, {side, glm::cross(arm, side), arm},
           0.5F * kForearm);
    return mesh;
}

TriangleMesh deviceMesh(const ShowFrame& frame) {
    TriangleMesh mesh{*frame.devicePositions, frame.rig->restMesh().triangles};
    for (glm::vec3& point : mesh.positions) point = glm::vec3(frame.worldFromDevice * glm::vec4(point, 1.0F));
    return mesh;
}

TriangleMesh deviceMesh(const Installation& room, const Rig& rig, std::span<const double> strokes) {
    TriangleMesh mesh = deformed(rig, strokes);
    for (glm::vec3& point : mesh.positions) point = glm::vec3(room.worldFromDevice * glm::vec4(point, 1.0F));
    return mesh;
}

LabWorld roomWorld(const Installation& room, const Rig& rig, std::span<const double> strokes) {
    LabWorld world;
    world.surfaces = {{deviceMesh(room, rig, strokes), lightOfSrgb(room.deviceColor)},
                      {tableMesh(room.tableSize), lightOfSrgb(room.tableColor)}};
    return world;
}

InstalledProjector linearProjector(InstalledProjector projector) {
    projector.gamma = 1.0;
    projector.responseCurve.clear();
    projector.black = glm::vec3(0.0F);
    return projector;
}

TriangleMesh tableMesh(glm::vec2 size) {
    const glm::vec2 half = 0.5F * size;
    return {{{-half.x, 0, -half.y}, {-half.x, 0, half.y}, {half.x, 0, half.y}, {half.x, 0, -half.y}},
            {{0, 1, 2}, {0, 2, 3}}};
}

LabWorld labWorld(const ShowFrame& frame, std::span<const Image> pictures) {
    const auto& projectors = frame.installation->projectors;
    if (pictures.size() != projectors.size())
        throw InvalidInput("virtual lab",
                           std::to_string(pictures.size()) + " pictures for " + std::to_string(projectors.size()) +
                               " projectors",
                           "give one for each");
    LabWorld world;
    world.surfaces.push_back({deviceMesh(frame), lightOfSrgb(frame.installation->deviceColor)});
    world.surfaces.push_back({tableMesh(frame.installation->tableSize), lightOfSrgb(frame.installation->tableColor)});
    for (std::size_t i = 0; i < projectors.size(); ++i)
        world.projectors.push_back(
            {projectors[i], projectors[i].enabled ? pictures[i] : Image(projectors[i].camera.size)});
    return world;
}

} // namespace lumorph
