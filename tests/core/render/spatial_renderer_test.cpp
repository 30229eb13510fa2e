#include "core/render/spatial_renderer.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include <epoxy/gl.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "core/base/error.h"
#include "core/render/headless_context.h"
#include "tests/support/show_frames.h"

namespace lumorph {
namespace {

SceneProjector overhead() { return projectorAt({-0.15, 1.5, -0.2}, {0.0, 0.0, 0.0}, {480, 320}, 1500.0); }

/// The nearest triangle along a ray; the test's own oracle.
std::optional<double> hitDistance(const TriangleMesh& mesh, const glm::dvec3& from, const glm::dvec3& way) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 u = glm::dvec3(mesh.positions[t.y]) - a;
        const glm::dvec3 v = glm::dvec3(mesh.positions[t.z]) - a;
        const glm::dvec3 p = glm::cross(way, v);
        const double det = glm::dot(u, p);
        if (std::abs(det) < 1e-15) continue;
        const glm::dvec3 s = (from - a) / det;
        const double x = glm::dot(s, p);
        const glm::dvec3 q = glm::cross(s, u);
        const double y = glm::dot(way, q);
        const double distance = glm::dot(v, q);
        if (x >= 0.0 && y >= 0.0 && x + y <= 1.0 && distance > 1e-6) nearest = std::min(nearest, distance);
    }
    return std::isfinite(nearest) ? std::optional(nearest) : std::nullopt;
}

/// What a projector's pixel falls on.
struct Place {
    enum class On { nothing, table, device } on = On::nothing;
    glm::dvec3 point{0.0};
};

Place placeOf(const TriangleMesh& device, const Table& table, const CalibratedCamera& camera, const glm::dvec2& pixel) {
    const glm::dvec3 from = positionOf(camera);
    const glm::dvec3 way = directionOf(camera, pixel);
    if (const auto distance = hitDistance(device, from, way)) return {Place::On::device, from + *distance * way};
    const glm::dvec3 point = from - from.y / way.y * way;
    const bool inside = std::abs(point.x) < 0.5 * table.size.x && std::abs(point.z) < 0.5 * table.size.y;
    return {inside ? Place::On::table : Place::On::nothing, point};
}

/// Calls `judge` with the pixels of a grid that lie two pixels or more from any edge between places.
int judgePixels(const ShowFrame& frame, const CalibratedCamera& camera,
                const std::function<void(glm::ivec2, const Place&)>& judge) {
    const TriangleMesh device = physicalDevice(frame);
    int judged = 0;
    for (int y = 4; y < camera.size.y - 4; y += 7)
        for (int x = 4; x < camera.size.x - 4; x += 7) {
            const Place place = placeOf(device, frame.scene->table, camera, {x, y});
            bool clear = true;
            for (const glm::dvec2& aside : {glm::dvec2(2, 2), {-2, 2}, {2, -2}, {-2, -2}})
                clear = clear && placeOf(device, frame.scene->table, camera, glm::dvec2(x, y) + aside).on == place.on;
            if (!clear) continue;
            judge({x, y}, place);
            ++judged;
        }
    return judged;
}

SceneItem box(const glm::vec3& position, Anchor anchor, const glm::vec3& color, float size = 0.04F) {
    SceneItem item;
    item.id = 1;
    item.name = "Box";
    item.position = position;
    item.anchor = anchor;
    item.kind = ShapeItem{.form = ShapeItem::Form::box, .size = glm::vec3(size)};
    item.material = unlit(color);
    return item;
}

ShowFrame posedBy(ScenePoser& poser, ShowFrame frame, double seconds) {
    PoseInput input;
    input.seconds = seconds;
    input.worldFromDevice = frame.worldFromDevice;
    frame.posed = poser.pose(*frame.scene, *frame.assets, input);
    return frame;
}

ShowFrame posed(ShowFrame frame) {
    ScenePoser poser;
    return posedBy(poser, std::move(frame), 0.0);
}

/// Whether the way between two points leads through a box around `centre`, grown by `more`.
bool through(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& centre, double half) {
    double enter = 0.0;
    double leave = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double way = to[axis] - from[axis];
        const double first = (centre[axis] - half - from[axis]) / way;
        const double second = (centre[axis] + half - from[axis]) / way;
        enter = std::max(enter, std::min(first, second));
        leave = std::min(leave, std::max(first, second));
    }
    return enter < leave;
}

TEST(SpatialRenderer, DeviceAndTableKeepTheirOwnLight) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    const ShowFrame frame = frameOf(unlitScene({0.9F, 0.0F, 0.0F}, {0.0F, 0.0F, 0.9F}, {overhead()}), liftedFlaps());
    renderer.draw(frame);
    const Image sent = renderer.readProjector(0);
    int red = 0;
    int blue = 0;
    int faults = 0;
    const int judged = judgePixels(frame, overhead().camera, [&](glm::ivec2 at, const Place& place) {
        const Image::Pixel& pixel = sent.at(at.x, at.y);
        if (place.on == Place::On::device) {
            ++red;
            faults += pixel[2] == 0 ? 0 : 1;
        } else if (place.on == Place::On::table) {
            ++blue;
            faults += pixel[0] == 0 && pixel[2] > 60 ? 0 : 1;
        }
    });
    EXPECT_GT(judged, 1500);
    EXPECT_GT(red, 250);
    EXPECT_GT(blue, 1000);
    EXPECT_EQ(faults, 0);
}

TEST(SpatialRenderer, NothingIsSentBesideTheTable) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    Scene scene = unlitScene(glm::vec3(1.0F), glm::vec3(1.0F), {overhead()});
    scene.table.size = {0.3F, 0.25F};
    const ShowFrame frame = frameOf(scene, liftedFlaps());
    renderer.draw(frame);
    const Image sent = renderer.readProjector(0);
    int outside = 0;
    judgePixels(frame, overhead().camera, [&](glm::ivec2 at, const Place& place) {
        const Image::Pixel black{0, 0, 0, sent.at(at.x, at.y)[3]};
        outside += place.on == Place::On::nothing ? 1 : 0;
        EXPECT_EQ(sent.at(at.x, at.y) == black, place.on == Place::On::nothing) << at.x << ", " << at.y;
    });
    EXPECT_GT(outside, 500);
}

TEST(SpatialRenderer, FloatingBoxIsDrawnWhereTheEyeSeesItAndNowhereElse) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    Scene scene = unlitScene(glm::vec3(0.5F, 0.0F, 0.0F), glm::vec3(0.5F, 0.0F, 0.0F), {overhead()});
    const glm::dvec3 centre(0.02, 0.08, -0.02);
    scene.items.push_back(box(glm::vec3(centre), Anchor::world, {0.0F, 1.0F, 0.0F}));
    const ShowFrame frame = posed(frameOf(scene, liftedFlaps()));
    const TriangleMesh device = physicalDevice(frame);
    const glm::dvec3 eye(*frame.eye);
    renderer.draw(frame);
    const Image sent = renderer.readProjector(0);
    int shown = 0;
    int hidden = 0;
    int faults = 0;
    judgePixels(frame, overhead().camera, [&](glm::ivec2 at, const Place& place) {
        if (place.on == Place::On::nothing) return;
        const bool inBox = through(eye, place.point, centre, 0.018);
        const bool nearBox = through(eye, place.point, centre, 0.022);
        const glm::dvec3 way = glm::normalize(place.point - eye);
        const auto first = hitDistance(device, eye, way);
        const double distance = glm::distance(eye, place.point);
        const bool seen = !first || *first > distance - 0.0005;
        const bool surelyHidden = first && *first < distance - 0.004;
        const bool green = sent.at(at.x, at.y)[1] > 100;
        if (inBox && seen) ++shown;
        if (inBox && surelyHidden) ++hidden;
        if (inBox && seen) faults += green ? 0 : 1;
        if (!nearBox || surelyHidden) faults += green ? 1 : 0;
    });
    EXPECT_GT(shown, 25);
    EXPECT_GT(hidden, 0);
    EXPECT_LE(faults, 1) << "one pixel may lie on an edge as the eye sees it";
}

// A pixel that reaches over an edge shows both sides what is meant for the side that is seen.
TEST(SpatialRenderer, FoldsShowNoRimOfWhatLiesHiddenBehindThem) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    Scene scene = unlitScene({0.9F, 0.0F, 0.0F}, glm::vec3(0.0F), {overhead()});
    scene.items.push_back(box({0.0F, 0.2F, 0.0F}, Anchor::world, {0.0F, 1.0F, 0.0F}, 0.3F)); // all the eye sees
    const ShowFrame frame = posed(frameOf(scene, liftedFlaps()));
    const TriangleMesh device = physicalDevice(frame);
    const CalibratedCamera camera = overhead().camera;
    const glm::dvec3 eye(*frame.eye);
    const auto lit = [&](const glm::dvec2& pixel) { // seen by both eye and projector, not by a hair
        const Place place = placeOf(device, frame.scene->table, camera, pixel);
        if (place.on != Place::On::device) return false;
        const double distance = glm::distance(eye, place.point);
        const auto first = hitDistance(device, eye, (place.point - eye) / distance);
        return first && *first > distance - 0.0002;
    };
    renderer.draw(frame);
    const Image sent = renderer.readProjector(0);
    int edges = 0;
    int rims = 0;
    int hidden = 0;
    for (int y = 2; y < camera.size.y - 2; y += 5)
        for (int x = 2; x < camera.size.x - 2; ++x) {
            const Place place = placeOf(device, frame.scene->table, camera, {x, y});
            if (place.on != Place::On::device || lit({x, y})) continue;
            const bool red = sent.at(x, y)[0] > sent.at(x, y)[1];
            hidden += red ? 1 : 0;
            const glm::dvec2 at(x, y);
            if (!lit(at + glm::dvec2(0.45, 0.0)) && !lit(at - glm::dvec2(0.45, 0.0))) continue;
            ++edges;
            rims += red ? 1 : 0;
        }
    std::printf("%d pixels over an edge, %d of them with a rim; %d hidden\n", edges, rims, hidden);
    EXPECT_GT(edges, 20);
    EXPECT_GT(hidden, 100) << "elsewhere hidden places keep their own look";
    EXPECT_LE(rims, edges / 20);
}

TEST(SpatialRenderer, ThingsFarFromTheDeviceAreDrawnOnTheTable) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    SceneProjector wide = overhead();
    wide.camera.focal *= 0.45;
    Scene scene = unlitScene(glm::vec3(0.5F, 0.0F, 0.0F), glm::vec3(0.5F, 0.0F, 0.0F), {wide});
    const glm::dvec3 centre(0.32, 0.02, -0.22);
    scene.items.push_back(box(glm::vec3(centre), Anchor::world, {0.0F, 1.0F, 0.0F}));
    const ShowFrame frame = posed(frameOf(scene, liftedFlaps()));
    renderer.draw(frame);
    const Image sent = renderer.readProjector(0);
    int shown = 0;
    for (int y = 0; y < wide.camera.size.y; ++y)
        for (int x = 0; x < wide.camera.size.x; ++x) {
            const Place place = placeOf({}, scene.table, wide.camera, {x, y});
            if (place.on != Place::On::table) continue;
            const bool green = sent.at(x, y)[1] > 100;
            if (through(glm::dvec3(*frame.eye), place.point, centre, 0.017)) {
                EXPECT_TRUE(green) << x << ", " << y;
                ++shown;
            } else if (!through(glm::dvec3(*frame.eye), place.point, centre, 0.023)) {
                EXPECT_FALSE(green) << x << ", " << y;
            }
        }
    EXPECT_GT(shown, 200);
}

TEST(SpatialRenderer, WithoutViewerNoEyeMatters) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    Scene scene = unlitScene({0.9F, 0.2F, 0.0F}, {0.0F, 0.3F, 0.9F}, {overhead()});
    scene.items.push_back(box({0.0F, 0.08F, 0.0F}, Anchor::world, {0.0F, 1.0F, 0.0F}));
    const auto sentFor = [&](const glm::vec3& simulated) {
        Scene moved = scene;
        moved.eye = simulated;
        ShowFrame frame = posed(frameOf(moved, liftedFlaps()));
        frame.eye.reset();
        renderer.draw(frame);
        return renderer.readProjector(0);
    };
    const Image first = sentFor({0.0F, 0.45F, 0.55F});
    EXPECT_EQ(first, sentFor({-0.6F, 0.3F, 0.1F}));
    EXPECT_EQ(first, sentFor({0.0F, 0.03F, 0.0F})) << "an eye inside the device";
    renderer.draw(posed(frameOf(scene, liftedFlaps())));
    EXPECT_NE(first, renderer.readProjector(0)) << "a viewer sees the box";
}

TEST(SpatialRenderer, EyeAmongTheDeviceGetsAWarningAndTheShowGoesOn) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    ShowFrame frame = frameOf(unlitScene({0.9F, 0.2F, 0.0F}, {0.0F, 0.3F, 0.9F}, {overhead()}), liftedFlaps());
    frame.eye = glm::vec3(0.0F, 0.02F, 0.0F);
    renderer.draw(frame);
    EXPECT_THAT(renderer.warnings(), testing::Contains(testing::HasSubstr("move the eye away")));
    const Image sent = renderer.readProjector(0);
    frame.eye.reset();
    renderer.draw(frame);
    EXPECT_EQ(sent, renderer.readProjector(0));
    EXPECT_TRUE(renderer.warnings().empty());
}

TEST(SpatialRenderer, ProjectorsComeGoAndChangeTheirSize) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    EXPECT_THROW((void)renderer.readEye(), InvalidInput);
    EXPECT_THROW((void)renderer.readMask(), InvalidInput);
    EXPECT_EQ(renderer.eyeTexture(), 0U);
    Scene scene = unlitScene(glm::vec3(0.8F), glm::vec3(0.8F), {overhead(), overhead()});
    scene.projectors[1].camera.size = {1, 1};
    scene.projectors[1].camera.principal = {0.0, 0.0};
    renderer.setEyeSize({64, 48});
    renderer.draw(frameOf(scene, liftedFlaps()));
    EXPECT_EQ(renderer.readEye().size(), glm::ivec2(64, 48));
    EXPECT_EQ(renderer.readProjector(0).size(), glm::ivec2(480, 320));
    EXPECT_EQ(renderer.readProjector(1).size(), glm::ivec2(1, 1));
    const std::size_t two = renderer.objectCount();

    scene.projectors[0].camera.size = {200, 100};
    scene.projectors[1].enabled = false;
    renderer.draw(frameOf(scene, liftedFlaps()));
    EXPECT_EQ(renderer.readProjector(0).size(), glm::ivec2(200, 100));
    EXPECT_EQ(renderer.projectorTexture(1), 0U);
    EXPECT_LT(renderer.objectCount(), two);

    scene.projectors.clear();
    renderer.draw(frameOf(scene, liftedFlaps()));
    EXPECT_THROW((void)renderer.readProjector(0), InvalidInput);
    EXPECT_NE(renderer.eyeTexture(), 0U);

    scene.projectors = {overhead()};
    scene.projectors[0].camera.size = {100'000, 10};
    EXPECT_THROW(renderer.draw(frameOf(scene, liftedFlaps())), InvalidInput);
    scene.projectors[0].camera.size = {100, 10};
    scene.projectors[0].camera.focal.x = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(renderer.draw(frameOf(scene, liftedFlaps())), InvalidInput);
    EXPECT_THROW(renderer.draw({}), InvalidInput);
    EXPECT_THROW(renderer.setEyeSize({0, 10}), InvalidInput);
    ShowFrame odd = frameOf(scene, liftedFlaps());
    odd.devicePositions = std::make_shared<const std::vector<glm::vec3>>(3);
    EXPECT_THROW(renderer.draw(odd), InvalidInput);
}

// A lit scene of which each step changes something else than the one before.
ShowFrame changingFrame(int step) {
    Scene scene = defaultScene();
    scene.projectors = {overhead()};
    scene.projectors[0].camera.size = {240, 160};
    scene.projectors[0].camera.focal *= 0.4;
    scene.projectors[0].camera.principal = {119.5, 79.5};
    scene.items.push_back(box({0.05F, 0.09F, 0.02F}, Anchor::device, {0.0F, 1.0F, 0.0F}));
    scene.items.back().id = 7;
    std::vector<double> strokes(bundledTablet()->actuatorCount(), 0.0);
    if (step >= 1) strokes[0] = 0.9;
    if (step >= 2) scene.eye = {0.3F, 0.4F, 0.4F};
    if (step >= 3) scene.items.back().position = {-0.14F, 0.05F, 0.1F};
    if (step >= 4) strokes[1] = 0.8;
    if (step >= 5) scene.items.front().position = {0.5F, 0.35F, 0.5F};
    if (step >= 6) scene.table.material.color = {0.3F, 0.5F, 0.8F};
    if (step >= 7) scene.worldFromDevice[3] = glm::vec4(0.06F, 0.0F, -0.03F, 1.0F);
    if (step >= 8) scene.items.pop_back();
    if (step >= 9) strokes.assign(strokes.size(), 1.0); // long shadows on the table
    if (step >= 10) scene.projectors[0].peak = 2.0;
    ShowFrame frame = posed(frameOf(scene, strokes));
    if (step >= 11) frame.eye.reset();
    return frame;
}

int differingPixels(const Image& first, const Image& second) {
    int count = 0;
    for (std::size_t i = 0; i < first.pixels().size(); ++i) count += first.pixels()[i] == second.pixels()[i] ? 0 : 1;
    return count;
}

TEST(SpatialRenderer, PictureIsTheSameWhateverWasDrawnBefore) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    renderer.setEyeSize({320, 200});
    Image before;
    for (int step = 0; step <= 11; ++step) {
        const ShowFrame frame = changingFrame(step);
        renderer.draw(frame);
        const Image sent = renderer.readProjector(0);
        SpatialRenderer fresh;
        fresh.setEyeSize({320, 200});
        fresh.draw(frame);
        // Now and then a shadow's edge falls on the other side of a rounding.
        EXPECT_LE(differingPixels(sent, fresh.readProjector(0)), 3) << "step " << step;
        EXPECT_NE(sent, before) << "step " << step << " changes nothing";
        before = sent;
    }
}

SceneTexture texture(const std::string& image, int columns = 1) {
    SceneTexture texture;
    texture.image = image;
    texture.columns = columns;
    texture.framesPerSecond = columns > 1 ? 20.0 : 0.0;
    return texture;
}

/// A scene of everything: pictures, a flip-book, waves, fog, two projectors.
Scene busyScene() {
    Scene scene = unlitScene({0.9F, 0.2F, 0.0F}, {0.0F, 0.3F, 0.9F}, {overhead(), overhead()});
    scene.device.material.colorTexture = texture("flip-book", 4);
    scene.device.creases.emphasis = 0.5;
    scene.table.material.colorTexture = texture("wood");
    scene.items.push_back(box({0.25F, 0.03F, 0.2F}, Anchor::world, {0.0F, 1.0F, 0.0F}));
    scene.items.back().material.unlit = false;
    scene.items.back().material.normalMaps[0] = texture("bumps");
    SceneItem water = box({0.0F, 0.04F, 0.0F}, Anchor::device, {0.2F, 0.4F, 0.9F});
    water.id = 2;
    HeightItem waves;
    waves.waves.emplace_back();
    water.kind = waves;
    scene.items.push_back(water);
    SceneItem fog = box({0.0F, 0.05F, 0.0F}, Anchor::device, {1.0F, 1.0F, 1.0F});
    fog.id = 3;
    fog.kind = FogItem{};
    scene.items.push_back(fog);
    SceneItem sun = box({0.3F, 0.8F, 0.3F}, Anchor::world, {1.0F, 1.0F, 1.0F});
    sun.id = 4;
    sun.kind = LightItem{};
    std::get<LightItem>(sun.kind).shadows = false; // their maps take most of a frame
    scene.items.push_back(sun);
    for (SceneProjector& projector : scene.projectors) {
        projector.camera.size = {48, 32};
        projector.camera.focal *= 0.1;
        projector.camera.principal = {23.5, 15.5};
    }
    return scene;
}

/// The pictures of that scene; all but the flip-book are read anew.
std::shared_ptr<const SceneAssets> readAnew() {
    static const auto sheet = std::make_shared<const Image>(glm::ivec2(16, 4), Image::Pixel{90, 200, 40, 255});
    auto assets = std::make_shared<SceneAssets>();
    assets->images["flip-book"] = sheet;
    assets->images["wood"] = std::make_shared<const Image>(glm::ivec2(8), Image::Pixel{120, 80, 40, 255});
    assets->images["bumps"] = std::make_shared<const Image>(glm::ivec2(8), Image::Pixel{128, 128, 255, 255});
    return assets;
}

/// What the driver itself has, by kind.
std::array<std::size_t, 6> liveObjects() {
    constexpr GLuint kNames = 500000; // a driver need not use a name twice
    std::array<std::size_t, 6> count{};
    for (GLuint name = 1; name < kNames; ++name) {
        count[0] += glIsTexture(name);
        count[1] += glIsBuffer(name);
        count[2] += glIsVertexArray(name);
        count[3] += glIsFramebuffer(name);
        count[4] += glIsRenderbuffer(name);
        count[5] += glIsProgram(name);
    }
    return count;
}

TEST(SpatialRenderer, ManyFramesKeepAsManyObjects) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    renderer.setEyeSize({64, 40});
    Scene scene = busyScene();
    ScenePoser poser;
    const char* soak = std::getenv("LUMORPH_SOAK");
    const int frames = 500 * (soak != nullptr ? std::max(1, std::atoi(soak)) : 1);
    const CalibratedCamera observer = cameraLookingAt({0.0, 0.5, 0.5}, {0.0, 0.0, 0.0}, {32, 24}, 40.0);
    std::size_t settled = 0;
    std::array<std::size_t, 6> live{};
    auto assets = readAnew();
    for (int i = 0; i < frames; ++i) {
        std::vector<double> strokes(bundledTablet()->actuatorCount());
        for (std::size_t k = 0; k < strokes.size(); ++k) strokes[k] = 0.5 + 0.5 * std::sin(0.1 * i + double(k));
        scene.eye.x = 0.3F * std::sin(0.05F * static_cast<float>(i));
        ShowFrame frame = frameOf(scene, strokes);
        if (i % 5 == 4) assets = readAnew();
        frame.assets = assets;
        frame = posedBy(poser, std::move(frame), 0.05 * i);
        if (i % 10 == 9) frame.eye.reset();
        renderer.draw(frame);
        if (i % 50 == 0) (void)renderer.readLab(observer);
        if (i % 50 == 1 && frame.eye) (void)renderer.readMask();
        if (i == 60) {
            settled = renderer.objectCount();
            live = liveObjects();
        }
        if (i > 60) {
            ASSERT_EQ(renderer.objectCount(), settled) << i;
        }
    }
    EXPECT_EQ(liveObjects(), live);
    EXPECT_EQ(glGetError(), unsigned{GL_NO_ERROR});
}

} // namespace
} // namespace lumorph
