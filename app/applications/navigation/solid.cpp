#include "app/applications/navigation/solid.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace lumorph::navigation {
namespace {

constexpr double kSunk = 0.0004; ///< metres by which walls reach into the ground

struct Ring {
    std::vector<glm::vec3> low, high; ///< of the walls
    glm::vec3 top{0.0F};              ///< of a pyramid
    float ridge = 0.0F;               ///< y
};

Ring ringOf(const Building& building, const ViewGround& ground, double size) {
    glm::dvec2 middle(0.0);
    for (const glm::dvec2& corner : building.outline) middle += corner / static_cast<double>(building.outline.size());
    const glm::dvec2 centre = ground.view().pointAt(middle);
    double stands = ground.lift(building.base), foot = stands;
    std::vector<glm::dvec2> points;
    for (const glm::dvec2& corner : building.outline)
        points.push_back(centre + size * (ground.view().pointAt(corner) - centre));
    if (building.grounded) {
        stands = foot = ground.surfaceAt(centre);
        for (const glm::dvec2& point : points) foot = std::min(foot, ground.surfaceAt(point));
        foot -= kSunk;
    }
    const auto lift = [&](double height) { return stands + size * (height - building.base) * ground.perMetre(); };
    Ring ring;
    for (const glm::dvec2& point : points) {
        ring.low.emplace_back(point.x, foot, point.y);
        ring.high.emplace_back(point.x, lift(building.eaves), point.y);
    }
    ring.ridge = static_cast<float>(lift(building.ridge));
    ring.top = {static_cast<float>(centre.x), ring.ridge, static_cast<float>(centre.y)};
    return ring;
}

void addGable(const Ring& ring, const Building& building, std::vector<Face>& faces) {
    const auto &low = ring.low, &high = ring.high;
    glm::vec3 from = 0.5F * (high[0] + high[3]), to = 0.5F * (high[1] + high[2]);
    from.y = to.y = ring.ridge;
    faces.push_back({{high[1], high[0], from, to}, building.top});
    faces.push_back({{high[3], high[2], to, from}, building.top});
    faces.push_back({{low[2], low[1], high[1], to, high[2]}, building.walls});
    faces.push_back({{low[0], low[3], high[3], from, high[0]}, building.walls});
    for (const std::size_t k : {std::size_t{0}, std::size_t{2}})
        faces.push_back({{low[k + 1], low[k], high[k], high[k + 1]}, building.walls});
}

/// Keeps what lies where `axis` times `sign` is at most `limit`, and closes the cut.
void cut(std::vector<Face>& solid, int axis, float sign, float limit) {
    const auto over = [&](const glm::vec3& p) { return sign * p[axis] - limit; };
    std::vector<glm::vec3> rim;
    for (Face& face : solid) {
        std::vector<glm::vec3> kept;
        for (std::size_t k = 0; k < face.corners.size(); ++k) {
            const glm::vec3 &a = face.corners[k], &b = face.corners[(k + 1) % face.corners.size()];
            const float overA = over(a), overB = over(b);
            if (overA <= 0.0F) kept.push_back(a);
            if ((overA <= 0.0F) == (overB <= 0.0F)) continue;
            kept.push_back(glm::mix(a, b, overA / (overA - overB)));
            rim.push_back(kept.back());
        }
        face.corners = std::move(kept);
    }
    const Paint inside = solid.empty() ? Paint::white : solid.back().paint;
    std::erase_if(solid, [](const Face& face) { return face.corners.size() < 3; });
    if (rim.size() < 3 || solid.empty()) return;
    glm::vec3 middle(0.0F);
    for (const glm::vec3& p : rim) middle += p / static_cast<float>(rim.size());
    const int side = axis == 0 ? 2 : 0;
    const float round = axis == 0 ? -sign : sign; // counterclockwise, seen from beyond the cut
    std::ranges::sort(rim, {},
                      [&](const glm::vec3& p) { return round * std::atan2(p.y - middle.y, p[side] - middle[side]); });
    solid.push_back({std::move(rim), inside});
}

} // namespace

std::vector<Face> solidOf(const Building& building, const ViewGround& ground, double size) {
    const Ring ring = ringOf(building, ground, size);
    const std::size_t corners = ring.low.size();
    std::vector<Face> faces;
    if (building.roof == Building::Roof::gable && corners == 4) {
        addGable(ring, building, faces);
        return faces;
    }
    const bool pyramid = building.roof == Building::Roof::pyramid;
    for (std::size_t k = 0; k < corners; ++k) {
        const std::size_t n = (k + 1) % corners;
        if (pyramid) faces.push_back({{ring.high[n], ring.high[k], ring.top}, building.top});
    }
    if (!pyramid) faces.push_back({{ring.high.rbegin(), ring.high.rend()}, building.top});
    for (std::size_t k = 0; k < corners; ++k) {
        const std::size_t n = (k + 1) % corners;
        faces.push_back({{ring.low[n], ring.low[k], ring.high[k], ring.high[n]}, building.walls});
    }
    return faces;
}

std::vector<Face> cutAtRim(std::vector<Face> solid) {
    const glm::vec2 half(kHalf);
    for (const float sign : {-1.0F, 1.0F}) {
        cut(solid, 0, sign, half.x);
        cut(solid, 2, sign, half.y);
    }
    return solid;
}

} // namespace lumorph::navigation
