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

void PixelRectangle::include(const PixelRectangle& other) noexcept {
    if (other.empty()) return;
    low = empty() ? other.low : glm::min(low, other.low);
    high = glm::max(high, other.high);
}

PixelRectangle pixelRectangle(const glm::dvec2& low, const glm::dvec2& high, glm::ivec2 size) {
    const glm::dvec2 whole(size);
    const glm::dvec2 least = glm::clamp(low, glm::dvec2(0.0), whole);
    const glm::dvec2 most = glm::clamp(high, glm::dvec2(0.0), whole);
    return {{static_cast<int>(least.x), static_cast<int>(whole.y - most.y)},
            {static_cast<int>(std::ceil(most.x)), static_cast<int>(std::ceil(whole.y - least.y))}};
}

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
    return pixelRectangle(low - kRoom, high + kRoom, projector.size);
}

std::array<PixelRectangle, 4> around(const PixelRectangle& area, const PixelRectangle& whole) {
    const PixelRectangle inner{glm::clamp(area.low, whole.low, whole.high),
                               glm::clamp(area.high, whole.low, whole.high)};
    if (inner.empty()) return {{whole, {}, {}, {}}};
    return {{{whole.low, {whole.high.x, inner.low.y}},
             {{whole.low.x, inner.high.y}, whole.high},
             {{whole.low.x, inner.low.y}, {inner.low.x, inner.high.y}},
             {{inner.high.x, inner.low.y}, {whole.high.x, inner.high.y}}}};
}

} // namespace lumorph
