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
#include "core/render/gl/headless_context.h"
#include "tests/core/render/ray_oracle.h"
#include "tests/core/render/spatial_scene.h"

namespace lumorph {
namespace {

RayOracle raysAt(const TriangleMesh& device) {
    RayOracle rays;
    for (const glm::uvec3& t : device.triangles)
        rays.add(glm::dvec3(device.positions[t.x]), glm::dvec3(device.positions[t.y]),
                 glm::dvec3(device.positions[t.z]), 0);
    rays.build();
    return rays;
}

/// What a projector's pixel falls on.
struct Place {
    enum class On { nothing, table, device } on = On::nothing;
    glm::dvec3 point{0.0};
};

Place placeOf(const RayOracle& device, glm::vec2 tableSize, const CalibratedCamera& camera, const glm::dvec2& pixel) {
    const glm::dvec3 from = positionOf(camera);
    const glm::dvec3 way = directionOf(camera, pixel);
    if (const auto hit = device.cast(from, way)) return {Place::On::device, from + hit->distance * way};
    const glm::dvec3 point = from - from.y / way.y * way;
    const bool inside = std::abs(point.x) < 0.5 * tableSize.x && std::abs(point.z) < 0.5 * tableSize.y;
    return {inside ? Place::On::table : Place::On::nothing, point};
}

/// Calls `judge` with the pixels of a grid that lie two pixels or more from any edge between places.
int judgePixels(const ShowFrame& frame, const CalibratedCamera& camera,
                const std::function<void(glm::ivec2, const Place&)>& judge) {
    const RayOracle device = raysAt(physicalDevice(frame));
    int judged = 0;
    for (int y = 4; y < camera.size.y - 4; y += 7)
        for (int x = 4; x < camera.size.x - 4; x += 7) {
            const Place place = placeOf(device, frame.installation->tableSize, camera, {x, y});
            bool clear = true;
            for (const glm::dvec2& aside : {glm::dvec2(2, 2), {-2, 2}, {2, -2}, {-2, -2}})
                clear = clear &&
                        placeOf(device, frame.installation->tableSize, camera, glm::dvec2(x, y) + aside).on == place.on;
            if (!clear) continue;
            judge({x, y}, place);
            ++judged;
        }
    return judged;
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
    SceneInRoom scene = unlitScene(glm::vec3(1.0F), glm::vec3(1.0F), {overhead()});
    scene.tableSize = {0.3F, 0.25F};
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
    SceneInRoom scene = unlitScene(glm::vec3(0.5F, 0.0F, 0.0F), glm::vec3(0.5F, 0.0F, 0.0F), {overhead()});
    const glm::dvec3 centre(0.02, 0.08, -0.02);
    scene.items.push_back(box(glm::vec3(centre), Anchor::world, {0.0F, 1.0F, 0.0F}));
    const ShowFrame frame = posed(frameOf(scene, liftedFlaps()));
    const RayOracle device = raysAt(physicalDevice(frame));
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
        const auto first = device.cast(eye, way);
        const double distance = glm::distance(eye, place.point);
        const bool seen = !first || first->distance > distance - 0.0005;
        const bool surelyHidden = first && first->distance < distance - 0.004;
        const bool green = sent.at(at.x, at.y)[1] > 100;
        if (inBox && seen) ++shown;
        if (inBox && surelyHidden) ++hidden;
        if (inBox && seen) faults += green ? 0 : 1;
        if (!nearBox || surelyHidden) faults += green ? 1 : 0;
    });
    EXPECT_GT(shown, 25);
    EXPECT_GT(hidden, 0);
    EXPECT_LE(faults, 2) << "a pixel that lies on an edge as the eye sees it may be either";
}

// A pixel that reaches over an edge shows both sides what is meant for the side that is seen.
TEST(SpatialRenderer, FoldsShowNoRimOfWhatLiesHiddenBehindThem) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    SceneInRoom scene = unlitScene({0.9F, 0.0F, 0.0F}, glm::vec3(0.0F), {overhead()});
    scene.items.push_back(box({0.0F, 0.2F, 0.0F}, Anchor::world, {0.0F, 1.0F, 0.0F}, 0.3F)); // all the eye sees
    const ShowFrame frame = posed(frameOf(scene, liftedFlaps()));
    const RayOracle device = raysAt(physicalDevice(frame));
    const CalibratedCamera camera = overhead().camera;
    const glm::dvec3 eye(*frame.eye);
    const auto lit = [&](const glm::dvec2& pixel) { // seen by both eye and projector, not by a hair
        const Place place = placeOf(device, frame.installation->tableSize, camera, pixel);
        if (place.on != Place::On::device) return false;
        const double distance = glm::distance(eye, place.point);
        const auto first = device.cast(eye, (place.point - eye) / distance);
        return first && first->distance > distance - 0.0002;
    };
    renderer.draw(frame);
    const Image sent = renderer.readProjector(0);
    int edges = 0;
    int rims = 0;
    int hidden = 0;
    for (int y = 2; y < camera.size.y - 2; y += 5)
        for (int x = 2; x < camera.size.x - 2; ++x) {
            const Place place = placeOf(device, frame.installation->tableSize, camera, {x, y});
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

/// A red device before an eye that sees nothing but a green wall: green is what was looked up in its picture.
ShowFrame greenForTheEye(const glm::vec3& eye, const std::vector<double>& strokes) {
    SceneInRoom scene = unlitScene({0.9F, 0.0F, 0.0F}, glm::vec3(0.0F), {overhead()});
    scene.items.push_back(box({0.0F, 0.2F, 0.0F}, Anchor::world, {0.0F, 1.0F, 0.0F}, 0.3F));
    scene.eye = eye;
    return posed(frameOf(scene, strokes));
}

// Next to the rim of what the eye sees at a grazing angle, its surface drawn on beyond the rim would lie far behind
// what is there: that must not hide it.
TEST(SpatialRenderer, WhatHardlyTurnsToTheEyeIsSeenUpToItsRim) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    const CalibratedCamera camera = overhead().camera;
    int seen = 0;
    int lost = 0;
    for (const glm::vec3& eye : {glm::vec3(0.0F, 0.45F, 0.55F), {0.45F, 0.5F, 0.1F}, {-0.5F, 0.35F, 0.3F}})
        for (const double lift : {0.3, 0.5, 0.7}) {
            std::vector<double> strokes(bundledTablet()->actuatorCount(), lift);
            const ShowFrame frame = greenForTheEye(eye, strokes);
            const RayOracle device = raysAt(physicalDevice(frame));
            renderer.draw(frame);
            const Image sent = renderer.readProjector(0);
            const auto facesEye = [&](const glm::dvec2& pixel, double& facing) {
                const Place place = placeOf(device, frame.installation->tableSize, camera, pixel);
                if (place.on != Place::On::device) return false;
                const glm::dvec3 way = place.point - glm::dvec3(eye);
                const auto first = device.cast(glm::dvec3(eye), glm::normalize(way));
                if (!first) return false;
                facing = std::abs(glm::dot(first->normal, glm::normalize(way)));
                return first->distance > glm::length(way) - 0.0002;
            };
            for (int y = 2; y < camera.size.y - 2; y += 2)
                for (int x = 2; x < camera.size.x - 2; ++x) {
                    double facing = 0.0;
                    if (!facesEye({x, y}, facing) || facing > 0.35 || facing < 0.08) continue;
                    bool whole = true;
                    double aside = 0.0;
                    for (const glm::dvec2& to : {glm::dvec2(0.7, 0.0), {-0.7, 0.0}, {0.0, 0.7}, {0.0, -0.7}})
                        whole = whole && facesEye(glm::dvec2(x, y) + to, aside) && std::abs(aside - facing) < 0.1;
                    if (!whole) continue;
                    ++seen;
                    lost += sent.at(x, y)[0] > sent.at(x, y)[1] ? 1 : 0;
                }
        }
    std::printf("%d pixels at a grazing angle, %d of them lost\n", seen, lost);
    EXPECT_GT(seen, 500);
    EXPECT_LE(lost, seen / 100);
}

// A hidden place next to a seen one has the light of that one. Were its own slant made up for, it would outshine it.
TEST(SpatialRenderer, HiddenPlacesBesideSeenOnesAreNoBrighterForBeingSteep) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    const CalibratedCamera camera = overhead().camera;
    const glm::dvec3 projector = positionOf(camera);
    const double reference = overhead().referenceDistance;
    int steep = 0;
    int outshining = 0;
    for (const glm::vec3& eye : {glm::vec3(0.0F, 0.45F, 0.55F), {0.45F, 0.3F, 0.1F}, {-0.5F, 0.3F, -0.3F}}) {
        const ShowFrame frame = greenForTheEye(eye, liftedFlaps());
        const RayOracle device = raysAt(physicalDevice(frame));
        renderer.draw(frame);
        const Image sent = renderer.readProjector(0);
        const auto isSeen = [&](const Place& place) {
            const glm::dvec3 way = place.point - glm::dvec3(eye);
            const auto first = device.cast(glm::dvec3(eye), glm::normalize(way));
            return !first || first->distance > glm::length(way) - 0.001;
        };
        // The brightest that is seen around a pixel; green is 1 for the eye, so head on it would have this value.
        const auto brightestSeenAround = [&](int x, int y, const glm::dvec3& light) {
            const double value = glm::dot(light, light) / (overhead().peak * reference * reference);
            double most = 255.0 * (1.055 * std::pow(value, 1.0 / 2.4) - 0.055);
            for (int k = 0; k < 25; ++k) {
                const glm::ivec2 there(x + k % 5 - 2, y + k / 5 - 2);
                if (!isSeen(placeOf(device, frame.installation->tableSize, camera, there))) continue;
                most = std::max<double>(most, sent.at(there.x, there.y)[1]);
            }
            return most;
        };
        for (int y = 2; y < camera.size.y - 2; ++y)
            for (int x = 2; x < camera.size.x - 2; ++x) {
                const Image::Pixel& pixel = sent.at(x, y);
                const Place place = placeOf(device, frame.installation->tableSize, camera, {x, y});
                if (place.on != Place::On::device || pixel[0] > pixel[1] || isSeen(place)) continue;
                const glm::dvec3 light = projector - place.point;
                const auto hit = device.cast(projector, -glm::normalize(light));
                if (!hit || glm::dot(hit->normal, glm::normalize(light)) > 0.5) continue;
                ++steep;
                outshining += pixel[1] > 1.1 * brightestSeenAround(x, y, light) ? 1 : 0;
            }
    }
    std::printf("%d steep hidden pixels beside seen ones, %d outshine them\n", steep, outshining);
    EXPECT_GT(steep, 20);
    EXPECT_LE(outshining, steep / 20);
}

TEST(SpatialRenderer, ThingsFarFromTheDeviceAreDrawnOnTheTable) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    InstalledProjector wide = overhead();
    wide.camera.focal *= 0.45;
    SceneInRoom scene = unlitScene(glm::vec3(0.5F, 0.0F, 0.0F), glm::vec3(0.5F, 0.0F, 0.0F), {wide});
    const glm::dvec3 centre(0.32, 0.02, -0.22);
    scene.items.push_back(box(glm::vec3(centre), Anchor::world, {0.0F, 1.0F, 0.0F}));
    const ShowFrame frame = posed(frameOf(scene, liftedFlaps()));
    renderer.draw(frame);
    const Image sent = renderer.readProjector(0);
    int shown = 0;
    for (int y = 0; y < wide.camera.size.y; ++y)
        for (int x = 0; x < wide.camera.size.x; ++x) {
            const Place place = placeOf({}, scene.tableSize, wide.camera, {x, y});
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
    SceneInRoom scene = unlitScene({0.9F, 0.2F, 0.0F}, {0.0F, 0.3F, 0.9F}, {overhead()});
    scene.items.push_back(box({0.0F, 0.08F, 0.0F}, Anchor::world, {0.0F, 1.0F, 0.0F}));
    const auto sentFor = [&](const glm::vec3& simulated) {
        SceneInRoom moved = scene;
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

} // namespace
} // namespace lumorph
