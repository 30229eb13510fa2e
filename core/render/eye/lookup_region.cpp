#include "core/render/eye/lookup_region.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/error.h"
#include "core/render/gl/few_areas.h"

namespace lumorph {
namespace {

// A table less rough than this shows the eye highlights worth a picture of their own.
constexpr float kGlossy = 0.4F;
constexpr float kFadeRoom = 0.010F;   // metres, farther than eye_lookup.glsl fades out around an area
constexpr std::size_t kMostAreas = 6; // each costs a drawing of the table
constexpr int kMostHalvings = 3;
constexpr double kReluctance = 1.25; // to halve a size that is there

// Where a box appears on the table, seen from the eye; none: beyond all bounds.
std::optional<TableArea> areaBehind(std::span<const glm::vec3> corners, const glm::vec3& eye) {
    Box area;
    for (const glm::vec3& corner : corners) {
        const float way = eye.y / (eye.y - corner.y);
        if (!(way > 0.0F) || !(way < 1e3F)) return std::nullopt;
        area.include(eye + way * (corner - eye));
    }
    return TableArea{{area.min.x, area.min.z}, {area.max.x, area.max.z}};
}

TableArea allOf(const ShowFrame& frame) {
    const glm::vec2 half = 0.5F * frame.installation->tableSize;
    return {-half - kFadeRoom, half + kFadeRoom};
}

TableArea withFade(const TableArea& area) { return {area.low - kFadeRoom, area.high + kFadeRoom}; }

TableArea joined(const TableArea& a, const TableArea& b) { return {glm::min(a.low, b.low), glm::max(a.high, b.high)}; }

float drawnSize(const TableArea& area) {
    const TableArea drawn = withFade(area);
    return (drawn.high.x - drawn.low.x) * (drawn.high.y - drawn.low.y);
}

bool holds(const CalibratedCamera& camera, const glm::vec3& point) {
    const auto pixel = pixelOf(camera, glm::dvec3(point));
    const glm::dvec2 room = 0.03 * glm::dvec2(camera.size);
    return pixel && pixel->x > room.x && pixel->y > room.y && pixel->x < camera.size.x - 1 - room.x &&
           pixel->y < camera.size.y - 1 - room.y;
}

// Of the part that is looked up, as far as there is a table.
std::array<glm::vec3, 4> drawnCorners(const TableArea& area, const ShowFrame& frame) {
    const glm::vec2 half = 0.5F * frame.installation->tableSize;
    const TableArea drawn = withFade(area);
    const glm::vec2 low = glm::max(drawn.low, -half);
    const glm::vec2 high = glm::min(drawn.high, half);
    return {{{low.x, 0.0F, low.y}, {high.x, 0.0F, low.y}, {low.x, 0.0F, high.y}, {high.x, 0.0F, high.y}}};
}

} // namespace

bool dependsOnEye(const Material& table) {
    return table.reflection > 0.0F || table.refraction > 0.0F || table.metallic > 0.3F || table.roughness < kGlossy;
}

std::vector<TableArea> lookupAreas(const ShowFrame& frame, const glm::vec3& eye) {
    const TableArea all = allOf(frame);
    if (dependsOnEye(frame.scene->table.material)) return {all};
    std::vector<TableArea> areas;
    const auto addBehind = [&](std::span<const glm::vec3> corners) {
        const auto behind = areaBehind(corners, eye);
        if (!behind) return false;
        const TableArea area{glm::max(behind->low, all.low), glm::min(behind->high, all.high)};
        if (!area.empty()) addToFew(areas, area, kMostAreas, joined, drawnSize);
        return true;
    };
    for (const PosedSurface& surface : frame.posed.surfaces)
        if (const auto corners = seenCorners(surface); corners && !addBehind(*corners)) return {all};
    for (const PosedFog& fog : frame.posed.fogs)
        if (!addBehind(cornersOf({glm::vec3(-0.5F), glm::vec3(0.5F)}, fog.worldFromBox))) return {all};
    return areas;
}

bool holds(const CalibratedCamera& picture, const TableArea& area, const ShowFrame& frame) {
    return std::ranges::all_of(drawnCorners(area, frame), [&](const glm::vec3& at) { return holds(picture, at); });
}

std::optional<CalibratedCamera> tableLookup(const ShowFrame& frame, const glm::vec3& eye,
                                            std::span<const TableArea> areas, const CalibratedCamera& first,
                                            glm::ivec2 most, glm::ivec2 before) {
    std::optional<TableArea> beyond;
    for (const TableArea& area : areas)
        if (!holds(first, area, frame)) beyond = beyond ? joined(*beyond, area) : area;
    if (!beyond) return std::nullopt;
    const auto corners = drawnCorners(*beyond, frame);
    try {
        CalibratedCamera camera = eyeCamera(glm::dvec3(eye), corners, most);
        const auto finerThanNeeded = [&] {
            return camera.focal.x >= (camera.size == before ? kReluctance : 1.0) * first.focal.x;
        };
        for (int i = 0; i < kMostHalvings && finerThanNeeded(); ++i)
            camera = eyeCamera(glm::dvec3(eye), corners, glm::max(camera.size / 2, 1));
        return camera;
    } catch (const InvalidInput&) { // the eye stands above part of it
        return tableView(frame, eye, most);
    }
}

PixelRectangle pixelsOf(const TableArea& area, const CalibratedCamera& camera) {
    constexpr int kSteps = 8;
    constexpr double kRoom = 2.0;
    const glm::dvec2 from(area.low);
    const glm::dvec2 way(area.high - area.low);
    glm::dvec2 low(1e9);
    glm::dvec2 high(-1e9);
    for (int i = 0; i <= kSteps; ++i)
        for (int j = 0; j <= kSteps; ++j) {
            const glm::dvec2 place = from + way * glm::dvec2(i, j) / double{kSteps};
            const auto at = pixelOf(camera, {place.x, 0.0, place.y});
            if (!at) return {glm::ivec2(0), camera.size};
            low = glm::min(low, *at);
            high = glm::max(high, *at);
        }
    return pixelRectangle(low - kRoom, high + kRoom, camera.size);
}

PixelRectangle lookupPixels(const TableArea& area, const CalibratedCamera& projector) {
    return pixelsOf(withFade(area), projector);
}

} // namespace lumorph
