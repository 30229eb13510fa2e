#include "core/render/projector_target.h"

#include <glm/matrix.hpp>

#include "core/render/draw_state.h"

namespace lumorph {

CalibratedCamera cropped(const CalibratedCamera& camera, const PixelRectangle& area) {
    CalibratedCamera part = camera;
    part.size = area.high - area.low;
    part.principal -= glm::dvec2(area.low.x, camera.size.y - area.high.y);
    return part;
}

void setLight(Program& program, const SceneProjector& projector) {
    program.set("projectorPosition", glm::vec3(positionOf(projector.camera)));
    program.set("projectorPeak", static_cast<float>(projector.peak) * projector.gain);
    program.set("projectorReference", static_cast<float>(projector.referenceDistance));
}

void setSight(Program& program, const ProjectorTarget& target, int unit) {
    const CalibratedCamera& camera = target.projector.camera;
    const DepthRange& range = target.range;
    const glm::dmat4 clipFromWorld = clipFromCamera(camera, range.near, range.far) * camera.cameraFromWorld;
    setCamera(program, camera, range.near, range.far, "sightLens");
    program.set("sightPlane", glm::mat4(glm::transpose(glm::inverse(clipFromWorld))));
    program.set("sightSize", glm::vec2(camera.size));
    program.set("sightTexel", static_cast<float>(1.0 / camera.focal.x));
    program.set("sightDepthSlope", static_cast<float>(depthSlope(range)));
    bindTexture(unit, target.sent.depthTexture());
    program.set("sightDepth", unit);
}

} // namespace lumorph
