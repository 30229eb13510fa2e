#include "core/render/projector_pass.h"

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

std::vector<std::string> outputDefines(const ProjectorTarget& target) {
    std::vector<std::string> defines;
    if (target.blend) defines.emplace_back("SHARED");
    if (target.projector.gamma > 0.0) defines.emplace_back("GAMMA");
    return defines;
}

void scissor(const PixelRectangle& area) {
    glScissor(area.low.x, area.low.y, area.high.x - area.low.x, area.high.y - area.low.y);
}

} // namespace

ProjectorPass::ProjectorPass()
    : depth_(physicalFiles({"version.glsl", "nothing.frag"})),
      edges_(shaderFiles({"full_frame.vert"}, {"version.glsl", "projector_edges.frag"})),
      distance_(shaderFiles({"full_frame.vert"}, {"version.glsl", "projector_distance.frag"})),
      deviceWeight_(weightFiles({})), tableWeight_(weightFiles({"TABLE"})) {}

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

Program& ProjectorPass::colorProgram(std::vector<std::string> defines, bool table) {
    std::vector<std::string> fragment{"version.glsl", "physical_normal.glsl", "projector_light.glsl"};
    for (const std::string& define : defines)
        if (define.starts_with("EYE")) fragment.emplace_back("eye_lookup.glsl");
    fragment.emplace_back("projector.frag");
    if (table) defines.emplace_back("TABLE");
    return colors_.try_emplace(defines, physicalFiles(fragment, defines)).first->second;
}

Program& ProjectorPass::plainProgram(std::vector<std::string> defines) {
    ShaderFiles files = shaderFiles({"version.glsl", "camera.glsl", "projector_light.glsl", "projector_plain.vert"},
                                    {"version.glsl", "projector_plain.frag"});
    files.defines = defines;
    return plain_.try_emplace(std::move(defines), std::move(files)).first->second;
}

void ProjectorPass::setColor(Program& program, const ProjectorTarget& target, const ShowFrame& frame) const {
    const SceneProjector& projector = target.projector;
    program.use();
    setLens(program, target);
    setLight(program, projector);
    program.set("compensation", frame.scene->compensation ? 1.0F : 0.0F);
    if (projector.gamma > 0.0) program.set("inverseGamma", static_cast<float>(1.0 / projector.gamma));
    bindTexture(0, target.unseen.texture());
    program.set("unseen", 0);
    program.set("unseenCorner", glm::vec2(target.area.low));
    if (!target.blend) return;
    bindTexture(1, target.blend->weights());
    program.set("weights", 1);
}

Program& ProjectorPass::beginLookup(const ProjectorTarget& target, const ShowFrame& frame, const EyeViews& views,
                                    bool table) {
    std::vector<std::string> defines = outputDefines(target);
    if (views.device != nullptr) defines.emplace_back(table && views.table != nullptr ? "EYE 2" : "EYE 1");
    Program& program = colorProgram(std::move(defines), table);
    setColor(program, target, frame);
    if (views.device != nullptr) views.device->set(program, "device", 2);
    if (!table) return program;
    if (views.table != nullptr) views.table->set(program, "table", 4);
    program.set("lookupArea", glm::vec4(views.tableArea->low, views.tableArea->high));
    return program;
}

// Looking things up in the eye's pictures is dear, and most of the table shows every eye the same.
void ProjectorPass::drawTable(const ProjectorTarget& target, const ShowFrame& frame, const EyeViews& views) {
    PixelRectangle area;
    if (views.device != nullptr && views.tableArea) area = pixelsOf(*views.tableArea, target.projector.camera);
    if (!area.empty()) {
        scissor(area);
        drawTableOf(target, beginLookup(target, frame, views, true));
    }
    Program& plain = plainProgram(outputDefines(target));
    setColor(plain, target, frame);
    for (const PixelRectangle& rest : around(area, target.area)) {
        if (rest.empty()) continue;
        scissor(rest);
        target.table.draw();
    }
}

void ProjectorPass::draw(const ProjectorTarget& target, const ShowFrame& frame, const DeviceSurface& device,
                         const EyeViews& views) {
    beginSurfaces(target.sent.framebuffer(), target.sent.size());
    glEnable(GL_SCISSOR_TEST);
    scissor(target.area);
    glClear(GL_COLOR_BUFFER_BIT);
    if (target.projector.gamma > 0.0)
        glDisable(GL_FRAMEBUFFER_SRGB);
    else
        glEnable(GL_FRAMEBUFFER_SRGB);
    Program& program = beginLookup(target, frame, views, false);
    device.draw(program);
    drawTable(target, frame, views);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_FRAMEBUFFER_SRGB);
}

std::size_t ProjectorPass::objectCount() const noexcept {
    std::size_t count = 1;
    for (const Program* program : {&depth_, &edges_, &distance_, &deviceWeight_, &tableWeight_})
        count += program->objectCount();
    for (const auto* programs : {&colors_, &plain_})
        for (const auto& [defines, program] : *programs) count += program.objectCount();
    return count;
}

} // namespace lumorph
