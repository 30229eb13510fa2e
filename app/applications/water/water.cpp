#include "app/applications/water/water.h"

#include <glm/gtc/quaternion.hpp>

#include "app/applications/demo_items.h"
#include "app/applications/water/water_program.h"
#include "core/scene/material_library.h"

namespace lumorph {

Material seaMaterial() {
    Material sea = readyMaterial("Water");
    sea.name = "Sea";
    sea.color = {0.02F, 0.38F, 0.58F};
    sea.colorTexture = readyMaterial("Caustics").colorTexture;
    sea.normalMaps[0].tile = glm::vec2(0.080F);
    sea.normalMaps[1].tile = glm::vec2(0.047F);
    sea.normalStrength = 0.17F;
    sea.roughness = 0.19F;
    sea.reflection = 0.60F;
    sea.refraction = 0.92F;
    return sea;
}

Scene waterScene() {
    enum WaterId { kWaterSun = 1, kWaterDay, kSea, kBuoy, kCrate };
    Scene scene = defaultScene();
    scene.device.show = DeviceSkin::Show::content;
    turnSun(scene, kWaterDay, 40.0);

    HeightItem sea;
    // The long wave's phase is that of the buoy, which rises and falls with it.
    sea.waves = {{0.012, 0.30, 6.0, Angle::degrees(15.0), Angle::degrees(228.0)},
                 {0.006, 0.17, 4.5, Angle::degrees(-40.0), {}},
                 {0.0013, 0.050, 0.8, Angle::degrees(35.0), {}},
                 {0.0007, 0.031, 0.55, Angle::degrees(-20.0), {}},
                 {0.0004, 0.019, 0.4, Angle::degrees(80.0), {}}};
    sea.floor = -0.036;
    SceneItem water = demoItem(kSea, "Sea", sea);
    water.role = ItemRole::split;
    water.position.y = kSheet + 0.018F;
    water.material = seaMaterial();
    scene.items.push_back(water);

    SceneItem buoy = demoItem(kBuoy, "Buoy", ShapeItem{ShapeItem::Form::sphere, glm::vec3(0.024F)});
    buoy.position = {-0.045F, 0.043F, 0.012F};
    buoy.motion = {0.0, 0.012, 6.0};
    buoy.material.name = "Paint";
    buoy.material.color = {0.88F, 0.26F, 0.18F};
    buoy.material.roughness = 0.35F;
    scene.items.push_back(buoy);

    SceneItem crate = demoItem(kCrate, "Crate", ShapeItem{ShapeItem::Form::box, {0.028F, 0.020F, 0.022F}});
    crate.position = {0.006F, 0.045F, -0.047F};
    crate.rotation = glm::angleAxis(0.12F, glm::vec3(0.0F, 0.0F, 1.0F));
    crate.motion = {Angle::degrees(9.0).inRadians(), 0.004, 6.0};
    crate.material = readyMaterial("Wood");
    crate.material.colorTexture.tile = glm::vec2(0.05F);
    crate.material.normalMaps[0].tile = glm::vec2(0.05F);
    scene.items.push_back(crate);
    return scene;
}

Demo waterDemo() {
    return {.name = "water",
            .title = {"A sea you can feel", "Ein Meer, das man fühlt"},
            .sentence = {"Lean it, and the water runs: the tablet lifts the long waves, light paints the short ones.",
                         "Neige es, und das Wasser läuft: Das Tablet hebt die langen Wellen, Licht malt die kurzen."},
            .thumbnail = "thumbnails/water.png",
            .open = [](const Progress& progress) { return bundledProject("water", progress); },
            .program = [](const ProgramStart&, const Progress&) -> std::unique_ptr<ShowProgram> {
                return std::make_unique<WaterProgram>();
            },
            .hostEdits = true};
}

} // namespace lumorph
