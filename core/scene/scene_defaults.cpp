#include <cmath>

#include "core/scene/installation.h"
#include "core/scene/scene.h"

namespace lumorph {
namespace {

/// A full-HD projector 2 m above the table and a little on the viewer's side, so that a far flap that bends up for him
/// is lit on the side he sees, while his head stays out of the light. Like most projectors it has a lens shift: its
/// axis leaves through the lower edge of the picture. 0.62 x 0.35 m around the device are lit, a third of a millimetre
/// a pixel.
InstalledProjector defaultProjector() {
    const glm::dvec3 position(0.0, 2.0, 0.4);
    const double focal = 6080.0;
    const double shift = 620.0; // pixels from the picture's middle down to the axis
    InstalledProjector projector;
    projector.name = "Projector above the table";
    projector.camera.size = {1920, 1080};
    projector.camera.focal = {focal, focal + 6.0};
    projector.camera.principal = {959.5 + 7.0, 539.5 + shift};
    projector.camera.distortion = {-0.052, 0.031, 0.0006, -0.0004, 0.0};
    // The picture's middle lies on the device, so the axis leans towards the viewer by the angle of the shift.
    const double toDevice = std::atan2(-position.z, position.y - 0.02);
    const double lean = toDevice + std::atan2(shift, focal);
    projector.camera.cameraFromWorld =
        cameraLookingAt(position, position + glm::dvec3(0.0, -std::cos(lean), std::sin(lean)), projector.camera.size,
                        focal)
            .cameraFromWorld;
    return projector;
}

SceneItem defaultSun() {
    SceneItem sun;
    sun.id = 1;
    sun.name = "Sun";
    sun.anchor = Anchor::world;
    sun.position = {-0.55F, 0.80F, -0.40F}; // from the upper left, as on paper
    sun.kind = LightItem{.color = {1.0F, 0.97F, 0.92F}, .intensity = 0.95, .softness = 0.04};
    return sun;
}

Material paper() {
    Material material;
    material.name = "Paper";
    material.color = {0.955F, 0.945F, 0.92F};
    material.roughness = 0.95F;
    return material;
}

SceneTexture bundledPicture(const std::string& image, float metres) {
    SceneTexture texture;
    texture.image = image;
    texture.tile = glm::vec2(metres);
    return texture;
}

Material tableWood() {
    Material material;
    material.name = "Wood";
    material.color = {0.86F, 0.80F, 0.74F};
    material.colorTexture = bundledPicture("resource:materials/wood.png", 0.45F);
    material.normalMaps[0] = bundledPicture("resource:materials/wood_normal.png", 0.45F);
    material.roughness = 0.55F;
    return material;
}

} // namespace

Scene defaultScene() {
    Scene scene;
    scene.items.push_back(defaultSun());
    scene.device.material = paper();
    scene.table.material = tableWood();
    return scene;
}

Installation defaultInstallation() {
    Installation installation;
    installation.projectors.push_back(defaultProjector());
    return installation;
}

} // namespace lumorph
