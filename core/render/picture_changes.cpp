#include "core/render/picture_changes.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/render/device_surface.h"
#include "core/render/eye_surfaces.h"
#include "core/render/table_shadow.h"

namespace lumorph {
namespace {

bool isStill(const SceneTexture& texture) {
    return texture.image.empty() || (texture.velocity == glm::vec2(0.0F) && !(texture.framesPerSecond > 0.0));
}

bool isStill(const Material& material) {
    return isStill(material.colorTexture) && isStill(material.normalMaps[0]) && isStill(material.normalMaps[1]) &&
           isStill(material.holes);
}

bool sameLight(const PosedLight& first, const PosedLight& second) {
    return first.parallel == second.parallel && first.position == second.position &&
           first.radiance == second.radiance && first.softness == second.softness && first.shadows == second.shadows;
}

// Scenes that differ at most by their simulated eye, which the frame holds anyway.
bool sameScene(const std::shared_ptr<const Scene>& first, const std::shared_ptr<const Scene>& second) {
    if (first == second) return true;
    Scene moved = *first;
    moved.eye = second->eye;
    return moved == *second;
}

// A rectangle of the image that holds a box; all of it where part of the box cannot be seen.
PixelRectangle pixelsOf(const Box& box, const CalibratedCamera& projector) {
    constexpr double kRoom = 4.0;
    glm::dvec2 low(1e9);
    glm::dvec2 high(-1e9);
    for (unsigned i = 0; i < 8; ++i) {
        const auto at =
            pixelOf(projector, {(i & 1U) != 0 ? box.max.x : box.min.x, (i & 2U) != 0 ? box.max.y : box.min.y,
                                (i & 4U) != 0 ? box.max.z : box.min.z});
        if (!at) return {glm::ivec2(0), projector.size};
        low = glm::min(low, *at);
        high = glm::max(high, *at);
    }
    return pixelRectangle(low - kRoom, high + kRoom, projector.size);
}

// All that moves in a frame, as it lies in the projector's image.
PixelRectangle movingPixels(const ShowFrame& frame, const CalibratedCamera& projector,
                            const std::optional<TableArea>& lookups) {
    const PixelRectangle all{glm::ivec2(0), projector.size};
    const Box device = deviceBounds(frame);
    std::vector<Box> casters{device};
    for (const PosedSurface& surface : frame.posed.surfaces)
        if (surface.castsShadow && !surface.positions->empty())
            casters.push_back(movedBox(boundingBox(*surface.positions), surface.worldFromSurface));
    Box shadows;
    for (const PosedLight& light : frame.posed.lights)
        for (const Box& caster : casters)
            if (light.shadows && !includeShadow(shadows, caster, light)) return all;
    PixelRectangle moving = pixelsOf(device, projector);
    if (!shadows.empty())
        moving.include(pixelsOf(TableArea{{shadows.min.x, shadows.min.z}, {shadows.max.x, shadows.max.z}}, projector));
    if (lookups) moving.include(pixelsOf(*lookups, projector));
    return moving;
}

} // namespace

bool PictureChanges::standsStill(const ShowFrame& frame) const {
    return drawn_ && drawn_->assets == frame.assets && drawn_->rig == frame.rig &&
           drawn_->worldFromDevice == frame.worldFromDevice &&
           std::equal(drawn_->lights.begin(), drawn_->lights.end(), frame.posed.lights.begin(),
                      frame.posed.lights.end(), sameLight) &&
           isStill(frame.scene->table.material) && sameScene(drawn_->scene, frame.scene);
}

PixelRectangle PictureChanges::begin(const ShowFrame& frame, const CalibratedCamera& projector,
                                     const std::optional<TableArea>& lookups) {
    PixelRectangle area{glm::ivec2(0), projector.size};
    const PixelRectangle moving = movingPixels(frame, projector, lookups);
    if (standsStill(frame)) {
        area = moving;
        area.include(moving_);
    }
    moving_ = moving;
    drawn_.reset();
    return area;
}

void PictureChanges::finish(const ShowFrame& frame) {
    drawn_ = Drawn{frame.scene, frame.assets, frame.rig, frame.worldFromDevice, frame.posed.lights};
}

} // namespace lumorph
