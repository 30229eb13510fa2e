#include "core/render/eye_pass.h"

#include <epoxy/gl.h>

namespace lumorph {

struct EyePass::Data {};

EyePass::EyePass() : data_(std::make_unique<Data>()) {}
EyePass::~EyePass() = default;
EyePass::EyePass(EyePass&&) noexcept = default;
EyePass& EyePass::operator=(EyePass&&) noexcept = default;

void EyePass::prepare(const ShowFrame&) {}

void EyePass::draw(const ShowFrame&, const CalibratedCamera& camera, unsigned framebuffer) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, camera.size.x, camera.size.y);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void EyePass::drawUnseen(const ShowFrame& frame, const CalibratedCamera& camera, unsigned framebuffer) {
    draw(frame, camera, framebuffer);
}

std::vector<std::string> EyePass::warnings() const { return {}; }
std::size_t EyePass::objectCount() const noexcept { return 0; }

} // namespace lumorph
