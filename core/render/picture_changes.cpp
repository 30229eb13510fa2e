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

// A rectangle of the image that holds a box; all of it where a corner cannot be seen.
PixelRectangle pixelsOf(std::span<const glm::vec3> corners, const CalibratedCamera& projector) {
    constexpr double kRoom = 4.0;
    glm::dvec2 low(1e9);
    glm::dvec2 high(-1e9);
    for (const glm::vec3& corner : corners) {
        const auto at = pixelOf(projector, glm::dvec3(corner));
        if (!at) return {glm::ivec2(0), projector.size};
        low = glm::min(low, *at);
        high = glm::max(high, *at);
    }
    return pixelRectangle(low - kRoom, high + kRoom, projector.size);
}

// All that moves in a frame, as it lies in the projector's image.
PixelRectangle movingPixels(const ShowFrame& frame, const CalibratedCamera& projector,
                            std::span<const TableArea> lookups) {
    PixelRectangle moving = pixelsOf(cornersOf(boundingBox(*frame.devicePositions), frame.worldFromDevice), projector);
    for (const PosedLight& light : frame.posed.lights) {
        if (!light.shadows) continue;
        const auto shadows = shadowsOnTable(frame, light);
        if (!shadows) return {glm::ivec2(0), projector.size};
        if (!shadows->empty()) moving.include(pixelsOf(*shadows, projector));
    }
    for (const TableArea& area : lookups) moving.include(lookupPixels(area, projector));
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
                                     std::span<const TableArea> lookups) {
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
