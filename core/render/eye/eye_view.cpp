#include "core/render/eye/eye_view.h"

#include <glm/matrix.hpp>

#include "core/render/gl/draw_state.h"

namespace lumorph {

EyeView::EyeView(glm::ivec2 size) : picture_(size, GL_RGBA16F), depth_(size) {
    beginSurfaces(picture_.framebuffer(), size);
    glClear(GL_COLOR_BUFFER_BIT);
}

void EyeView::draw(EyePass& pass, const ShowFrame& frame, const CalibratedCamera& camera, Use use,
                   const DeviceSurface& device, Program& depthProgram) {
    camera_ = camera;
    range_ = depthRange(camera, deviceBounds(frame));
    glEnable(GL_FRAMEBUFFER_SRGB);
    if (use == Use::tableAlone)
        pass.drawBesideDevice(frame, camera, picture_.framebuffer());
    else
        pass.draw(frame, camera, picture_.framebuffer());
    beginSurfaces(depth_.framebuffer(), camera.size);
    glClear(GL_DEPTH_BUFFER_BIT);
    depthProgram.use();
    setCamera(depthProgram, camera, range_.near, range_.far);
    device.draw(depthProgram);
}

void EyeView::set(Program& program, const std::string& name, int unit) const {
    const glm::dmat4 clipFromWorld = clipFromCamera(camera_, range_.near, range_.far) * camera_.cameraFromWorld;
    program.set(name + "View.clipFromWorld", glm::mat4(clipFromWorld));
    program.set(name + "View.clipFromWorldPlane", glm::mat4(glm::transpose(glm::inverse(clipFromWorld))));
    program.set(name + "View.size", glm::vec2(camera_.size));
    program.set(name + "View.texel", static_cast<float>(1.0 / camera_.focal.x));
    program.set(name + "View.depthSlope", static_cast<float>(depthSlope(range_)));
    bindTexture(unit, picture_.texture());
    program.set(name + "Picture", unit);
    bindTexture(unit + 1, depth_.texture());
    program.set(name + "ViewDepth", unit + 1);
}

} // namespace lumorph
