#include "app/applications/ice/water_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

namespace lumorph::ice {
namespace {

using Surface = Model::Primitive;

constexpr double kWayHalf = 0.00080;  ///< half the width of a drop's way, metres
constexpr double kHeadHalf = 0.00140; ///< of its head
constexpr double kDomed = 0.55;       ///< height of water over half its width
constexpr double kOverIce = 0.00008;  ///< metres
constexpr double kWetSide = 0.85;     ///< slope of its sides, as its light shows
constexpr int kPuddleCorners = 20;
constexpr double kRingInside = 0.80; ///< radius

std::uint32_t addWetVertex(Surface& to, const glm::dvec3& place, const glm::dvec3& normal) {
    to.positions.emplace_back(place);
    to.normals.emplace_back(glm::normalize(normal));
    return static_cast<std::uint32_t>(to.positions.size() - 1);
}

/// Left rim, crest and right rim of a way that leads `along`.
void addCut(Surface& to, const OnFloe& at, const glm::dvec3& along, double half) {
    const glm::dvec3 left = glm::cross(at.up, along), place = at.place + kOverIce * at.up;
    addWetVertex(to, place + half * left, at.up + kWetSide * left);
    addWetVertex(to, place + kDomed * half * at.up, at.up);
    addWetVertex(to, place - half * left, at.up - kWetSide * left);
}

void addRivulet(Surface& to, const Rivulet& rivulet, const FloePlaces& places) {
    const double wide = std::sqrt(rivulet.volume);
    std::vector<OnFloe> line;
    std::vector<double> halves;
    for (const Rivulet::Point& point : rivulet.way) {
        line.push_back(places(rivulet.floe, point.home));
        halves.push_back(kWayHalf * wide * std::sqrt(std::max(0.0, 1.0 - point.age / Meltwater::kWayLasts)));
    }
    if (rivulet.runs) { // a bead that is round in front
        const double half = kHeadHalf * wide;
        const glm::dvec2 by = rivulet.velocity / std::max(glm::length(rivulet.velocity), 1e-9);
        for (const auto& [on, share] : {std::pair{-0.7, 0.75}, {0.0, 1.0}, {0.6, 0.8}, {1.0, 0.0}}) {
            line.push_back(places(rivulet.floe, rivulet.home + on * half * by));
            halves.push_back(share * half);
        }
    }
    const auto first = static_cast<std::uint32_t>(to.positions.size());
    glm::dvec3 along(1.0, 0.0, 0.0);
    std::uint32_t cuts = 0;
    for (std::size_t k = 0; k < line.size(); ++k) {
        const glm::dvec3 way = line[std::min(k + 1, line.size() - 1)].place - line[k > 0 ? k - 1 : 0].place;
        const glm::dvec3 level = way - glm::dot(way, line[k].up) * line[k].up;
        if (glm::length(level) > 1e-7) along = glm::normalize(level);
        addCut(to, line[k], along, halves[k]);
        ++cuts;
    }
    for (std::uint32_t k = 0; k + 1 < cuts; ++k)
        for (std::uint32_t side = 0; side < 2; ++side) {
            const std::uint32_t near = first + 3 * k + side, far = near + 3;
            to.triangles.emplace_back(near, near + 1, far);
            to.triangles.emplace_back(near + 1, far + 1, far);
        }
}

void addPuddle(Surface& to, const Puddle& puddle, const FloePlaces& places) {
    const double radius = Meltwater::radiusOf(puddle);
    const OnFloe middle = places(puddle.floe, puddle.home);
    const double raised = kOverIce + 0.06 * radius;
    const std::uint32_t centre = addWetVertex(to, middle.place + raised * middle.up, middle.up);
    const std::uint32_t first = centre + 1;
    for (int k = 0; k < kPuddleCorners; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / kPuddleCorners;
        const double bay = 1.0 + 0.10 * std::sin(3.0 * angle + 900.0 * puddle.home.x) +
                           0.07 * std::sin(5.0 * angle + 700.0 * puddle.home.y);
        const glm::dvec2 out(std::cos(angle), std::sin(angle));
        for (const auto& [share, height, slope] : {std::tuple{0.80, raised, 0.0}, {1.0, kOverIce, kWetSide}}) {
            const OnFloe at = places(puddle.floe, puddle.home + share * bay * radius * out);
            addWetVertex(to, at.place + height * at.up, at.up + slope * glm::dvec3(out.x, 0.0, out.y));
        }
    }
    for (std::uint32_t k = 0; k < kPuddleCorners; ++k) {
        const std::uint32_t here = first + 2 * k, next = first + 2 * ((k + 1) % kPuddleCorners);
        to.triangles.emplace_back(centre, next, here);
        to.triangles.emplace_back(here, next, here + 1);
        to.triangles.emplace_back(next, next + 1, here + 1);
    }
}

SceneModel wetModel(const char* name, Surface surface) {
    SceneModel made;
    made.materials.emplace_back();
    made.model.materials.emplace_back();
    made.model.name = name;
    surface.material = 0;
    Model::Mesh mesh;
    mesh.name = name;
    if (!surface.triangles.empty()) mesh.primitives.push_back(std::move(surface));
    made.model.meshes.push_back(std::move(mesh));
    Model::Node node;
    node.name = name;
    node.mesh = 0;
    made.model.nodes.push_back(std::move(node));
    made.model.roots = {0};
    return made;
}

} // namespace

SceneModel waterModel(const Meltwater& water, const FloePlaces& places) {
    Surface surface;
    for (const Puddle& puddle : water.puddles())
        if (puddle.volume > 0.0) addPuddle(surface, puddle, places);
    for (const Rivulet& rivulet : water.rivulets()) addRivulet(surface, rivulet, places);
    return wetModel("Meltwater", std::move(surface));
}

SceneModel ringModel() {
    Surface ring;
    constexpr std::uint32_t kCorners = 32;
    for (std::uint32_t k = 0; k < kCorners; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / kCorners;
        const glm::dvec3 out(std::cos(angle), 0.0, std::sin(angle));
        addWetVertex(ring, kRingInside * out, {0.0, 1.0, 0.0});
        addWetVertex(ring, out, {0.0, 1.0, 0.0});
        const std::uint32_t here = 2 * k, next = 2 * ((k + 1) % kCorners);
        ring.triangles.emplace_back(here, next, here + 1);
        ring.triangles.emplace_back(next, next + 1, here + 1);
    }
    return wetModel("Ring", std::move(ring));
}

} // namespace lumorph::ice
