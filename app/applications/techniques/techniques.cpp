#include "app/applications/techniques/techniques.h"

#include "app/applications/demo_items.h"
#include "app/applications/techniques/techniques_program.h"
#include "core/base/error.h"
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
    case kBump: {
        Material material = readyMaterial("Brick");
        material.normalStrength = 1.6F;
        return material;
    }
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

/// To 28 degrees above the table, so that relief and raised corners throw long shadows; on the table it is as bright.
void lowerSun(SceneItem& sun) {
    sun.position = {-0.72F, 0.46F, -0.49F};
    std::get<LightItem>(sun.kind).intensity = 1.5;
}

/// Leaves the scene of a technique without it.
void takeAway(Scene& scene, int key) {
    Material& skin = scene.device.material;
    switch (key) {
    case kBump:
        skin.normalMaps = {};
        break;
    case kAnimated:
        skin.colorTexture.velocity = glm::vec2(0.0F);
        skin.colorTexture.framesPerSecond = 0.0;
        break;
    case kShadows:
        for (SceneItem& item : scene.items)
            if (auto* light = std::get_if<LightItem>(&item.kind)) light->shadows = false;
        break;
    case kCreases:
        scene.device.creases.emphasis = 0.0;
        break;
    case kCubes:
        for (SceneItem& item : scene.items)
            if (item.id == kFloating) item.visible = false;
        break;
    case kHoles:
        skin.holes = {};
        scene.device.shrink = 0.0;
        scene.device.holes = {};
        break;
    default:
        break;
    }
}

} // namespace

std::vector<Technique> techniques() {
    return {
        {kPlain,
         {"Plain device", "Nur das Gerät"},
         {"The device as it is: paper over six servos, with nothing but light on it.",
          "Das Gerät, wie es ist: Papier über sechs Servos, und nichts als Licht darauf."}},
        {kBump,
         {"Bump map", "Relief aus Licht"},
         {"Only the directions of the surface change, and flat paper looks like a wall of bricks as the sun goes "
          "round.",
          "Nur die Richtungen der Oberfläche ändern sich, und flaches Papier sieht aus wie eine Ziegelwand, um die die "
          "Sonne geht."}},
        {kAnimated,
         {"Animated texture", "Bewegtes Muster"},
         {"Quick ripples of light run over a sheet that rises and falls slowly: speed that no servo has.",
          "Schnelle Wellen aus Licht laufen über ein Blatt, das sich langsam hebt und senkt: so schnell ist kein "
          "Servo."}},
        {kShadows,
         {"Shadows", "Schatten"},
         {"One shape, and a sun that only light makes: its shadow wanders while nothing moves.",
          "Eine Form, und eine Sonne nur aus Licht: Ihr Schatten wandert, und nichts bewegt sich."}},
        {kCreases,
         {"Edges", "Kanten"},
         {"The folds of the sheet are drawn as sharp lines, so that a soft bend looks like an edge.",
          "Die Falten des Blattes werden scharf gezeichnet, und eine weiche Biegung sieht aus wie eine Kante."}},
        {kCubes,
         {"Floating objects", "Schwebende Dinge"},
         {"Cubes turn in the air above the sheet; their shadows say how high they are.",
          "Würfel drehen sich in der Luft über dem Blatt; ihre Schatten sagen, wie hoch sie sind."}},
        {kHoles,
         {"Holes", "Löcher"},
         {"The table shows through holes in the ice, and the device seems smaller than it is.",
          "Durch Löcher im Eis sieht man den Tisch, und das Gerät scheint kleiner, als es ist."}},
    };
}

Scene techniqueScene(int key, bool on) {
    if (key < kPlain || key > kHoles)
        throw InvalidInput("technique " + std::to_string(key), "there is none of this number",
                           "choose one from 0 to 6");
    Scene scene = defaultScene();
    const bool sunTurns = key == kBump || key == kShadows;
    if (sunTurns) lowerSun(scene.items.front());
    turnSun(scene, kDay, sunTurns ? 18.0 : 0.0);
    scene.items.push_back(shape(key));
    addCubes(scene, key == kCubes);
    scene.device.material = skinOf(key);
    if (key == kCreases) scene.device.creases.emphasis = 1.0;
    if (key == kHoles) {
        scene.device.shrink = 0.12;
        scene.device.holes = {{{0.045F, -0.02F}, 0.017}};
    }
    if (!on) takeAway(scene, key);
    return scene;
}

Demo techniquesDemo() {
    return {
        .name = "techniques",
        .title = {"What light adds", "Was Licht hinzufügt"},
        .sentence = {"Six ways in which light extends what six servos can show, one number key each.",
                     "Sechs Arten, wie Licht erweitert, was sechs Servos zeigen können; jede hat eine Zifferntaste."},
        .thumbnail = "thumbnails/techniques.png",
        .open = [](const Progress& progress) { return bundledProject("techniques", progress); },
        .steps =
            [] {
                std::vector<DemoStep> steps;
                for (const Technique& technique : techniques())
                    steps.push_back({technique.key, technique.name, technique.sentence, techniqueScene(technique.key),
                                     techniqueScene(technique.key, false)});
                return steps;
            },
        .program = [](const ProgramStart&, const Progress&) -> std::unique_ptr<ShowProgram> {
            return std::make_unique<TechniquesProgram>();
        },
        .filmSeconds = (kHoles - kPlain) * (TechniquesProgram::kWithout + TechniquesProgram::kWith),
        .compares = true};
}

} // namespace lumorph
