#include "app/applications/navigation/solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

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
    const glm::dvec2 centre = ground.view().pointAt(building.whole.value_or(middle));
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
    if (building.over > 0.0) foot = lift(building.base + building.over);
    Ring ring;
    for (const glm::dvec2& point : points) {
        ring.low.emplace_back(point.x, foot, point.y);
        ring.high.emplace_back(point.x, lift(building.eaves), point.y);
    }
    ring.ridge = static_cast<float>(lift(building.ridge));
    ring.top = {static_cast<float>(centre.x), ring.ridge, static_cast<float>(centre.y)};
    return ring;
}

constexpr double kBay = 3.2, kStorey = 3.0; ///< metres

/// Whole bays and storeys for a wall as high as the eaves.
std::optional<Face::Windows> windowsOf(const Building& building, const glm::vec3& foot, const glm::vec3& end,
                                       const glm::vec3& eaves, double perMetre) {
    const glm::vec3 along = end - foot;
    const float length = glm::length(along), height = eaves.y - foot.y;
    if (!building.windows || !(length > 1e-6F) || !(height > 1e-6F)) return std::nullopt;
    const double bays = std::clamp(std::round(static_cast<double>(length) / perMetre / kBay), 1.0, kBays * 1.0);
    const double storeys = std::clamp(std::round((building.eaves - building.base) / kStorey), 1.0, kStoreys - 1.0);
    return Face::Windows{
        foot, static_cast<float>(bays) / (length * length) * along, {0.0F, static_cast<float>(storeys) / height, 0.0F}};
}

/// Puts together the faces of one building.
class Solid {
public:
    Solid(const Building& building, Ring ring, double perMetre)
        : building_(building), ring_(std::move(ring)), perMetre_(perMetre) {}

    [[nodiscard]] std::vector<Face> faces() {
        const bool ridged = ring_.low.size() == 4;
        if (ridged && building_.roof == Building::Roof::gable)
            gable();
        else if (ridged && building_.roof == Building::Roof::hip)
            hip();
        else
            pointedOrFlat();
        return std::move(faces_);
    }

private:
    void roof(std::vector<glm::vec3> corners) {
        faces_.push_back({std::move(corners), building_.top, building_.shade, std::nullopt});
    }
    /// From corner `k` to the next, up to the eaves, and to a peak over them where there is one.
    void wall(std::size_t k, const std::optional<glm::vec3>& peak = std::nullopt) {
        const std::size_t n = (k + 1) % ring_.low.size();
        Face face;
        face.corners = {ring_.low[n], ring_.low[k], ring_.high[k]};
        if (peak) face.corners.push_back(*peak);
        face.corners.push_back(ring_.high[n]);
        face.paint = building_.walls;
        face.shade = building_.shade;
        face.windows = windowsOf(building_, ring_.low[n], ring_.low[k], ring_.high[n], perMetre_);
        faces_.push_back(std::move(face));
    }
    /// Both ends of the ridge, each so much of the way towards the middle.
    [[nodiscard]] std::array<glm::vec3, 2> ridge(float inset) const {
        const auto& high = ring_.high;
        const glm::vec3 a = 0.5F * (high[0] + high[3]), b = 0.5F * (high[1] + high[2]);
        std::array<glm::vec3, 2> ends{glm::mix(a, b, inset), glm::mix(b, a, inset)};
        for (glm::vec3& end : ends) end.y = ring_.ridge;
        return ends;
    }
    void gable() {
        const auto& high = ring_.high;
        const auto [from, to] = ridge(0.0F);
        roof({high[1], high[0], from, to});
        roof({high[3], high[2], to, from});
        wall(1, to);
        wall(3, from);
        wall(0);
        wall(2);
    }
    void hip() {
        const auto& high = ring_.high;
        const float length = glm::distance(high[0], high[1]), depth = glm::distance(high[1], high[2]);
        const auto [from, to] = ridge(std::min(0.49F, 0.45F * depth / std::max(length, 1e-9F)));
        roof({high[1], high[0], from, to});
        roof({high[3], high[2], to, from});
        roof({high[2], high[1], to});
        roof({high[0], high[3], from});
        for (std::size_t k = 0; k < 4; ++k) wall(k);
    }
    void pointedOrFlat() {
        const auto& high = ring_.high;
        if (building_.roof == Building::Roof::flat)
            roof({high.rbegin(), high.rend()});
        else
            for (std::size_t k = 0; k < high.size(); ++k) roof({high[(k + 1) % high.size()], high[k], ring_.top});
        for (std::size_t k = 0; k < high.size(); ++k) wall(k);
    }

    const Building& building_;
    Ring ring_;
    double perMetre_; ///< device metres a metre of the building
    std::vector<Face> faces_;
};

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
    const int shade = solid.empty() ? 0 : solid.back().shade;
    std::erase_if(solid, [](const Face& face) { return face.corners.size() < 3; });
    if (rim.size() < 3 || solid.empty()) return;
    glm::vec3 middle(0.0F);
    for (const glm::vec3& p : rim) middle += p / static_cast<float>(rim.size());
    const int side = axis == 0 ? 2 : 0;
    const float round = axis == 0 ? -sign : sign; // counterclockwise, seen from beyond the cut
    std::ranges::sort(rim, {},
                      [&](const glm::vec3& p) { return round * std::atan2(p.y - middle.y, p[side] - middle[side]); });
    solid.push_back({std::move(rim), inside, shade, std::nullopt});
}

} // namespace

std::vector<Face> solidOf(const Building& building, const ViewGround& ground, double size) {
    return Solid(building, ringOf(building, ground, size), size / ground.view().scale()).faces();
}

std::vector<Face> cutAtRim(std::vector<Face> solid) {
    const glm::vec2 half(kHalf);
    const auto stands = [&](const glm::vec3& p) { return std::abs(p.x) <= half.x && std::abs(p.z) <= half.y; };
    if (std::ranges::all_of(solid, [&](const Face& face) { return std::ranges::all_of(face.corners, stands); }))
        return solid;
    for (const float sign : {-1.0F, 1.0F}) {
        cut(solid, 0, sign, half.x);
        cut(solid, 2, sign, half.y);
    }
    return solid;
}

} // namespace lumorph::navigation
