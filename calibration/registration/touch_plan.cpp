#include "calibration/registration/touch_plan.h"

#include <algorithm>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr int kColumns = 24, kRows = 16; ///< of the grid among which dots are chosen
constexpr double kRim = 0.06;            ///< of the picture that stays free
constexpr double kBesideDevice = 0.025;  ///< metres
constexpr double kFromTablesEdge = 0.02; ///< metres
constexpr double kUpperPart = 0.3;       ///< of the height from which on a point can be reached
constexpr float kLeastUp = -0.1F;        ///< of a normal's y

/// Farthest points first: each is the one farthest from all before.
template <typename Item, typename PlaceOf>
std::vector<Item> spreadOut(const std::vector<Item>& items, std::size_t count, const PlaceOf& placeOf) {
    std::vector<Item> chosen;
    if (items.empty()) return chosen;
    glm::dvec3 mean(0.0);
    for (const Item& item : items) mean += placeOf(item) / double(items.size());
    std::vector<double> away(items.size(), std::numeric_limits<double>::infinity());
    std::size_t next = 0;
    for (std::size_t i = 0; i < items.size(); ++i)
        if (glm::distance(placeOf(items[i]), mean) > glm::distance(placeOf(items[next]), mean)) next = i;
    while (chosen.size() < count && away[next] > 0.0) {
        chosen.push_back(items[next]);
        for (std::size_t i = 0; i < items.size(); ++i)
            away[i] = std::min(away[i], glm::distance(placeOf(items[i]), placeOf(chosen.back())));
        next = static_cast<std::size_t>(std::ranges::max_element(away) - away.begin());
    }
    return chosen;
}

bool besideDevice(const glm::dvec3& place, const glm::dmat4& deviceFromWorld, const Box& box) {
    const glm::dvec3 at(deviceFromWorld * glm::dvec4(place, 1.0));
    return at.x < static_cast<double>(box.min.x) - kBesideDevice ||
           at.x > static_cast<double>(box.max.x) + kBesideDevice ||
           at.z < static_cast<double>(box.min.z) - kBesideDevice ||
           at.z > static_cast<double>(box.max.z) + kBesideDevice;
}

/// Normals of vertices, by the areas of their triangles.
std::vector<glm::vec3> normalsOf(const TriangleMesh& mesh) {
    std::vector<glm::vec3> normals(mesh.positions.size(), glm::vec3(0.0F));
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3 a = mesh.positions[t.x];
        const glm::vec3 normal = glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
        for (int k = 0; k < 3; ++k) normals[t[k]] += normal;
    }
    for (glm::vec3& normal : normals)
        if (glm::length(normal) > 0.0F) normal = glm::normalize(normal);
    return normals;
}

} // namespace

std::vector<PlannedDot> planDots(const Installation& room, std::size_t projector, const Rig& rig, std::size_t count) {
    if (projector >= room.projectors.size())
        throw InvalidInput("dots to touch", "there is no such projector", "name one of the installation");
    const CalibratedCamera& lens = room.projectors[projector].camera;
    const glm::dvec3 from = positionOf(lens);
    const glm::dmat4 deviceFromWorld = glm::inverse(glm::dmat4(room.worldFromDevice));
    const Box box = boundingBox(rig.restMesh().positions);
    const glm::dvec2 half = 0.5 * glm::dvec2(room.tableSize) - kFromTablesEdge;
    std::vector<PlannedDot> dots;
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column) {
            const glm::dvec2 share(column / (kColumns - 1.0), row / (kRows - 1.0));
            const glm::dvec2 pixel = glm::round((kRim + (1.0 - 2.0 * kRim) * share) * glm::dvec2(lens.size - 1));
            const glm::dvec3 direction = directionOf(lens, pixel);
            if (direction.y > -0.05) continue;
            const glm::dvec3 place = from - from.y / direction.y * direction;
            if (std::abs(place.x) < half.x && std::abs(place.z) < half.y && besideDevice(place, deviceFromWorld, box))
                dots.push_back({pixel, place});
        }
    return spreadOut(dots, count, [](const PlannedDot& dot) { return dot.place; });
}

std::vector<PlannedLandmark> planLandmarks(const Rig& rig, std::size_t count) {
    const TriangleMesh& mesh = rig.restMesh();
    const std::vector<glm::vec3> normals = normalsOf(mesh);
    const Box box = boundingBox(mesh.positions);
    const double least = static_cast<double>(box.min.y) + kUpperPart * static_cast<double>(box.max.y - box.min.y);
    std::vector<PlannedLandmark> fixed, all;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        if (static_cast<double>(mesh.positions[v].y) < least || normals[v].y < kLeastUp) continue;
        const PlannedLandmark landmark{glm::dvec3(mesh.positions[v]), glm::dvec3(normals[v])};
        all.push_back(landmark);
        if (rig.actuatorsOf(v).empty()) fixed.push_back(landmark);
    }
    const auto placeOf = [](const PlannedLandmark& landmark) { return landmark.onModel; };
    std::vector<PlannedLandmark> chosen = spreadOut(fixed, count, placeOf);
    return chosen.size() >= count ? chosen : spreadOut(all, count, placeOf);
}

} // namespace lumorph
