#include "core/render/projector_pass.h"

#include <utility>

#include "core/render/draw_state.h"

namespace lumorph {
namespace {

ShaderFiles physicalFiles(const std::vector<std::string>& fragment, std::vector<std::string> defines = {}) {
    ShaderFiles files = shaderFiles({"version.glsl", "camera.glsl", "physical.vert"}, fragment);
    files.defines = std::move(defines);
    return files;
}

ShaderFiles weightFiles(std::vector<std::string> defines) {
    return physicalFiles({"version.glsl", "camera.glsl", "physical_normal.glsl", "projector_light.glsl",
                          "projector_sight.glsl", "projector_weight.frag"},
                         std::move(defines));
}

void drawTableOf(const ProjectorTarget& target, Program& program) {
    program.set("worldFromMesh", glm::mat4(1.0F));
    target.table.draw();
}

void setLens(Program& program, const ProjectorTarget& target) {
    setCamera(program, target.projector.camera, target.range.near, target.range.far);
}

} // namespace

ProjectorPass::ProjectorPass()
    : depth_(physicalFiles({"version.glsl", "nothing.frag"})),
      edges_(shaderFiles({"full_frame.vert"}, {"version.glsl", "projector_edges.frag"})),
      distance_(shaderFiles({"full_frame.vert"}, {"version.glsl", "projector_distance.frag"})),
      deviceWeight_(weightFiles({})), tableWeight_(weightFiles({"TABLE"})),
      done_(shaderFiles({"full_frame.vert"}, {"version.glsl", "projector_done.frag"})) {}

void ProjectorPass::drawDepth(ProjectorTarget& target, const ShowFrame& frame, const DeviceSurface& device,
                              bool withTable) {
    target.range = depthRange(target.projector.camera, physicalBounds(frame));
    target.table.fit(target.projector.camera, frame.scene->table.size);
    beginSurfaces(target.sent.framebuffer(), target.sent.size());
    glEnable(GL_SCISSOR_TEST);
    scissor(target.area);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glClear(GL_DEPTH_BUFFER_BIT);
    depth_.use();
    setLens(depth_, target);
    device.draw(depth_);
    if (withTable) drawTableOf(target, depth_);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDisable(GL_SCISSOR_TEST);
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

void ProjectorPass::addWeight(const ProjectorTarget& shown, const ProjectorTarget& weighed,
                              const DeviceSurface& device) {
    const bool own = &shown == &weighed;
    for (Program* program : {&deviceWeight_, &tableWeight_}) {
        program->use();
        setLens(*program, shown);
        program->set("viewerPosition", glm::vec3(positionOf(shown.projector.camera)));
        setLight(*program, weighed.projector);
        setSight(*program, weighed, 0);
        bindTexture(1, weighed.blend->distance(0));
        program->set("openness", 1);
        program->set("own", own ? 1.0F : 0.0F);
        // The own depth tests these very fragments; it may not be read as well.
        if (own) bindTexture(0, weighed.blend->distance(0));
        program == &deviceWeight_ ? device.draw(*program) : drawTableOf(shown, *program);
    }
}

void ProjectorPass::drawWeights(std::span<ProjectorTarget* const> targets, const DeviceSurface& device) {
    for (ProjectorTarget* target : targets) {
        if (!target->blend) target->blend.emplace(target->sent.size(), target->sent.depthTexture());
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
        for (const ProjectorTarget* weighed : targets) addWeight(*shown, *weighed, device);
    }
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
}

Program& ProjectorPass::seenProgram(const std::vector<std::string>& defines) {
    return seen_
        .try_emplace(defines,
                     physicalFiles({"version.glsl", "physical_normal.glsl", "projector_light.glsl",
                                    "projector_output.glsl", "eye_lookup.glsl", "noise.glsl", "projector.frag"},
                                   defines))
        .first->second;
}

Program& ProjectorPass::beginLookup(const ProjectorTarget& target, const ShowFrame& frame, const EyeViews& views,
                                    const TableArea* onTable) {
    const bool second = onTable != nullptr && views.table != nullptr && !holds(views.device->camera(), *onTable, frame);
    std::vector<std::string> defines;
    if (target.blend) defines.emplace_back("SHARED");
    if (target.projector.gamma > 0.0) defines.emplace_back("GAMMA");
    if (onTable != nullptr) defines.emplace_back("TABLE");
    if (second) defines.emplace_back("TABLE_VIEW");
    Program& program = seenProgram(defines);
    program.use();
    setLens(program, target);
    setOutput(program, target, frame.scene->compensation, 0);
    views.device->set(program, "device", 2);
    if (onTable == nullptr) return program;
    if (second) views.table->set(program, "table", 4);
    program.set("lookupArea", glm::vec4(onTable->low, onTable->high));
    return program;
}

void ProjectorPass::drawSeen(const ProjectorTarget& target, const ShowFrame& frame, const DeviceSurface& device,
                             const EyeViews& views) {
    beginSurfaces(target.seen.name(), target.sent.size());
    glEnable(GL_SCISSOR_TEST);
    scissor(target.area);
    glClear(GL_COLOR_BUFFER_BIT);
    if (views.device != nullptr) {
        (target.projector.gamma > 0.0 ? glDisable : glEnable)(GL_FRAMEBUFFER_SRGB);
        device.draw(beginLookup(target, frame, views, nullptr));
        for (const TableArea& area : views.tableAreas) {
            scissor(lookupPixels(area, target.projector.camera));
            drawTableOf(target, beginLookup(target, frame, views, &area));
        }
        scissor(target.area);
    }
    hideDone(target, views.device != nullptr);
    glDisable(GL_SCISSOR_TEST);
}

// What is done lies nearer than all else, so that the rest alone is shaded.
void ProjectorPass::hideDone(const ProjectorTarget& target, bool any) {
    glBindFramebuffer(GL_FRAMEBUFFER, target.rest.name());
    glClear(GL_DEPTH_BUFFER_BIT);
    if (!any) return;
    glDepthFunc(GL_ALWAYS);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    done_.use();
    bindTexture(0, target.done.name());
    done_.set("done", 0);
    glBindVertexArray(noAttributes_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

std::size_t ProjectorPass::objectCount() const noexcept {
    std::size_t count = 1;
    for (const Program* program : {&depth_, &edges_, &distance_, &deviceWeight_, &tableWeight_, &done_})
        count += program->objectCount();
    for (const auto& [defines, program] : seen_) count += program.objectCount();
    return count;
}

} // namespace lumorph
