#include "app/studio/rendering/show_frames.h"

#include <algorithm>
#include <cmath>

namespace lumorph::studio {
namespace {

glm::ivec2 scaledSize(glm::ivec2 size, double share) {
    const auto side = [share](int pixels) { return std::max(1, static_cast<int>(std::lround(pixels * share))); };
    return {side(size.x), side(size.y)};
}

} // namespace

glm::ivec2 fittingSize(glm::ivec2 of, glm::ivec2 room) {
    const double share = std::min(static_cast<double>(room.x) / std::max(of.x, 1), //
                                  static_cast<double>(room.y) / std::max(of.y, 1));
    return scaledSize(of, share);
}

CalibratedCamera resized(CalibratedCamera camera, glm::ivec2 size) {
    const glm::dvec2 share = glm::dvec2(size) / glm::dvec2(camera.size);
    camera.size = size;
    camera.focal *= share;
    // Pixel centres lie at whole numbers, so the corner of the image is at -0.5.
    camera.principal = (camera.principal + 0.5) * share - 0.5;
    return camera;
}

ShowFrame withProjectorShare(ShowFrame frame, double share) {
    if (share >= 1.0) return frame;
    auto installation = std::make_shared<Installation>(*frame.installation);
    for (InstalledProjector& projector : installation->projectors)
        projector.camera = resized(projector.camera, scaledSize(projector.camera.size, share));
    frame.installation = std::move(installation);
    return frame;
}

ShowFrame withProjectorRoom(ShowFrame frame, glm::ivec2 room) {
    auto installation = std::make_shared<Installation>(*frame.installation);
    for (InstalledProjector& projector : installation->projectors) {
        const glm::ivec2 fitting = fittingSize(projector.camera.size, room);
        if (fitting.x < projector.camera.size.x) projector.camera = resized(projector.camera, fitting);
    }
    frame.installation = std::move(installation);
    return frame;
}

glm::vec3 viewerOf(const ShowFrame& frame) { return frame.eye.value_or(frame.installation->eye); }

CalibratedCamera labCamera(const ShowFrame& frame, const std::optional<glm::vec3>& observer, glm::ivec2 size) {
    return deviceView(frame, observer.value_or(viewerOf(frame)), size);
}

} // namespace lumorph::studio
