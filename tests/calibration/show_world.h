#pragma once

#include <memory>
#include <vector>

#include "calibration/lab/lab.h"
#include "core/render/spatial_renderer.h"
#include "core/rig/rig_file.h"

namespace lumorph {

/// A projector that hangs at a place and looks at another.
inline SceneProjector projectorAt(const glm::dvec3& position, const glm::dvec3& centre, glm::ivec2 size, double focal) {
    SceneProjector projector;
    projector.camera = cameraLookingAt(position, centre, size, focal);
    projector.referenceDistance = 1.6;
    return projector;
}

/// Device and table in one colour that no light changes.
inline Scene uniformScene(float grey, const std::vector<SceneProjector>& projectors) {
    Scene scene;
    scene.toneMapping = false;
    scene.device.material.unlit = true;
    scene.device.material.color = glm::vec3(grey);
    scene.table.material.unlit = true;
    scene.table.material.color = glm::vec3(grey);
    scene.projectors = projectors;
    return scene;
}

inline std::shared_ptr<const Rig> tabletRig() {
    static const auto rig = std::make_shared<const Rig>(readRig(LUMORPH_SOURCE_DIR "/resources/models/tablet.glb"));
    return rig;
}

inline ShowFrame frameOf(const Scene& scene, const std::vector<double>& strokes) {
    ShowFrame frame;
    frame.scene = std::make_shared<const Scene>(scene);
    frame.assets = std::make_shared<const SceneAssets>();
    frame.rig = tabletRig();
    frame.devicePositions = std::make_shared<const std::vector<glm::vec3>>(deformed(*frame.rig, strokes).positions);
    frame.worldFromDevice = scene.worldFromDevice;
    frame.eye = scene.eye;
    return frame;
}

/// The device and the table as they physically are, lit by what the renderer sends out.
inline LabWorld labOf(const ShowFrame& frame, const SpatialRenderer& renderer) {
    LabWorld world;
    TriangleMesh device = frame.rig->restMesh();
    device.positions = *frame.devicePositions;
    for (glm::vec3& point : device.positions) point = glm::vec3(frame.worldFromDevice * glm::vec4(point, 1.0F));
    const glm::vec2 half = 0.5F * frame.scene->table.size;
    const TriangleMesh table{
        {{-half.x, 0.0F, -half.y}, {half.x, 0.0F, -half.y}, {-half.x, 0.0F, half.y}, {half.x, 0.0F, half.y}},
        {{0, 2, 1}, {1, 2, 3}}};
    world.surfaces = {{device, glm::vec3(1.0F)}, {table, glm::vec3(1.0F)}};
    for (std::size_t i = 0; i < frame.scene->projectors.size(); ++i)
        if (frame.scene->projectors[i].enabled)
            world.projectors.push_back({frame.scene->projectors[i], renderer.readProjector(i)});
    return world;
}

} // namespace lumorph
