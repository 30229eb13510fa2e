#include "core/render/spatial_renderer.h"

#include <optional>

#include "core/base/error.h"
#include "core/render/color_target.h"
#include "core/render/eye_pass.h"

namespace lumorph {

struct SpatialRenderer::Data {
    EyePass pass;
    glm::ivec2 eyeSize{1280, 800};
    std::optional<ColorTarget> eye;
    std::vector<std::optional<ColorTarget>> projectors;
    std::optional<ShowFrame> frame;
    bool measuring = false;
    SpatialTimes times;
};

SpatialRenderer::SpatialRenderer() : data_(std::make_unique<Data>()) {}
SpatialRenderer::~SpatialRenderer() = default;
SpatialRenderer::SpatialRenderer(SpatialRenderer&&) noexcept = default;
SpatialRenderer& SpatialRenderer::operator=(SpatialRenderer&&) noexcept = default;

void SpatialRenderer::setEyeSize(glm::ivec2 size) {
    data_->eyeSize = size;
    data_->eye.reset();
}

void SpatialRenderer::setMeasuring(bool on) { data_->measuring = on; }

void SpatialRenderer::drawEye(const ShowFrame& frame) {
    data_->frame = frame;
    data_->pass.prepare(frame);
    if (!data_->eye) data_->eye.emplace(data_->eyeSize);
    const glm::vec3 from = frame.eye.value_or(frame.scene->eye);
    data_->pass.draw(frame, deviceView(frame, from, data_->eyeSize), data_->eye->framebuffer());
}

void SpatialRenderer::draw(const ShowFrame& frame) {
    drawEye(frame);
    data_->projectors.resize(frame.scene->projectors.size());
    for (std::size_t i = 0; i < data_->projectors.size(); ++i) {
        auto& target = data_->projectors[i];
        const SceneProjector& projector = frame.scene->projectors[i];
        if (!projector.enabled) target.reset();
        if (!projector.enabled) continue;
        if (!target || target->size() != projector.camera.size) target.emplace(projector.camera.size);
        data_->pass.drawUnseen(frame, projector.camera, target->framebuffer());
    }
}

unsigned SpatialRenderer::eyeTexture() const { return data_->eye ? data_->eye->texture() : 0; }

unsigned SpatialRenderer::projectorTexture(std::size_t projector) const {
    const auto& targets = data_->projectors;
    return projector < targets.size() && targets[projector] ? targets[projector]->texture() : 0;
}

void SpatialRenderer::drawLab(unsigned framebuffer, const CalibratedCamera& observer, float) {
    if (data_->frame) data_->pass.drawUnseen(*data_->frame, observer, framebuffer);
}

Image SpatialRenderer::readEye() const {
    if (!data_->eye) throw InvalidInput("eye picture", "no frame has been drawn yet", "draw one first");
    return data_->eye->read();
}

Image SpatialRenderer::readProjector(std::size_t projector) const {
    if (projectorTexture(projector) == 0)
        throw InvalidInput("projector " + std::to_string(projector), "it has no picture", "enable it and draw a frame");
    return data_->projectors[projector]->read();
}

Image SpatialRenderer::readLab(const CalibratedCamera& observer, float ambient) {
    const ColorTarget target(observer.size);
    drawLab(target.framebuffer(), observer, ambient);
    return target.read();
}

Image SpatialRenderer::readMask() { return Image(data_->eyeSize); }

SpatialTimes SpatialRenderer::times() const { return data_->times; }
std::vector<std::string> SpatialRenderer::warnings() const { return data_->pass.warnings(); }

std::size_t SpatialRenderer::objectCount() const noexcept {
    std::size_t count = data_->pass.objectCount() + (data_->eye ? ColorTarget::kObjects : 0);
    for (const auto& target : data_->projectors) count += target ? ColorTarget::kObjects : 0;
    return count;
}

} // namespace lumorph
