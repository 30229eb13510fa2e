#include "tests/support/truth_show.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace lumorph::test {
namespace {

constexpr float kTop = 0.125F; ///< of the highest thing shown, world metres

/// A picture of 0.1 m x 0.1 m, by a function of the place in millimetres.
template <typename Color> std::shared_ptr<const Image> pictureOf(Color color) {
    constexpr int kSide = 1000;
    auto image = std::make_shared<Image>(glm::ivec2(kSide));
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) image->at(x, y) = color(0.1 * x, 0.1 * y);
    return image;
}

Image::Pixel brickAt(double x, double y) {
    const int row = static_cast<int>(y / 10.0);
    const double along = std::fmod(x + (row % 2 == 0 ? 0.0 : 10.0), 20.0);
    if (along < 1.5 || std::fmod(y, 10.0) < 1.5) return {205, 200, 190, 255};
    return row % 3 == 0 ? Image::Pixel{150, 60, 40, 255} : Image::Pixel{120, 45, 35, 255};
}

/// Lines of 1 mm, three pixels of the default projector, to and fro.
Image::Pixel lineAt(double x, double y) {
    const bool line = std::fmod(x, 5.0) < 1.0 || std::fmod(y, 5.0) < 1.0;
    return line ? Image::Pixel{235, 235, 225, 255} : Image::Pixel{40, 60, 90, 255};
}

SceneItem shape(Scene& scene, ShapeItem::Form form, const glm::vec3& position, const glm::vec3& size,
                const glm::vec3& color) {
    SceneItem item;
    item.id = static_cast<int>(scene.items.size()) + 1;
    item.name = "Shape " + std::to_string(item.id);
    item.anchor = Anchor::world;
    item.position = position;
    item.material.color = color;
    item.kind = ShapeItem{form, size};
    return item;
}

void addMarker(Scene& scene) {
    scene.items.push_back(
        shape(scene, ShapeItem::Form::sphere, {0.02F, kTop - 0.006F, 0.01F}, glm::vec3(0.012F), {0.9F, 0.75F, 0.2F}));
}

void addWater(Scene& scene) {
    SceneItem item;
    item.id = static_cast<int>(scene.items.size()) + 1;
    item.name = "Water";
    item.position = {0.0F, 0.026F, 0.0F};
    item.material.color = {0.15F, 0.45F, 0.6F};
    item.material.roughness = 0.15F;
    item.material.reflection = 0.4F;
    HeightItem water;
    water.waves = {{0.003, 0.06, 2.0, Angle::degrees(20.0), {}}, {0.002, 0.035, 1.3, Angle::degrees(75.0), {}}};
    item.kind = water;
    scene.items.push_back(item);
}

void addObjects(Scene& scene) {
    const std::array<glm::vec3, 3> colors{{{0.8F, 0.2F, 0.15F}, {0.2F, 0.6F, 0.3F}, {0.25F, 0.35F, 0.8F}}};
    for (int i = 0; i < 9; ++i) {
        const glm::vec3 place(0.065F * static_cast<float>(i % 3 - 1), 0.06F + 0.012F * static_cast<float>(i % 4),
                              0.045F * static_cast<float>(i / 3 - 1));
        const auto form = i % 2 == 0 ? ShapeItem::Form::box : ShapeItem::Form::sphere;
        scene.items.push_back(
            shape(scene, form, place, glm::vec3(0.022F), colors[static_cast<std::size_t>(i) % colors.size()]));
    }
}

/// The table has one colour: where nothing upon it depends on the viewer, the projector shows it by its own material,
/// more sharply than any eye picture has it from the side, and would be told off for that on lines and bricks. Its
/// light and its shadows are judged.
void setSkin(Scene& scene, const char* image) {
    scene.device.material = Material();
    scene.device.material.color = glm::vec3(1.0F);
    scene.device.material.colorTexture.image = image;
    scene.device.material.colorTexture.tile = glm::vec2(0.1F);
    scene.table.material = Material();
    scene.table.material.color = {0.75F, 0.66F, 0.55F};
}

ShowFrame frameOf(const TruthDevice& device, const TruthState& state, const glm::vec3& eye, const SceneInRoom& scene,
                  const SceneAssets& assets) {
    ShowFrame frame;
    frame.assets = std::make_shared<SceneAssets>(assets);
    PoseInput input;
    input.worldFromDevice = scene.worldFromDevice;
    frame.posed = ScenePoser().pose(scene, *frame.assets, input);
    frame.rig = device.rig;
    frame.devicePositions = std::make_shared<std::vector<glm::vec3>>(deformed(*device.rig, state.strokes).positions);
    frame.worldFromDevice = scene.worldFromDevice;
    frame.eye = eye;
    setSceneInRoom(frame, scene);
    return frame;
}

} // namespace

const char* nameOf(TruthContent content) {
    constexpr std::array kNames{"water", "bricks", "lines", "objects"};
    return kNames[static_cast<std::size_t>(content)];
}

ShowFrame truthFrame(const TruthDevice& device, const TruthState& state, const glm::vec3& eye, TruthContent content) {
    static const SceneAssets assets = [] {
        SceneAssets made;
        made.images = {{"bricks", pictureOf(brickAt)}, {"lines", pictureOf(lineAt)}};
        return made;
    }();
    SceneInRoom scene = device.scene;
    setSkin(scene, content == TruthContent::lines ? "lines" : "bricks");
    if (content == TruthContent::water) addWater(scene);
    if (content == TruthContent::objects) addObjects(scene);
    addMarker(scene);
    return frameOf(device, state, eye, scene, assets);
}

ShowFrame ballsFrame(const TruthDevice& device, const TruthState& state, const glm::vec3& eye,
                     const std::vector<glm::dvec3>& points) {
    SceneInRoom scene = device.scene;
    scene.toneMapping = false;
    scene.sky = glm::vec3(0.0F);
    for (Material* material : {&scene.device.material, &scene.table.material}) {
        *material = Material();
        material->color = glm::vec3(0.0F);
        material->unlit = true;
    }
    for (const glm::dvec3& point : points) {
        SceneItem ball = shape(scene, ShapeItem::Form::sphere, glm::vec3(point), glm::vec3(0.004F), glm::vec3(1.0F));
        ball.material.unlit = true;
        scene.items.push_back(ball);
    }
    return frameOf(device, state, eye, scene, {});
}

TruthFigures judge(TruthBench& bench, const Image& eyePicture, const Image& projected) {
    const LabPicture eye = lightOf(eyePicture);
    const LabPicture wanted = bench.lowPassed(eye);
    const LabPicture rendered = bench.seen(projected);
    const LabPicture ideal = bench.seen(bench.ideal(eye));
    const auto figureOf = [&](const std::vector<std::uint8_t>& marked) {
        return TruthFigure{psnr(rendered, wanted, marked), psnr(ideal, wanted, marked)};
    };
    return {figureOf(bench.judged()), figureOf(bench.judgedDevice())};
}

namespace {

/// One a triangle: whether it belongs to a flap that is lifted by at least 5 mm there.
std::vector<bool> liftedTriangles(const TruthDevice& device, const TruthState& state) {
    constexpr float kLifted = 0.005F;
    const TriangleMesh& rest = device.rig->restMesh();
    const std::vector<glm::vec3> now = deformed(*device.rig, state.strokes).positions;
    std::vector<bool> lifted(rest.triangles.size(), false);
    for (std::size_t actuator = 0; actuator < device.rig->actuatorCount(); ++actuator) {
        std::vector<bool> moved(now.size(), false);
        for (const std::uint32_t vertex : device.rig->verticesOf(actuator))
            moved[vertex] = glm::length(now[vertex] - rest.positions[vertex]) > kLifted;
        for (std::size_t i = 0; i < rest.triangles.size(); ++i) {
            const glm::uvec3& corners = rest.triangles[i];
            if (moved[corners.x] && moved[corners.y] && moved[corners.z]) lifted[i] = true;
        }
    }
    return lifted;
}

} // namespace

TruthCoverage coverageOf(const TruthBench& bench, const TruthDevice& device, const TruthState& state,
                         const Image& mask) {
    const std::vector<bool> lifted = liftedTriangles(device, state);
    const LabSight& sight = bench.sight();
    const auto rays = static_cast<std::size_t>(sight.samples * sight.samples);
    double devicePixels = 0.0;
    double deviceMasked = 0.0;
    double flapPixels = 0.0;
    double flapMasked = 0.0;
    double different = 0.0;
    double deviceJudged = 0.0;
    double flapJudged = 0.0;
    for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
        const std::size_t ray = i * rays;
        if (sight.surfaces[ray] != TruthBench::kDevice) continue;
        const bool white = mask.pixels()[i][1] > 127;
        devicePixels += 1.0;
        deviceMasked += white ? 1.0 : 0.0;
        different += white == (sight.gleams[ray].share > 0.0F) ? 0.0 : 1.0;
        deviceJudged += bench.judged()[i];
        if (!lifted[sight.triangles[ray]]) continue;
        flapPixels += 1.0;
        flapMasked += white ? 1.0 : 0.0;
        flapJudged += bench.judged()[i];
    }
    const auto ofFlaps = [&](double count) { return flapPixels > 0.0 ? count / flapPixels : 1.0; };
    devicePixels = std::max(devicePixels, 1.0);
    return {deviceMasked / devicePixels, ofFlaps(flapMasked), different / devicePixels, deviceJudged / devicePixels,
            ofFlaps(flapJudged)};
}

} // namespace lumorph::test
