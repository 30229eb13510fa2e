#pragma once

#include "core/scene/scene.h"

/// Scenes for tests.
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
    scene.device.surfaceColor = {0.8F, 0.7F, 0.6F};
    scene.table = {{1.5F, 1.0F}, material};
    scene.table.surfaceColor = {0.5F, 0.4F, 0.3F};
    scene.sky = {0.1F, 0.2F, 0.35F};
    scene.exposure = 1.25;
    scene.toneMapping = false;
    scene.showing = Showing::virtualOnly;
    scene.viewDependence = {true, Angle::degrees(75.0)};
    scene.viewer = ViewerChoice::nearest;
    scene.compensation = false;
    scene.predictionSeconds = 0.08;
    scene.projectors = {defaultScene().projectors.front(), SceneProjector{}};
    scene.projectors[0].name = "Beamer";
    scene.projectors[0].enabled = false;
    scene.projectors[0].referenceDistance = 1.9;
    scene.projectors[0].peak = 2.5;
    scene.projectors[0].gain = {0.9F, 1.0F, 1.1F};
    scene.projectors[0].gamma = 2.2;
    scene.eye = {0.1F, 0.5F, 0.6F};
    scene.worldFromDevice = glm::mat4_cast(glm::angleAxis(0.7F, glm::vec3(0.0F, 1.0F, 0.0F)));
    scene.worldFromDevice[3] = {0.02F, 0.01F, -0.03F, 1.0F};
    return scene;
}

} // namespace lumorph::test
