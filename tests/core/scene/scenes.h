#pragma once

#include "core/scene/installation.h"
#include "core/scene/scene.h"

/// Scenes and a room for tests.
namespace lumorph::test {

inline SceneItem itemOf(int id, ItemKind kind, int parent = 0) {
    SceneItem item;
    item.id = id;
    item.parent = parent;
    item.name = "item " + std::to_string(id);
    item.kind = std::move(kind);
    return item;
}

/// No value in it is the one it has by itself.
inline Scene fullScene() {
    SceneTexture texture;
    texture.image = "pictures/sea.png";
    texture.tile = {0.1F, 1.0F / 3.0F};
    texture.turn = Angle::degrees(33.3);
    texture.velocity = {-0.01F, 1e-7F};
    texture.columns = 4;
    texture.rows = 3;
    texture.framesPerSecond = 12.5;
    Material material;
    material.name = "Meer \"tief\"";
    material.color = {0.1F, 0.2F, 0.3F};
    material.colorTexture = texture;
    material.normalMaps[1] = texture;
    material.normalStrength = -0.7F;
    material.roughness = 0.1F;
    material.metallic = 0.9F;
    material.emission = {1.0F, 0.5F, 0.25F};
    material.emissionStrength = 7.0F;
    material.reflection = 0.3F;
    material.refraction = 0.6F;
    material.refractiveIndex = 1.5F;
    material.alpha = Material::Alpha::blend;
    material.opacity = 0.77F;
    material.holes = texture;
    material.holeThreshold = 0.123456789F;
    material.unlit = true;

    Scene scene;
    SceneItem group = itemOf(7, GroupItem{});
    group.anchor = Anchor::world;
    group.position = {0.1F, -0.2F, 0.3F};
    group.rotation = glm::angleAxis(0.5F, glm::vec3(0.6F, 0.0F, 0.8F));
    group.scale = {1.1F, 0.9F, 2.0F};
    group.opacity = 0.5F;
    group.visible = false;
    group.motion = {Angle::degrees(20.0).inRadians(), 0.01, 2.5};
    scene.items.push_back(group);
    scene.items.push_back(itemOf(3, MeshItem{"models/fish.glb", 2, -1.5, false}, 7));
    scene.items.push_back(itemOf(4, TargetItem{}));
    scene.items.push_back(itemOf(5, ShapeItem{ShapeItem::Form::cylinder, {0.01F, 0.02F, 0.03F}}));
    HeightItem heights;
    heights.size = {0.3F, 0.2F};
    heights.waves = {{0.004, 0.07, 1.3, Angle::degrees(-120.0), Angle::degrees(5.0)}, {}};
    heights.image = "pictures/relief.png";
    heights.imageHeight = 0.033;
    heights.floor = -0.015;
    heights.calmEdge = 0.01;
    scene.items.push_back(itemOf(6, heights));
    scene.items.back().role = ItemRole::split;
    scene.items.back().material = material;
    scene.items.push_back(itemOf(8, FogItem{{0.2F, 0.1F, 0.15F}, 20.0, {0.5F, 0.6F, 0.7F}, 0.03, {-0.01F, 0.02F}}, 7));
    scene.items.push_back(itemOf(9, LightItem{LightItem::Kind::lamp, {1.0F, 0.9F, 0.8F}, 3.3, 0.2, false}));

    scene.device.show = DeviceSkin::Show::content;
    scene.device.material = material;
    scene.device.shrink = 0.25;
    scene.device.holes = {{{0.01F, -0.02F}, 0.012}, {{0.0F, 0.03F}, 0.02}};
    scene.device.creases = {-0.5, Angle::degrees(12.0), 0.003, {0.1F, 0.0F, 0.2F}};
    scene.table.material = material;
    scene.sky = {0.1F, 0.2F, 0.35F};
    scene.exposure = 1.25;
    scene.toneMapping = false;
    scene.showing = Showing::virtualOnly;
    scene.viewDependence = {true, Angle::degrees(75.0)};
    return scene;
}

/// No value in it is the one it has by itself.
inline Installation fullInstallation() {
    const auto measured = [](const char* method, const char* date) {
        return Origin{Origin::Way::measured, method, date};
    };
    Installation installation;
    installation.projectors = {defaultInstallation().projectors.front(), InstalledProjector{}};
    InstalledProjector& projector = installation.projectors[0];
    projector.name = "Beamer";
    projector.enabled = false;
    projector.focus = {0.0075, 1.85};
    projector.referenceDistance = 1.9;
    projector.peak = 2.5;
    projector.gain = {0.9F, 1.0F, 1.1F};
    projector.gamma = 2.2;
    projector.lens = measured("structured light, 12 boards", "2026-11-20T09:00:00Z");
    projector.pose = {Origin::Way::entered, {}, "2026-11-21T10:30:00Z"};
    projector.response = measured("exposure series", "2026-11-22T11:15:00Z");
    InstalledCamera camera;
    camera.name = "Kamera \"links\"";
    camera.address = "camera2";
    camera.camera = cameraLookingAt({-0.4, 1.3, 0.5}, {0.02, 0.0, -0.01}, {1600, 1200}, 1650.0);
    camera.camera.distortion = {-0.21, 0.07, 0.001, -0.002, 0.01};
    camera.lens = measured("20 boards", "2026-11-19T08:00:00Z");
    camera.pose = measured("board on the table", "2026-11-19T08:05:00Z");
    installation.cameras = {camera, InstalledCamera{}};
    installation.tableSize = {1.5F, 1.0F};
    installation.worldFromDevice = glm::mat4_cast(glm::angleAxis(0.7F, glm::vec3(0.0F, 1.0F, 0.0F)));
    installation.worldFromDevice[3] = {0.02F, 0.01F, -0.03F, 1.0F};
    installation.deviceColor = {0.8F, 0.7F, 0.6F};
    installation.tableColor = {0.5F, 0.4F, 0.3F};
    installation.eye = {0.1F, 0.5F, 0.6F};
    installation.eyeFromHead = {0.01F, -0.07F, 0.09F};
    installation.pointerTip = {0.002F, -0.16F, 0.01F};
    installation.worldFromTracker = glm::mat4_cast(glm::angleAxis(-0.4F, glm::vec3(0.6F, 0.8F, 0.0F)));
    installation.worldFromTracker[3] = {0.3F, 0.8F, -0.2F, 1.0F};
    installation.bodyFromDevice[3] = {0.01F, -0.02F, 0.07F, 1.0F};
    installation.servos = {{"flap 1", {{}, {0.5, 0.46, 0.49}, {1.0, 0.93, 0.95}}, 0.11}, {"flap 2", {}, 0.09}};
    installation.trackerSeconds = 0.012;
    installation.projectors[1].black = {0.004F, 0.003F, 0.005F};
    installation.projectors[1].responseCurve = {{}, {0.5, {0.21F, 0.22F, 0.24F}}, {1.0, glm::vec3(1.0F)}};
    installation.viewer = ViewerChoice::nearest;
    installation.compensation = false;
    installation.predictionSeconds = 0.08;
    installation.origins.table = measured("photograph of the edges", "2026-11-23T12:00:00Z");
    installation.origins.devicePlace = measured("probe on four corners", "2026-11-23T12:10:00Z");
    installation.origins.colors = measured("white and black pictures", "2026-11-23T12:20:00Z");
    installation.origins.eyeOffset = measured("sights", "2026-11-23T12:30:00Z");
    installation.origins.delays = measured("flashing square", "2026-11-23T12:40:00Z");
    installation.origins.tracker = measured("touched points", "2026-11-23T12:50:00Z");
    installation.origins.deviceBody = measured("9 landmarks", "2026-11-23T13:00:00Z");
    installation.origins.pointer = measured("pivot", "2026-11-23T13:10:00Z");
    installation.origins.servos = measured("structured light", "2026-11-23T13:20:00Z");
    return installation;
}

} // namespace lumorph::test
