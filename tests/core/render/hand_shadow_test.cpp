#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/srgb.h"
#include "core/render/gl/headless_context.h"
#include "core/render/spatial_renderer.h"
#include "core/rig/shape_report.h"
#include "tests/core/render/spatial_scene.h"

// A tracked hand between projectors and device: the shadow that it casts, and who fills it.

namespace lumorph {
namespace {

/// Two projectors, left and right, over a grey tablet; all else is black.
SceneInRoom twoSides() {
    return unlitScene(glm::vec3(0.6F), glm::vec3(0.0F),
                      {projectorAt({-0.6, 1.5, 0.0}, {0.0, 0.0, 0.0}, {480, 320}, 1700.0),
                       projectorAt({0.6, 1.5, 0.0}, {0.0, 0.0, 0.0}, {480, 320}, 1700.0)});
}

CalibratedCamera fromAbove() { return cameraLookingAt({0.0, 0.9, 0.02}, {0.0, 0.0, 0.0}, {360, 270}, 800.0); }

/// A finger that points at the tablet, and the arm behind it.
std::vector<Capsule> hand() {
    return {{{0.0F, 0.08F, -0.05F}, {0.005F, 0.12F, 0.02F}, 0.012F},
            {{0.005F, 0.12F, 0.02F}, {0.02F, 0.22F, 0.33F}, 0.045F}};
}

std::vector<float> lightOf(const Image& picture) {
    std::vector<float> light;
    for (const Image::Pixel& pixel : picture.pixels())
        light.push_back(linearFromSrgb(glm::vec3(pixel[0], pixel[1], pixel[2]) / 255.0F).g);
    return light;
}

/// What an observer sees of the lit tablet, without a hand and with it.
struct Seen {
    std::vector<float> free, held;

    /// Of what is lit without the hand, the share that has less than half of its light with it.
    [[nodiscard]] double shadowed() const {
        double lit = 0.0, lost = 0.0;
        for (std::size_t k = 0; k < free.size(); ++k) {
            if (free[k] < 0.1F) continue;
            lit += 1.0;
            lost += held[k] < 0.5F * free[k] ? 1.0 : 0.0;
        }
        return lost / lit;
    }
};

Seen seenWith(SpatialRenderer& renderer, const SceneInRoom& scene) {
    ShowFrame frame = frameOf(scene, liftedFlaps());
    renderer.draw(frame);
    Seen seen;
    seen.free = lightOf(renderer.readLab(fromAbove()));
    frame.hands = hand();
    renderer.draw(frame);
    seen.held = lightOf(renderer.readLab(fromAbove()));
    return seen;
}

/// Of a point from the straight line between two others, by looking at many of its points.
float distanceTo(const glm::vec3& point, const glm::vec3& from, const glm::vec3& to) {
    const glm::vec3 way = to - from;
    const float along = std::clamp(glm::dot(point - from, way) / glm::dot(way, way), 0.0F, 1.0F);
    return glm::distance(point, from + along * way);
}

/// How far light to a place passes the hand, by many places along its way.
float passes(const glm::vec3& lens, const glm::vec3& place) {
    float least = 1e3F;
    for (int k = 0; k <= 3000; ++k) {
        const glm::vec3 at = lens + (static_cast<float>(k) / 3000.0F) * (place - lens);
        for (const Capsule& part : hand()) least = std::min(least, distanceTo(at, part.from, part.to) - part.radius);
    }
    return least;
}

TEST(HandShadow, LiesWhereTheHandStandsInTheWayOfLight) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    SceneInRoom scene = twoSides();
    scene.projectors.pop_back();
    const Seen seen = seenWith(renderer, scene);
    const ShowFrame frame = frameOf(scene, liftedFlaps());
    const TriangleMesh device = physicalDevice(frame);
    const glm::vec3 lens(positionOf(scene.projectors[0].camera));
    const CalibratedCamera camera = fromAbove();
    int dark = 0, lit = 0;
    for (std::size_t t = 0; t < device.triangles.size(); t += 7) {
        const glm::uvec3& corners = device.triangles[t];
        const glm::vec3 place =
            (device.positions[corners.x] + device.positions[corners.y] + device.positions[corners.z]) / 3.0F;
        const glm::vec3 normal = glm::normalize(glm::cross(device.positions[corners.y] - device.positions[corners.x],
                                                           device.positions[corners.z] - device.positions[corners.x]));
        const auto pixel = pixelOf(camera, glm::dvec3(place));
        if (!pixel || !(normal.y > 0.5F)) continue; // its sides and its bottom are not what the pixel shows
        const glm::ivec2 at(glm::round(*pixel));
        if (at.x < 0 || at.y < 0 || at.x >= camera.size.x || at.y >= camera.size.y) continue;
        const auto k =
            static_cast<std::size_t>(at.y) * static_cast<std::size_t>(camera.size.x) + static_cast<std::size_t>(at.x);
        const float clear = passes(lens, place);
        if (seen.free[k] < 0.3F || std::abs(clear) < 0.004F) continue; // its other side, a hidden one, or the rim
        EXPECT_EQ(seen.held[k] < 0.5F * seen.free[k], clear < 0.0F)
            << place.x << ", " << place.z << ": light passes the hand by " << clear << " m";
        ++(clear < 0.0F ? dark : lit);
    }
    EXPECT_GT(dark, 40);
    EXPECT_GT(lit, 100);
}

TEST(HandShadow, IsFilledByTheOtherProjector) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    SceneInRoom scene = twoSides();
    const Seen two = seenWith(renderer, scene);
    double one = 0.0;
    for (const std::size_t off : {0, 1}) {
        SceneInRoom alone = scene;
        alone.projectors[off].enabled = false;
        one = std::max(one, seenWith(renderer, alone).shadowed());
    }
    RecordProperty("one_projector_percent", std::to_string(100.0 * one));
    RecordProperty("two_projectors_percent", std::to_string(100.0 * two.shadowed()));
    EXPECT_GT(one, 0.1);
    EXPECT_LE(two.shadowed(), 0.2 * one) << "of the top, where one alone leaves " << one;
    // What is filled is as bright as before, neither too dark nor lit twice.
    int lit = 0, same = 0;
    for (std::size_t k = 0; k < two.free.size(); ++k) {
        if (two.free[k] < 0.3F) continue;
        ++lit;
        same += std::abs(two.held[k] / two.free[k] - 1.0F) < 0.08F ? 1 : 0;
    }
    EXPECT_GT(same, 0.85 * lit);
}

TEST(HandShadow, HandIsSeenInARoomThatIsLitAndNowhereElse) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    ShowFrame frame = frameOf(twoSides(), liftedFlaps());
    renderer.draw(frame);
    const Image without = renderer.readBare(fromAbove());
    frame.hands = hand();
    renderer.draw(frame);
    const Image with = renderer.readBare(fromAbove());
    const CalibratedCamera camera = fromAbove();
    int changed = 0;
    for (int y = 0; y < camera.size.y; y += 3)
        for (int x = 0; x < camera.size.x; x += 3) {
            const auto k =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.size.x) + static_cast<std::size_t>(x);
            const glm::vec3 way(directionOf(camera, {x, y}));
            const glm::vec3 eye(positionOf(camera));
            const float clear = passes(eye, eye + 1.2F * way);
            const bool differs = with.pixels()[k] != without.pixels()[k];
            changed += differs ? 1 : 0;
            if (clear > 0.012F) {
                EXPECT_FALSE(differs) << x << ", " << y << " beside the hand";
            }
        }
    EXPECT_GT(changed, 300);
}

} // namespace
} // namespace lumorph
