#pragma once

#include <memory>
#include <vector>

#include "core/scene/show_frame.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/scene_in_room.h"

namespace lumorph {

/// A projector that hangs at a place and looks at another.
inline InstalledProjector projectorAt(const glm::dvec3& position, const glm::dvec3& centre, glm::ivec2 size,
                                      double focal) {
    InstalledProjector projector;
    projector.camera = cameraLookingAt(position, centre, size, focal);
    projector.referenceDistance = 1.6;
    return projector;
}

inline Material unlit(const glm::vec3& color) {
    Material material;
    material.unlit = true;
    material.color = color;
    return material;
}

/// Device and table in colours that no light changes.
inline SceneInRoom unlitScene(const glm::vec3& device, const glm::vec3& table,
                              const std::vector<InstalledProjector>& projectors) {
    SceneInRoom scene;
    scene.toneMapping = false;
    scene.device.material = unlit(device);
    scene.table.material = unlit(table);
    scene.projectors = projectors;
    return scene;
}

inline std::shared_ptr<const Rig> bundledTablet() {
    static const auto rig = std::make_shared<const Rig>(test::cutTablet());
    return rig;
}

/// The tablet with two flaps lifted.
inline std::vector<double> liftedFlaps() {
    std::vector<double> strokes(bundledTablet()->actuatorCount(), 0.0);
    strokes[0] = 0.9;
    strokes[2] = 0.6;
    return strokes;
}

inline ShowFrame frameOf(const SceneInRoom& scene, const std::vector<double>& strokes) {
    ShowFrame frame;
    setSceneInRoom(frame, scene);
    static const auto assets = std::make_shared<const SceneAssets>();
    frame.assets = assets;
    frame.rig = bundledTablet();
    frame.devicePositions = std::make_shared<const std::vector<glm::vec3>>(deformed(*frame.rig, strokes).positions);
    frame.worldFromDevice = scene.worldFromDevice;
    frame.eye = scene.eye;
    return frame;
}

/// The device as it physically is, world metres.
inline TriangleMesh physicalDevice(const ShowFrame& frame) {
    TriangleMesh device = frame.rig->restMesh();
    device.positions = *frame.devicePositions;
    for (glm::vec3& point : device.positions) point = glm::vec3(frame.worldFromDevice * glm::vec4(point, 1.0F));
    return device;
}

} // namespace lumorph
