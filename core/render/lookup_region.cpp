#include "core/render/lookup_region.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/error.h"

namespace lumorph {
namespace {

// A table less rough than this shows the eye highlights worth a picture of their own.
constexpr float kGlossy = 0.4F;
constexpr float kFadeRoom = 0.025F; // metres, as far as eye_lookup.glsl fades out around an area

// Where things of a box appear on the table, seen from the eye; false: beyond all bounds.
bool includeOnTable(Box& onTable, const Box& box, const glm::mat4& worldFromBox, const glm::vec3& eye) {
    for (unsigned i = 0; i < 8; ++i) {
        const glm::vec3 corner(worldFromBox * glm::vec4((i & 1U) != 0 ? box.max.x : box.min.x,
                                                        (i & 2U) != 0 ? box.max.y : box.min.y,
                                                        (i & 4U) != 0 ? box.max.z : box.min.z, 1.0F));
        const float way = eye.y / (eye.y - corner.y);
        if (!(way > 0.0F) || !(way < 1e3F)) return false;
        onTable.include(eye + way * (corner - eye));
    }
    return true;
}

bool holds(const CalibratedCamera& camera, const glm::vec3& point) {
    const auto pixel = pixelOf(camera, glm::dvec3(point));
    const glm::dvec2 room = 0.03 * glm::dvec2(camera.size);
    return pixel && pixel->x > room.x && pixel->y > room.y && pixel->x < camera.size.x - 1 - room.x &&
           pixel->y < camera.size.y - 1 - room.y;
}

} // namespace

bool dependsOnEye(const Material& table) {
    return table.reflection > 0.0F || table.refraction > 0.0F || table.metallic > 0.3F || table.roughness < kGlossy;
}

std::optional<TableArea> lookupArea(const ShowFrame& frame, const glm::vec3& eye) {
    const glm::vec2 half = 0.5F * frame.scene->table.size;
    const TableArea all{-half - kFadeRoom, half + kFadeRoom};
    if (dependsOnEye(frame.scene->table.material)) return all;
    Box seen;
    bool bounded = true;
    for (const PosedSurface& surface : frame.posed.surfaces)
        if (!surface.positions->empty())
            bounded = bounded && includeOnTable(seen, boundingBox(*surface.positions), surface.worldFromSurface, eye);
    for (const PosedFog& fog : frame.posed.fogs)
        bounded = bounded && includeOnTable(seen, {glm::vec3(-0.5F), glm::vec3(0.5F)}, fog.worldFromBox, eye);
    if (!bounded) return all;
    if (seen.empty()) return std::nullopt;
    const TableArea area{glm::max(glm::vec2(seen.min.x, seen.min.z), all.low),
                         glm::min(glm::vec2(seen.max.x, seen.max.z), all.high)};
    if (area.low.x >= area.high.x || area.low.y >= area.high.y) return std::nullopt;
    return area;
}

std::optional<CalibratedCamera> tableLookup(const ShowFrame& frame, const glm::vec3& eye, const TableArea& area,
                                            const CalibratedCamera& first, glm::ivec2 size) {
    const glm::vec2 half = 0.5F * frame.scene->table.size;
    const glm::vec2 low = glm::max(area.low - kFadeRoom, -half);
    const glm::vec2 high = glm::min(area.high + kFadeRoom, half);
    const std::array<glm::vec3, 4> corners{
        {{low.x, 0.0F, low.y}, {high.x, 0.0F, low.y}, {low.x, 0.0F, high.y}, {high.x, 0.0F, high.y}}};
    if (std::all_of(corners.begin(), corners.end(), [&](const glm::vec3& at) { return holds(first, at); }))
        return std::nullopt;
    try {
        return eyeCamera(glm::dvec3(eye), corners, size);
    } catch (const InvalidInput&) { // the eye stands above part of it
        return tableView(frame, eye, size);
    }
}

PixelRectangle pixelsOf(const TableArea& area, const CalibratedCamera& projector) {
    constexpr int kSteps = 8;
    constexpr double kRoom = 2.0;
    const glm::dvec2 from(area.low - kFadeRoom);
    const glm::dvec2 way(area.high - area.low + 2.0F * kFadeRoom);
    glm::dvec2 low(1e9);
    glm::dvec2 high(-1e9);
    for (int i = 0; i <= kSteps; ++i)
        for (int j = 0; j <= kSteps; ++j) {
            const glm::dvec2 place = from + way * glm::dvec2(i, j) / double{kSteps};
            const auto at = pixelOf(projector, {place.x, 0.0, place.y});
            if (!at) return {glm::ivec2(0), projector.size};
            low = glm::min(low, *at);
            high = glm::max(high, *at);
        }
    const glm::dvec2 size(projector.size);
    low = glm::clamp(low - kRoom, glm::dvec2(0.0), size);
    high = glm::clamp(high + kRoom, glm::dvec2(0.0), size);
    return {{static_cast<int>(low.x), static_cast<int>(size.y - high.y)},
            {static_cast<int>(std::ceil(high.x)), static_cast<int>(std::ceil(size.y - low.y))}};
}

std::array<PixelRectangle, 4> around(const PixelRectangle& area, glm::ivec2 size) {
    if (area.empty()) return {{{glm::ivec2(0), size}, {}, {}, {}}};
    return {{{{0, 0}, {size.x, area.low.y}},
             {{0, area.high.y}, {size.x, size.y}},
             {{0, area.low.y}, {area.low.x, area.high.y}},
             {{area.high.x, area.low.y}, {size.x, area.high.y}}}};
}

} // namespace lumorph
