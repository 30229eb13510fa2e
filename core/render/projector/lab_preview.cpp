#include "core/render/projector/lab_preview.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/render/gl/draw_state.h"

namespace lumorph {
namespace {

/// While projectors show something walls have a lamp of their own, so that nothing is black behind the device.
constexpr float kWallLamp = 0.16F;
/// Radiance of device and table where there is no program for their light, so that the one shows on the other.
constexpr glm::vec2 kStandIn(0.5F, 0.1F);

ShaderFiles litFiles(std::vector<std::string> defines) {
    std::vector<std::string> pieces{"version.glsl",         "camera.glsl",          "physical_normal.glsl",
                                    "projector_light.glsl", "projector_sight.glsl", "hands.glsl"};
    if (std::ranges::find(defines, "RESPONSE") != defines.end()) pieces.emplace_back("projector_response.glsl");
    pieces.emplace_back("lab.frag");
    ShaderFiles files = shaderFiles({"version.glsl", "camera.glsl", "physical.vert"}, pieces);
    files.defines = std::move(defines);
    return files;
}

ShaderFiles roomLightFiles(std::vector<std::string> defines) {
    ShaderFiles files = shaderFiles({"version.glsl", "camera.glsl", "physical.vert"},
                                    {"version.glsl", "physical_normal.glsl", "room_lamp.glsl", "room_light.frag"});
    files.defines = std::move(defines);
    return files;
}

} // namespace

LabPreview::LabPreview()
    : flat_(shaderFiles({"version.glsl", "camera.glsl", "physical.vert"}, {"version.glsl", "flat.frag"})),
      room_(shaderFiles({"full_frame.vert"}, {"version.glsl", "noise.glsl", "room.frag"})),
      hands_(shaderFiles({"full_frame.vert"},
                         {"version.glsl", "camera.glsl", "hands.glsl", "room_lamp.glsl", "hand.frag"})),
      roomLight_{Program(roomLightFiles({})), Program(roomLightFiles({"TABLE"}))}, light_{Program(litFiles({})),
                                                                                          Program(litFiles({"TABLE"}))},
      measuredLight_{Program(litFiles({"RESPONSE"})), Program(litFiles({"RESPONSE", "TABLE"}))},
      mask_{Program(litFiles({"MASK"})), Program(litFiles({"MASK", "TABLE"}))} {}

void LabPreview::drawSurfaces(const Observer& observer, const DeviceSurface& device, float onDevice, float onTable) {
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    flat_.use();
    setCamera(flat_, observer.camera, observer.range.near, observer.range.far);
    flat_.set("flatColor", onDevice * albedoOf(observer.installation, PhysicalSurface::device));
    device.draw(flat_);
    flat_.set("flatColor", onTable * albedoOf(observer.installation, PhysicalSurface::table));
    flat_.set("worldFromMesh", glm::mat4(1.0F));
    table_.draw();
}

void LabPreview::drawWith(Light& light, const Observer& observer, const DeviceSurface& device,
                          const std::function<void(Program&)>& set) {
    for (const PhysicalSurface surface : {PhysicalSurface::device, PhysicalSurface::table}) {
        const bool onDevice = surface == PhysicalSurface::device;
        Program& program = onDevice ? light.device : light.table;
        program.use();
        setCamera(program, observer.camera, observer.range.near, observer.range.far);
        program.set("viewerPosition", glm::vec3(positionOf(observer.camera)));
        program.set("surfaceAlbedo", albedoOf(observer.installation, surface));
        set(program);
        if (onDevice) device.draw(program);
        if (onDevice) continue;
        program.set("worldFromMesh", glm::mat4(1.0F));
        table_.draw();
    }
}

/// The current program sees by the observer's rays.
void LabPreview::drawFullFrame(Program& program, const Observer& observer) {
    const CalibratedCamera& camera = observer.camera;
    program.set("worldFromCamera", glm::mat4(glm::inverse(camera.cameraFromWorld)));
    program.set("viewerPosition", glm::vec3(positionOf(camera)));
    program.set("focal", glm::vec2(camera.focal));
    program.set("principal", glm::vec2(camera.principal));
    program.set("frameSize", glm::vec2(camera.size));
    program.set("roomLight", observer.room);
    glBindVertexArray(noAttributes_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
}

void LabPreview::drawRoom(const Observer& observer, const DeviceSurface& device, bool showing) {
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    room_.use();
    room_.set("tableHalf", 0.5F * observer.installation.tableSize);
    room_.set("wallLamp", showing ? kWallLamp : 0.0F);
    glDepthMask(GL_FALSE);
    drawFullFrame(room_, observer);
    glDepthMask(GL_TRUE);
    drawWith(roomLight_, observer, device, [&](Program& program) { program.set("roomLight", observer.room); });
    if (observer.hands.empty()) return;
    hands_.use();
    setHands(hands_, observer.hands);
    setCamera(hands_, observer.camera, observer.range.near, observer.range.far);
    drawFullFrame(hands_, observer);
}

void LabPreview::addProjector(const Observer& observer, const DeviceSurface& device, const ProjectorTarget& projector,
                              Light& light) {
    drawWith(light, observer, device, [&](Program& program) {
        setLight(program, projector.projector);
        setHands(program, observer.hands);
        program.set("bounces", observer.room > 0.0F ? 1.0F : 0.0F);
        program.set("tableAlbedo", albedoOf(observer.installation, PhysicalSurface::table));
        program.set("tableHalf", 0.5F * observer.installation.tableSize);
        setSight(program, projector, 0);
        bindTexture(1, projector.sent.texture());
        program.set("sent", 1);
        program.set("gamma", static_cast<float>(projector.projector.gamma));
        if (projector.response) projector.response->set(program, 2);
    });
}

void LabPreview::addLight(const Observer& observer, const DeviceSurface& device,
                          std::span<const ProjectorTarget* const> projectors) {
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE);
    for (const ProjectorTarget* projector : projectors)
        addProjector(observer, device, *projector, projector->response ? measuredLight_ : light_);
}

void LabPreview::drawLit(const Observer& observer, const DeviceSurface& device,
                         std::span<const ProjectorTarget* const> projectors) {
    if (!problem_.empty()) return;
    try {
        if (observer.room > 0.0F)
            drawRoom(observer, device, !projectors.empty());
        else
            drawSurfaces(observer, device, 0.0F, 0.0F);
        addLight(observer, device, projectors);
    } catch (const DataError& error) {
        problem_ = error.subject() + ": " + error.why() + "; the lab is drawn without the light of projectors";
    }
}

// Black where the driver refuses this too: projectors must not fail with it.
void LabPreview::drawStandIn(const Observer& observer, const DeviceSurface& device) {
    beginSurfaces(radiance_->framebuffer(), observer.camera.size);
    glClear(GL_COLOR_BUFFER_BIT);
    if (standInRefused_) return;
    try {
        drawSurfaces(observer, device, kStandIn.x, kStandIn.y);
    } catch (const DataError&) {
        standInRefused_ = true;
    }
}

void LabPreview::draw(GLuint framebuffer, const CalibratedCamera& observer, float room, const ShowFrame& frame,
                      const DeviceSurface& device, std::span<const ProjectorTarget* const> projectors,
                      PictureOutput& out) {
    if (!radiance_ || radiance_->size() != observer.size) radiance_.emplace(observer.size, GL_RGBA16F);
    table_.fit(observer, frame.installation->tableSize);
    const Observer seen{observer, depthRange(observer, physicalBounds(frame)), *frame.installation, frame.hands, room};
    beginSurfaces(radiance_->framebuffer(), observer.size);
    drawLit(seen, device, projectors);
    if (!problem_.empty()) drawStandIn(seen, device);
    out.draw(framebuffer, *radiance_);
}

void LabPreview::drawMask(GLuint framebuffer, const CalibratedCamera& observer, const ShowFrame& frame,
                          const DeviceSurface& device, std::span<const ProjectorTarget* const> projectors) {
    table_.fit(observer, frame.installation->tableSize);
    const Observer seen{observer, depthRange(observer, physicalBounds(frame)), *frame.installation, frame.hands, 0.0F};
    beginSurfaces(framebuffer, observer.size);
    drawSurfaces(seen, device, 0.0F, 0.0F);
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendEquation(GL_MAX);
    for (const ProjectorTarget* projector : projectors) addProjector(seen, device, *projector, mask_);
}

std::size_t LabPreview::objectCount() const noexcept {
    std::size_t count = TableGrid::kObjects + (radiance_ ? ColorTarget::kObjects : 0);
    count += 1 + flat_.objectCount() + room_.objectCount() + hands_.objectCount();
    for (const Light* light : {&roomLight_, &light_, &measuredLight_, &mask_})
        count += light->device.objectCount() + light->table.objectCount();
    return count;
}

} // namespace lumorph
