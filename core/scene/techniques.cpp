#include "core/scene/techniques.h"

#include "core/base/error.h"
#include "core/scene/demo_items.h"
#include "core/scene/material_library.h"

namespace lumorph {
namespace {

enum Id { kSun = 1, kDay, kShape, kFloating, kFirstCube };
enum Key { kPlain, kBump, kAnimated, kShadows, kCreases, kCubes, kHoles };

/// What the servos follow; light does not draw it. Its lowest places lie on the resting sheet.
SceneItem shape(int key) {
    HeightItem heights;
    constexpr double kLift = 0.014;
    if (key == kAnimated) heights.waves = {{kLift, 0.30, 7.0, Angle::degrees(0.0), {}}};
    // High along both short edges: the corners come up.
    if (key == kShadows || key == kCreases)
        heights.waves = {{1.6 * kLift, 0.21, 0.0, Angle::degrees(0.0), Angle::degrees(-90.0)}};
    SceneItem item = demoItem(kShape, "What the servos show", heights);
    const double lift = heights.waves.empty() ? 0.0 : heights.waves.front().amplitude;
    item.position.y = kSheet + static_cast<float>(lift);
    item.role = ItemRole::physical;
    item.opacity = 0.0F;
    return item;
}

void addCubes(Scene& scene, bool visible) {
    SceneItem group = demoItem(kFloating, "Floating cubes", GroupItem{});
    group.visible = visible;
    group.position.y = kSheet;
    scene.items.push_back(group);
    const struct {
        glm::vec3 position;
        float side;
        double spin;
        glm::vec3 color;
    } cubes[] = {
        {{-0.055F, 0.030F, 0.025F}, 0.026F, 40.0, {0.90F, 0.36F, 0.28F}},
        {{0.005F, 0.042F, -0.028F}, 0.032F, -28.0, {0.26F, 0.55F, 0.78F}},
        {{0.060F, 0.026F, 0.020F}, 0.020F, 60.0, {0.96F, 0.76F, 0.27F}},
        {{0.048F, 0.055F, -0.040F}, 0.016F, -75.0, {0.45F, 0.70F, 0.42F}},
    };
    int number = 0;
    for (const auto& cube : cubes) {
        SceneItem item = demoItem(kFirstCube + number, "Cube " + std::to_string(number + 1),
                                  ShapeItem{ShapeItem::Form::box, glm::vec3(cube.side)}, kFloating);
        item.position = cube.position;
        item.motion = {Angle::degrees(cube.spin).inRadians(), 0.006, 3.0 + 0.7 * number};
        item.material.name = "Paint";
        item.material.color = cube.color;
        item.material.roughness = 0.45F;
        scene.items.push_back(item);
        ++number;
    }
}

Material skinOf(int key) {
    switch (key) {
    case kBump:
        return readyMaterial("Brick");
    case kAnimated: {
        Material material = readyMaterial("Caustics");
        material.colorTexture.velocity = {0.02F, 0.008F};
        material.colorTexture.framesPerSecond = 14.0;
        return material;
    }
    case kCubes:
        return readyMaterial("Stone");
    case kHoles: {
        Material material = readyMaterial("Ice");
        material.holes.image = "resource:materials/ice_holes.png";
        material.holes.tile = glm::vec2(0.16F);
        material.holeThreshold = 0.42F;
        return material;
    }
    default:
        return readyMaterial("Paper");
    }
}

} // namespace

SceneItem demoItem(int id, std::string name, ItemKind kind, int parent) {
    SceneItem item;
    item.id = id;
    item.parent = parent;
    item.name = std::move(name);
    item.kind = std::move(kind);
    return item;
}

void turnSun(Scene& scene, int group, double period) {
    SceneItem day = demoItem(group, "Day", GroupItem{});
    day.anchor = Anchor::world;
    // Whole degrees a second where they come out even, so that the file reads well.
    if (period > 0.0) day.motion.spin = Angle::degrees(360.0 / period).inRadians();
    scene.items.front().parent = group;
    scene.items.insert(scene.items.begin(), std::move(day));
}

std::vector<Technique> techniques() {
    return {
        {kPlain, "Plain device", "The device as it is: paper over six servos, with nothing but light on it."},
        {kBump, "Bump map",
         "Only the directions of the surface change, and flat paper looks like a wall of bricks as the sun goes "
         "round."},
        {kAnimated, "Animated texture",
         "Quick ripples of light run over a sheet that rises and falls slowly: speed that no servo has."},
        {kShadows, "Shadows", "One shape, and a sun that only light makes: its shadow wanders while nothing moves."},
        {kCreases, "Edges", "The folds of the sheet are drawn as sharp lines, so that a soft bend looks like an edge."},
        {kCubes, "Floating objects", "Cubes turn in the air above the sheet; their shadows say how high they are."},
        {kHoles, "Holes", "The table shows through holes in the ice, and the device seems smaller than it is."},
    };
}

Scene techniqueScene(int key) {
    if (key < kPlain || key > kHoles)
        throw InvalidInput("technique " + std::to_string(key), "there is none of this number",
                           "choose one from 0 to 6");
    Scene scene = defaultScene();
    turnSun(scene, kDay, key == kBump || key == kShadows ? 18.0 : 0.0);
    scene.items.push_back(shape(key));
    addCubes(scene, key == kCubes);
    scene.device.material = skinOf(key);
    if (key == kCreases) scene.device.creases.emphasis = 1.0;
    if (key == kHoles) {
        scene.device.shrink = 0.12;
        scene.device.holes = {{{0.045F, -0.02F}, 0.017}};
    }
    return scene;
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
                 {0.0018, 0.050, 0.8, Angle::degrees(35.0), {}},
                 {0.0010, 0.031, 0.55, Angle::degrees(-20.0), {}},
                 {0.0005, 0.019, 0.4, Angle::degrees(80.0), {}}};
    sea.floor = -0.036;
    SceneItem water = demoItem(kSea, "Sea", sea);
    water.role = ItemRole::split;
    water.position.y = kSheet + 0.018F;
    water.material = readyMaterial("Water");
    scene.items.push_back(water);

    SceneItem buoy = demoItem(kBuoy, "Buoy", ShapeItem{ShapeItem::Form::sphere, glm::vec3(0.024F)});
    buoy.position = {-0.045F, 0.043F, 0.012F};
    buoy.motion = {0.0, 0.012, 6.0};
    buoy.material.name = "Paint";
    buoy.material.color = {0.88F, 0.26F, 0.18F};
    buoy.material.roughness = 0.35F;
    scene.items.push_back(buoy);

    SceneItem crate = demoItem(kCrate, "Crate", ShapeItem{ShapeItem::Form::box, {0.028F, 0.020F, 0.022F}});
    crate.position = {0.050F, 0.045F, -0.020F};
    crate.rotation = glm::angleAxis(0.12F, glm::vec3(0.0F, 0.0F, 1.0F));
    crate.motion = {Angle::degrees(9.0).inRadians(), 0.004, 6.0};
    crate.material = readyMaterial("Wood");
    crate.material.colorTexture.tile = glm::vec2(0.05F);
    crate.material.normalMaps[0].tile = glm::vec2(0.05F);
    scene.items.push_back(crate);
    return scene;
}

} // namespace lumorph
