#include "core/render/spatial_renderer.h"

#include <chrono>
#include <optional>

#include "core/base/error.h"
#include "core/render/eye/lookup_region.h"
#include "core/render/gl/draw_state.h"
#include "core/render/projector/lab_preview.h"
#include "core/render/projector/projector_pass.h"
#include "core/scene/projector_response.h"

namespace lumorph {
namespace {

void check(const ShowFrame& frame) {
    if (frame.scene && frame.installation && frame.assets && frame.rig && frame.devicePositions) return;
    throw InvalidInput("frame", "it lacks its scene, its installation, its pictures, its rig or the device's positions",
                       "fill in all of them");
}

// Every name of GL this file draws with is given back in the state that Qt and the eye pass expect.
void restoreState() {
    glDisable(GL_FRAMEBUFFER_SRGB);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glUseProgram(0);
    bindTexture(0, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

ShaderFiles depthFiles() {
    return shaderFiles({"version.glsl", "camera.glsl", "physical.vert"}, {"version.glsl", "nothing.frag"});
}

/// Gives the state back when a part of the renderer throws.
struct StateKeeper {
    ~StateKeeper() { restoreState(); }
};

/// False where the driver refuses a program that there is a way without; `problem` says then what is lost. Throws
/// DataError where that way is refused too.
template <typename Draw> bool granted(std::string& problem, const char* loss, const Draw& draw) {
    try {
        draw();
        return true;
    } catch (const DataError& error) {
        if (!problem.empty()) throw;
        problem = error.subject() + ": " + error.why() + "; " + loss;
        restoreState();
        return false;
    }
}

} // namespace

struct SpatialRenderer::Data {
    EyePass pass;
    glm::ivec2 eyeSize{1280, 800};
    Program depthProgram{depthFiles()};
    DeviceSurface device;
    ProjectorPass projectorPass;
    LabPreview lab;
    PictureOutput out;
    std::optional<EyeView> eye;
    std::optional<EyeView> table;
    bool tableShown = false;
    std::vector<TableArea> tableAreas;
    std::vector<std::optional<ProjectorTarget>> projectors;
    std::optional<ShowFrame> frame;
    bool eyeShown = false;
    bool measuring = false;
    SpatialTimes times;
    std::string eyeProblem;
    // Of a driver that refuses a program of projectors: what looks the eye's picture up, and what weighs them.
    std::string lookupProblem;
    std::string sharingProblem;
    std::string mixedProblem;

    void beginFrame(const ShowFrame& next);
    void drawEye(const glm::vec3& from);
    void drawTableView(const glm::vec3& from);
    void fitProjectors();
    void drawProjectors();
    [[nodiscard]] EyeViews lookups() const;
    [[nodiscard]] bool drawProjectors(const EyeViews& views, bool shared); ///< false: begin anew, with less
    [[nodiscard]] std::vector<ProjectorTarget*> enabled();
    [[nodiscard]] std::vector<const ProjectorTarget*> lit() const;
    double finish(std::chrono::steady_clock::time_point& since) const;
};

// Milliseconds since a moment, which becomes now.
double SpatialRenderer::Data::finish(std::chrono::steady_clock::time_point& since) const {
    if (measuring) glFinish();
    const auto now = std::chrono::steady_clock::now();
    const double took = std::chrono::duration<double, std::milli>(now - since).count();
    since = now;
    return took;
}

void SpatialRenderer::Data::beginFrame(const ShowFrame& next) {
    check(next);
    auto since = std::chrono::steady_clock::now();
    device.update(next);
    frame = next;
    times = {};
    times.upload = finish(since);
    pass.prepare(next);
    times.shadow = finish(since);
}

void SpatialRenderer::Data::drawEye(const glm::vec3& from) {
    auto since = std::chrono::steady_clock::now();
    eyeShown = false;
    tableShown = false;
    tableAreas.clear();
    eyeProblem.clear();
    if (!eye) eye.emplace(eyeSize);
    try {
        eye->draw(pass, *frame, deviceView(*frame, from, eyeSize), EyeView::Use::deviceAndTable, device, depthProgram);
        eyeShown = true;
    } catch (const InvalidInput& error) { // too close to the device, or among it
        eyeProblem = error.what();
    }
    times.eye = finish(since);
}

void SpatialRenderer::Data::drawTableView(const glm::vec3& from) {
    auto since = std::chrono::steady_clock::now();
    tableAreas = lookupAreas(*frame, from);
    const auto camera = tableLookup(*frame, from, tableAreas, eye->camera(), glm::max(eyeSize / 2, 1),
                                    table ? table->picture().size() : glm::ivec2(0));
    if (!camera) return;
    if (!table || table->picture().size() != camera->size) table.emplace(camera->size);
    table->draw(pass, *frame, *camera, EyeView::Use::tableAlone, device, depthProgram);
    tableShown = true;
    times.eye += finish(since);
}

void SpatialRenderer::Data::fitProjectors() {
    const auto& wanted = frame->installation->projectors;
    projectors.resize(wanted.size());
    const glm::vec3 floor = blackFloor(*frame->installation);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (!wanted[i].enabled) {
            projectors[i].reset();
            continue;
        }
        checkCamera(wanted[i].camera);
        if (!projectors[i] || projectors[i]->sent.size() != wanted[i].camera.size) projectors[i].emplace(wanted[i]);
        projectors[i]->become(wanted[i], floor);
    }
}

std::vector<ProjectorTarget*> SpatialRenderer::Data::enabled() {
    std::vector<ProjectorTarget*> targets;
    for (auto& target : projectors)
        if (target) targets.push_back(&*target);
    return targets;
}

std::vector<const ProjectorTarget*> SpatialRenderer::Data::lit() const {
    std::vector<const ProjectorTarget*> targets;
    for (const auto& target : projectors)
        if (target) targets.push_back(&*target);
    return targets;
}

EyeViews SpatialRenderer::Data::lookups() const {
    EyeViews views;
    if (!frame->eye || !eyeShown || !lookupProblem.empty()) return views;
    views.device = &*eye;
    if (tableShown) views.table = &*table;
    views.tableAreas = tableAreas;
    return views;
}

void SpatialRenderer::Data::drawProjectors() {
    auto since = std::chrono::steady_clock::now();
    while (!drawProjectors(lookups(), sharingProblem.empty() && enabled().size() > 1))
        for (ProjectorTarget* target : enabled()) target->changes = {}; // what was drawn before is of another kind
    times.projectors = finish(since);
}

bool SpatialRenderer::Data::drawProjectors(const EyeViews& views, bool shared) {
    const std::vector<ProjectorTarget*> targets = enabled();
    const auto lookUp = [&](const auto& draw) {
        return granted(lookupProblem, "projectors show what does not depend on the viewer", draw);
    };
    for (ProjectorTarget* target : targets) {
        const CalibratedCamera& camera = target->projector.camera;
        if (!shared) target->blend.reset();
        target->region = target->changes.begin(*frame, camera, views.tableAreas);
        // Weights of several projectors change far beyond what moves.
        if (shared) target->region = PixelRegion({glm::ivec2(0), camera.size});
        if (target->region.empty()) continue;
        if (!lookUp([&] { projectorPass.drawDepth(*target, *frame, device, views, shared); })) return false;
    }
    const auto weigh = [&] { projectorPass.drawWeights(targets, *frame, device); };
    if (shared && !granted(sharingProblem, "projectors do not share, and are too bright where they meet", weigh))
        return false;
    for (ProjectorTarget* target : targets) {
        if (!target->region.empty()) {
            if (!lookUp([&] { projectorPass.drawSeen(*target, *frame, device, views); })) return false;
            pass.drawUnseen(*frame, unseenPlaces(*target, *frame->installation));
            if (measuring) glFinish();
            auto since = std::chrono::steady_clock::now();
            const auto mix = [&] { projectorPass.drawMixed(*target, *frame, views); };
            if (mixedProblem.empty() && !granted(mixedProblem, "thin lines stay along folds and outlines", mix))
                return false;
            times.mixed += finish(since);
        }
        if (!shared) target->changes.finish(*frame);
    }
    return true;
}

SpatialRenderer::SpatialRenderer() : data_(std::make_unique<Data>()) {}
SpatialRenderer::~SpatialRenderer() = default;
SpatialRenderer::SpatialRenderer(SpatialRenderer&&) noexcept = default;
SpatialRenderer& SpatialRenderer::operator=(SpatialRenderer&&) noexcept = default;

void SpatialRenderer::setEyeSize(glm::ivec2 size) {
    if (size == data_->eyeSize) return;
    data_->eyeSize = checkedTextureSize(size);
    data_->eye.reset();
    data_->table.reset();
    data_->eyeShown = false;
}

void SpatialRenderer::setMeasuring(bool on) { data_->measuring = on; }

void SpatialRenderer::drawEye(const ShowFrame& frame) {
    auto since = std::chrono::steady_clock::now();
    const StateKeeper keeper;
    data_->beginFrame(frame);
    data_->drawEye(frame.eye.value_or(frame.installation->eye));
    data_->times.total = data_->finish(since);
}

void SpatialRenderer::draw(const ShowFrame& frame) {
    auto since = std::chrono::steady_clock::now();
    const StateKeeper keeper;
    data_->beginFrame(frame);
    data_->fitProjectors();
    const glm::vec3 from = frame.eye.value_or(frame.installation->eye);
    data_->drawEye(from);
    if (frame.eye && data_->eyeShown && !data_->enabled().empty()) data_->drawTableView(from);
    data_->drawProjectors();
    data_->times.total = data_->finish(since);
}

void SpatialRenderer::showEye(unsigned framebuffer) {
    if (!data_->eye) throw InvalidInput("eye picture", "no frame has been drawn yet", "draw one first");
    const StateKeeper keeper;
    data_->out.draw(framebuffer, data_->eye->picture());
}

unsigned SpatialRenderer::projectorTexture(std::size_t projector) const {
    const auto& targets = data_->projectors;
    return projector < targets.size() && targets[projector] ? targets[projector]->sent.texture() : 0;
}

void SpatialRenderer::drawLab(unsigned framebuffer, const CalibratedCamera& observer, float roomLight) {
    if (!data_->frame) throw InvalidInput("lab", "no frame has been drawn yet", "draw one first");
    checkCamera(observer);
    const StateKeeper keeper;
    data_->lab.draw(framebuffer, observer, roomLight, *data_->frame, data_->device, data_->lit(), data_->out);
}

void SpatialRenderer::drawBare(unsigned framebuffer, const CalibratedCamera& observer) {
    if (!data_->frame) throw InvalidInput("device", "no frame has been drawn yet", "draw one first");
    checkCamera(observer);
    const StateKeeper keeper;
    data_->lab.draw(framebuffer, observer, kWorkRoom, *data_->frame, data_->device, {}, data_->out);
}

Image SpatialRenderer::readEye() {
    const ColorTarget target(data_->eyeSize);
    showEye(target.framebuffer());
    return target.read();
}

Image SpatialRenderer::readProjector(std::size_t projector) const {
    if (projectorTexture(projector) == 0)
        throw InvalidInput("projector " + std::to_string(projector), "it has no picture", "enable it and draw a frame");
    return data_->projectors[projector]->sent.read();
}

Image SpatialRenderer::readLab(const CalibratedCamera& observer, float roomLight) {
    const ColorTarget target(observer.size);
    drawLab(target.framebuffer(), observer, roomLight);
    return target.read();
}

Image SpatialRenderer::readBare(const CalibratedCamera& observer) {
    const ColorTarget target(observer.size);
    drawBare(target.framebuffer(), observer);
    return target.read();
}

Image SpatialRenderer::readMask() {
    if (!data_->eyeShown) throw InvalidInput("mask", "no picture for an eye has been drawn", "draw a frame first");
    const ColorTarget target(data_->eyeSize);
    const StateKeeper keeper;
    data_->lab.drawMask(target.framebuffer(), data_->eye->camera(), *data_->frame, data_->device, data_->lit());
    return target.read();
}

SpatialTimes SpatialRenderer::times() const { return data_->times; }

std::vector<std::string> SpatialRenderer::warnings() const {
    std::vector<std::string> warnings = data_->pass.warnings();
    for (const std::string& problem : {data_->eyeProblem, data_->lookupProblem, data_->sharingProblem,
                                       data_->mixedProblem, data_->lab.problem(), data_->out.problem()})
        if (!problem.empty()) warnings.push_back(problem);
    return warnings;
}

std::size_t SpatialRenderer::objectCount() const noexcept {
    std::size_t count = data_->pass.objectCount() + data_->projectorPass.objectCount() + data_->lab.objectCount() +
                        data_->out.objectCount() + data_->depthProgram.objectCount() + DeviceSurface::kObjects;
    for (const auto* view : {&data_->eye, &data_->table}) count += *view ? EyeView::kObjects : 0;
    for (const auto& target : data_->projectors) count += target ? target->objectCount() : 0;
    return count;
}

} // namespace lumorph
