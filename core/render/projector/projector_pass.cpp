#include "core/render/projector/projector_pass.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/render/gl/draw_state.h"

namespace lumorph {
namespace {

ShaderFiles physicalFiles(const std::vector<std::string>& fragment, std::vector<std::string> defines = {}) {
    ShaderFiles files = shaderFiles({"version.glsl", "camera.glsl", "physical.vert"}, fragment);
    files.defines = std::move(defines);
    return files;
}

ShaderFiles weightFiles(std::vector<std::string> defines) {
    return physicalFiles({"version.glsl", "camera.glsl", "physical_normal.glsl", "projector_light.glsl",
                          "projector_sight.glsl", "hands.glsl", "projector_weight.frag"},
                         std::move(defines));
}

ShaderFiles mixedFiles(std::vector<std::string> defines) {
    std::vector<std::string> pieces{"version.glsl", "camera.glsl", "projector_eye_weight.glsl"};
    if (std::ranges::find(defines, "RESPONSE") != defines.end()) pieces.emplace_back("projector_response.glsl");
    pieces.emplace_back("projector_mixed.frag");
    ShaderFiles files = shaderFiles({"full_frame.vert"}, pieces);
    files.defines = std::move(defines);
    return files;
}

void drawTableOf(const ProjectorTarget& target, Program& program) {
    program.set("worldFromMesh", glm::mat4(1.0F));
    target.table.draw();
}

// The scissor test is on, and is set to another place.
void clearRegion(const PixelRegion& region, GLbitfield what) {
    for (const PixelRectangle& part : region.parts()) {
        scissor(part);
        glClear(what);
    }
}

void setLens(Program& program, const ProjectorTarget& target) {
    setCamera(program, target.projector.camera, target.range.near, target.range.far);
}

/// Binds texture units 2 and 3.
void setEye(Program& program, const EyeViews& views) {
    program.set("eyePosition", glm::vec3(positionOf(views.device->camera())));
    views.device->set(program, "device", 2);
}

/// Where the eye's pictures are looked up.
PixelRegion lookedUpPixels(const ProjectorTarget& target, const EyeViews& views) {
    PixelRegion region(target.device);
    for (const TableArea& area : views.tableAreas) region.include(lookupPixels(area, target.projector.camera));
    return region;
}

float meanSquare(const glm::vec3& color) { return glm::dot(color, color) / 3.0F; }

} // namespace

ProjectorPass::ProjectorPass()
    : depth_(physicalFiles({"version.glsl", "nothing.frag"})),
      surface_(physicalFiles(
          {"version.glsl", "physical_normal.glsl", "packed_normal.glsl", "eye_lookup.glsl", "projector_surface.frag"})),
      edges_(shaderFiles({"full_frame.vert"}, {"version.glsl", "projector_edges.frag"})),
      distance_(shaderFiles({"full_frame.vert"}, {"version.glsl", "projector_distance.frag"})),
      deviceWeight_(weightFiles({})), tableWeight_(weightFiles({"TABLE"})), deviceBlack_(weightFiles({"BLACK"})),
      tableBlack_(weightFiles({"BLACK", "TABLE"})),
      done_(shaderFiles({"full_frame.vert"}, {"version.glsl", "projector_done.frag"})), mixed_(mixedFiles({})),
      mixedGamma_(mixedFiles({"GAMMA"})), mixedResponse_(mixedFiles({"RESPONSE"})) {}

void ProjectorPass::drawDepth(ProjectorTarget& target, const ShowFrame& frame, const DeviceSurface& device,
                              const EyeViews& views, bool shared) {
    target.range = depthRange(target.projector.camera, physicalBounds(frame));
    target.table.fit(target.projector.camera, frame.installation->tableSize);
    target.device = devicePixels(frame, target.projector.camera);
    beginSurfaces(target.sent.framebuffer(), target.sent.size());
    glEnable(GL_SCISSOR_TEST);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    clearRegion(target.region, GL_DEPTH_BUFFER_BIT);
    scissor(target.region.bounds());
    depth_.use();
    setLens(depth_, target);
    if (shared) drawTableOf(target, depth_);
    // Of one projector alone the surface brings the depth along.
    const bool withSurface = views.device != nullptr && !shared;
    if (!withSurface) device.draw(depth_);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    if (withSurface) drawSurface(target, device, views);
    glDisable(GL_SCISSOR_TEST);
}

// The scissor test is on; the depth of what stands before the device is drawn, so that it holds what the projector
// sees.
void ProjectorPass::drawSurface(const ProjectorTarget& target, const DeviceSurface& device, const EyeViews& views) {
    seenSurface_.fit(target.sent.size());
    seenSurface_.bind(target.sent.depthTexture());
    scissor(target.device);
    constexpr std::array<GLfloat, 4> kNothing{};
    glClearBufferfv(GL_COLOR, 0, kNothing.data());
    surface_.use();
    setLens(surface_, target);
    surface_.set("projectorPosition", glm::vec3(positionOf(target.projector.camera)));
    views.device->set(surface_, "device", 2);
    device.draw(surface_);
}

void ProjectorPass::drawFullFrame(const PixelRectangle& part) {
    scissor(part);
    glBindVertexArray(noAttributes_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
}

void ProjectorPass::drawDistance(ProjectorTarget& target) {
    const auto pass = [&](std::size_t to) {
        glBindFramebuffer(GL_FRAMEBUFFER, target.blend->distanceFramebuffer(to));
        glBindVertexArray(noAttributes_.name());
        glDrawArrays(GL_TRIANGLES, 0, 3);
        glBindVertexArray(0);
    };
    beginSurfaces(target.blend->distanceFramebuffer(0), target.blend->distanceSize());
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_FRAMEBUFFER_SRGB);
    edges_.use();
    bindTexture(0, target.sent.depthTexture());
    edges_.set("depthMap", 0);
    edges_.set("block", BlendMaps::kBlock);
    edges_.set("depthFar", static_cast<float>(target.range.far / (target.range.far - target.range.near)));
    edges_.set("depthSlope", static_cast<float>(depthSlope(target.range)));
    edges_.set("focal", static_cast<float>(target.projector.camera.focal.x));
    pass(0);
    distance_.use();
    distance_.set("before", 0);
    distance_.set("radius", BlendMaps::kRadius);
    distance_.set("axis", glm::vec2(1.0F, 0.0F));
    bindTexture(0, target.blend->distance(0));
    pass(1);
    distance_.set("axis", glm::vec2(0.0F, 1.0F));
    bindTexture(0, target.blend->distance(1));
    pass(0);
}

void ProjectorPass::addWeight(const ProjectorTarget& shown, const ProjectorTarget& weighed, const ShowFrame& frame,
                              const DeviceSurface& device) {
    const bool own = &shown == &weighed;
    const bool black = shown.blend->hasBlacks();
    Program& onDevice = black ? deviceBlack_ : deviceWeight_;
    for (Program* program : {&onDevice, black ? &tableBlack_ : &tableWeight_}) {
        program->use();
        program->set("weighedBlack", weighed.projector.black);
        program->set("compensation", frame.installation->compensation ? 1.0F : 0.0F);
        setHands(*program, frame.hands);
        setLens(*program, shown);
        program->set("viewerPosition", glm::vec3(positionOf(shown.projector.camera)));
        setLight(*program, weighed.projector);
        setSight(*program, weighed, 0);
        bindTexture(1, weighed.blend->distance(0));
        program->set("openness", 1);
        program->set("own", own ? 1.0F : 0.0F);
        // The own depth tests these very fragments; it may not be read as well.
        if (own) bindTexture(0, weighed.blend->distance(0));
        program == &onDevice ? device.draw(*program) : drawTableOf(shown, *program);
    }
}

void ProjectorPass::drawWeights(std::span<ProjectorTarget* const> targets, const ShowFrame& frame,
                                const DeviceSurface& device) {
    const bool black = std::ranges::any_of(
        targets, [](const ProjectorTarget* target) { return target->projector.black != glm::vec3(0.0F); });
    for (ProjectorTarget* target : targets) {
        if (!target->blend || target->blend->hasBlacks() != black)
            target->blend.emplace(target->sent.size(), target->sent.depthTexture(), black);
        drawDistance(*target);
    }
    for (ProjectorTarget* shown : targets) {
        beginSurfaces(shown->blend->weightsFramebuffer(), shown->sent.size());
        glDisable(GL_FRAMEBUFFER_SRGB);
        glClear(GL_COLOR_BUFFER_BIT);
        glDepthMask(GL_FALSE);
        glEnable(GL_BLEND);
        glBlendEquation(GL_FUNC_ADD);
        glBlendFunc(GL_ONE, GL_ONE);
        for (const ProjectorTarget* weighed : targets) addWeight(*shown, *weighed, frame, device);
    }
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
}

Program& ProjectorPass::seenProgram(const std::vector<std::string>& defines) {
    const auto found = seen_.find(defines);
    if (found != seen_.end()) return found->second;
    const auto has = [&](const char* name) { return std::ranges::find(defines, name) != defines.end(); };
    std::vector<std::string> pieces{"version.glsl", "physical_normal.glsl", "packed_normal.glsl",
                                    "projector_eye_weight.glsl", "projector_light.glsl"};
    if (has("RESPONSE")) pieces.emplace_back("projector_response.glsl");
    pieces.insert(pieces.end(), {"projector_output.glsl", "eye_lookup.glsl", "noise.glsl", "projector.frag"});
    ShaderFiles files = physicalFiles(pieces, defines);
    if (!has("TABLE")) files.vertex = shaderFiles({"full_frame.vert"}, {}).vertex;
    return seen_.try_emplace(defines, files).first->second;
}

Program& ProjectorPass::beginLookup(const ProjectorTarget& target, const ShowFrame& frame, const EyeViews& views,
                                    const TableArea* onTable) {
    const bool second = onTable != nullptr && views.table != nullptr && !holds(views.device->camera(), *onTable, frame);
    std::vector<std::string> defines;
    if (target.blend) defines.emplace_back("SHARED");
    if (target.encodes()) defines.emplace_back(target.response ? "RESPONSE" : "GAMMA");
    if (onTable != nullptr) defines.emplace_back("TABLE");
    if (second) defines.emplace_back("TABLE_VIEW");
    Program& program = seenProgram(defines);
    program.use();
    setLens(program, target);
    setOutput(program, target, *frame.installation,
              onTable != nullptr ? PhysicalSurface::table : PhysicalSurface::device, 6);
    setEye(program, views);
    if (onTable == nullptr) return program;
    if (second) views.table->set(program, "table", 4);
    program.set("lookupArea", glm::vec4(onTable->low, onTable->high));
    return program;
}

void ProjectorPass::drawSeen(const ProjectorTarget& target, const ShowFrame& frame, const DeviceSurface& device,
                             const EyeViews& views) {
    beginSurfaces(target.seen.name(), target.sent.size());
    glEnable(GL_SCISSOR_TEST);
    if (views.device != nullptr && target.blend) {
        drawSurface(target, device, views);
        glBindFramebuffer(GL_FRAMEBUFFER, target.seen.name());
    }
    clearRegion(target.region, GL_COLOR_BUFFER_BIT);
    if (views.device != nullptr) {
        (target.encodes() ? glDisable : glEnable)(GL_FRAMEBUFFER_SRGB);
        Program& program = beginLookup(target, frame, views, nullptr);
        seenSurface_.set(program, 4);
        glDisable(GL_DEPTH_TEST);
        drawFullFrame(target.device);
        glEnable(GL_DEPTH_TEST);
        for (const TableArea& area : views.tableAreas) {
            scissor(lookupPixels(area, target.projector.camera));
            drawTableOf(target, beginLookup(target, frame, views, &area));
        }
    }
    hideDone(target, views);
    glDisable(GL_SCISSOR_TEST);
}

// What is done lies nearer than all else, so that the rest alone is shaded.
void ProjectorPass::hideDone(const ProjectorTarget& target, const EyeViews& views) {
    glBindFramebuffer(GL_FRAMEBUFFER, target.rest.name());
    clearRegion(target.region, GL_DEPTH_BUFFER_BIT);
    if (views.device == nullptr) return;
    glDepthFunc(GL_ALWAYS);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    done_.use();
    bindTexture(0, target.eyeWeight.name());
    done_.set("eyeWeight", 0);
    const PixelRegion region = lookedUpPixels(target, views);
    for (const PixelRectangle& part : region.parts()) drawFullFrame(part);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

Program& ProjectorPass::mixedProgram(const ProjectorTarget& target) {
    if (target.response) return mixedResponse_;
    return target.projector.gamma > 0.0 ? mixedGamma_ : mixed_;
}

void ProjectorPass::drawMixed(const ProjectorTarget& target, const ShowFrame& frame, const EyeViews& views) {
    if (views.device == nullptr) return;
    const PixelRegion region = lookedUpPixels(target, views);
    beginSurfaces(target.rest.name(), target.sent.size());
    glDisable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    for (const PixelRectangle& part : region.parts()) seenSurface_.keepPicture(part);
    (target.encodes() ? glDisable : glEnable)(GL_FRAMEBUFFER_SRGB);
    Program& program = mixedProgram(target);
    program.use();
    setLens(program, target);
    setEye(program, views);
    program.set("projectorPosition", glm::vec3(positionOf(target.projector.camera)));
    program.set("tableHalf", 0.5F * frame.installation->tableSize);
    program.set("tableAlbedo", meanSquare(albedoOf(*frame.installation, PhysicalSurface::table)));
    program.set("gamma", static_cast<float>(target.projector.gamma));
    if (target.response) target.response->set(program, 6);
    bindTexture(0, target.eyeWeight.name());
    program.set("eyeWeight", 0);
    seenSurface_.setPicture(program, 1);
    seenSurface_.set(program, 4);
    program.set("deviceArea", glm::vec4(target.device.low, target.device.high));
    glEnable(GL_SCISSOR_TEST);
    for (const PixelRectangle& part : region.parts()) drawFullFrame(part);
    glDisable(GL_SCISSOR_TEST);
    glDepthMask(GL_TRUE);
    glEnable(GL_DEPTH_TEST);
}

std::size_t ProjectorPass::objectCount() const noexcept {
    std::size_t count = 1 + ProjectorSurface::kObjects;
    for (const Program* program : {&depth_, &surface_, &edges_, &distance_, &deviceWeight_, &tableWeight_,
                                   &deviceBlack_, &tableBlack_, &done_, &mixed_, &mixedGamma_, &mixedResponse_})
        count += program->objectCount();
    for (const auto& [defines, program] : seen_) count += program.objectCount();
    return count;
}

} // namespace lumorph
