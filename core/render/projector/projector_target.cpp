#include "core/render/projector/projector_target.h"

#include <algorithm>
#include <vector>

#include <glm/matrix.hpp>

#include "core/base/srgb.h"
#include "core/render/eye/eye_programs.h"
#include "core/render/gl/draw_state.h"
#include "core/scene/projector_response.h"

namespace lumorph {
namespace {

constexpr std::size_t kMostCapsules = 8; ///< as in hands.glsl
constexpr float kDarkestSurface = 0.01F; // what is darker nobody makes bright

} // namespace

ProjectorTarget::ProjectorTarget(const InstalledProjector& what)
    : projector(what), sent(what.camera.size), open(what.camera.size) {
    const glm::ivec2 size = sent.size();
    bindTexture(0, eyeWeight.name());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R16F, size.x, size.y, 0, GL_RED, GL_FLOAT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    bindTexture(0, 0);
    const auto attach = [](GLenum to, GLuint texture) {
        glFramebufferTexture2D(GL_FRAMEBUFFER, to, GL_TEXTURE_2D, texture, 0);
    };
    glBindFramebuffer(GL_FRAMEBUFFER, seen.name());
    attach(GL_COLOR_ATTACHMENT0, sent.texture());
    attach(GL_COLOR_ATTACHMENT1, eyeWeight.name());
    attach(GL_DEPTH_ATTACHMENT, sent.depthTexture());
    constexpr GLenum kBoth[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(2, kBoth);
    glBindFramebuffer(GL_FRAMEBUFFER, rest.name());
    attach(GL_COLOR_ATTACHMENT0, sent.texture());
    attach(GL_DEPTH_ATTACHMENT, open.texture());
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void ProjectorTarget::become(const InstalledProjector& what, const glm::vec3& floor) {
    projector = what;
    blackFloor = floor;
    if (!isResponseMeasured(what)) return response.reset();
    if (!response) response.emplace();
    response->update(what);
}

void setLight(Program& program, const InstalledProjector& projector) {
    program.set("projectorPosition", glm::vec3(positionOf(projector.camera)));
    program.set("projectorPeak", static_cast<float>(projector.peak) * projector.gain);
    program.set("projectorReference", static_cast<float>(projector.referenceDistance));
}

glm::vec3 albedoOf(const Installation& installation, PhysicalSurface surface) {
    const bool device = surface == PhysicalSurface::device;
    return linearFromSrgb(device ? installation.deviceColor : installation.tableColor);
}

void setOutput(Program& program, const ProjectorTarget& target, const Installation& installation,
               PhysicalSurface surface, int unit) {
    setLight(program, target.projector);
    program.set("compensation", installation.compensation ? 1.0F : 0.0F);
    program.set("surfaceAlbedo", glm::max(albedoOf(installation, surface), kDarkestSurface));
    if (target.projector.gamma > 0.0) program.set("inverseGamma", static_cast<float>(1.0 / target.projector.gamma));
    if (target.response) {
        target.response->set(program, unit + 1);
        program.set("blackFloor", target.blackFloor);
    }
    if (!target.blend) return;
    bindTexture(unit, target.blend->weights());
    program.set("weights", unit);
    if (!target.response || !target.blend->hasBlacks()) return;
    bindTexture(unit + 2, target.blend->blacks());
    program.set("blacks", unit + 2);
}

UnseenPlaces unseenPlaces(const ProjectorTarget& target, const Installation& installation) {
    const std::uint32_t features = eye_feature::projected | (target.blend ? eye_feature::shared : 0U) |
                                   (target.response                ? eye_feature::response
                                    : target.projector.gamma > 0.0 ? eye_feature::gamma
                                                                   : 0U);
    return {target.projector.camera,
            target.region,
            target.device,
            target.rest.name(),
            features,
            [&target, &installation](Program& program, PhysicalSurface surface, int unit) {
                setOutput(program, target, installation, surface, unit);
            }};
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

void setHands(Program& program, std::span<const Capsule> hands) {
    std::vector<glm::vec4> from;
    std::vector<glm::vec3> to;
    for (const Capsule& capsule : hands.first(std::min(hands.size(), kMostCapsules))) {
        from.emplace_back(capsule.from, capsule.radius);
        to.push_back(capsule.to);
    }
    program.set("handCapsules", static_cast<int>(from.size()));
    if (from.empty()) return;
    program.set("handFrom", std::span<const glm::vec4>(from));
    program.set("handTo", std::span<const glm::vec3>(to));
}

} // namespace lumorph
