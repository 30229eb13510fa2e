#include "core/render/projector/picture_changes.h"

#include <algorithm>
#include <utility>

#include "core/render/eye/eye_lighting.h"
#include "core/render/eye/table_shadow.h"

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

// Rooms that differ at most by their simulated eye, which the frame holds anyway.
bool sameRoom(const std::shared_ptr<const Installation>& first, const std::shared_ptr<const Installation>& second) {
    if (first == second) return true;
    Installation moved = *first;
    moved.eye = second->eye;
    return moved == *second;
}

// All that moves in a frame, as it lies in the projector's image.
PixelRegion movingPixels(const ShowFrame& frame, const CalibratedCamera& projector,
                         std::span<const TableArea> lookups) {
    PixelRegion moving(devicePixels(frame, projector));
    const EyeLighting lighting(*frame.scene, frame.posed.lights);
    if (lighting.shadowed()) {
        const auto shadows = shadowsOnTable(frame, *lighting.shadowed());
        if (!shadows) return PixelRegion({glm::ivec2(0), projector.size});
        if (!shadows->empty()) moving.include(pixelsOf(*shadows, projector));
    }
    for (const TableArea& area : lookups) moving.include(lookupPixels(area, projector));
    return moving;
}

} // namespace

PixelRectangle devicePixels(const ShowFrame& frame, const CalibratedCamera& projector) {
    constexpr double kRoom = 4.0;
    glm::dvec2 low(1e9);
    glm::dvec2 high(-1e9);
    const Box box = boundingBox(*frame.devicePositions);
    for (int i = 0; i < 125; ++i) { // not its corners alone: a lens bends the edges between them outwards
        const glm::vec3 share = 0.25F * glm::vec3(i % 5, i / 5 % 5, i / 25);
        const glm::vec3 place(frame.worldFromDevice * glm::vec4(glm::mix(box.min, box.max, share), 1.0F));
        const auto at = pixelOf(projector, glm::dvec3(place));
        if (!at) return {glm::ivec2(0), projector.size}; // part of it cannot be seen
        low = glm::min(low, *at);
        high = glm::max(high, *at);
    }
    return pixelRectangle(low - kRoom, high + kRoom, projector.size);
}

bool PictureChanges::standsStill(const ShowFrame& frame) const {
    return drawn_ && drawn_->assets == frame.assets && drawn_->rig == frame.rig &&
           drawn_->worldFromDevice == frame.worldFromDevice &&
           std::equal(drawn_->lights.begin(), drawn_->lights.end(), frame.posed.lights.begin(),
                      frame.posed.lights.end(), sameLight) &&
           isStill(frame.scene->table.material) && (drawn_->scene == frame.scene || *drawn_->scene == *frame.scene) &&
           sameRoom(drawn_->installation, frame.installation);
}

PixelRegion PictureChanges::begin(const ShowFrame& frame, const CalibratedCamera& projector,
                                  std::span<const TableArea> lookups) {
    const PixelRegion moved = std::exchange(moving_, movingPixels(frame, projector, lookups));
    PixelRegion region({glm::ivec2(0), projector.size});
    if (standsStill(frame)) {
        region = moving_;
        region.include(moved);
    }
    drawn_.reset();
    return region;
}

void PictureChanges::finish(const ShowFrame& frame) {
    drawn_ = Drawn{frame.scene, frame.installation, frame.assets, frame.rig, frame.worldFromDevice, frame.posed.lights};
}

} // namespace lumorph
