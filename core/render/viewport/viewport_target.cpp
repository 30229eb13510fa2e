#include "core/render/viewport/viewport_target.h"

#include "core/base/error.h"

namespace lumorph {
namespace {

constexpr int kSamples = 4;

void requireComplete() {
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return;
    throw DeviceError("OpenGL", "the driver cannot hold a frame of this size", "use a smaller size");
}

void attach(GLenum attachment, const gl::Renderbuffer& buffer, GLenum format, glm::ivec2 size, int samples) {
    glBindRenderbuffer(GL_RENDERBUFFER, buffer.name());
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, size.x, size.y);
    glBindRenderbuffer(GL_RENDERBUFFER, 0);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer.name());
}

// Alpha is 1 but where an outlined surface marks it.
void clear() {
    glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void copy(GLuint from, GLuint to, glm::ivec2 size) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, from);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to);
    glBlitFramebuffer(0, 0, size.x, size.y, 0, 0, size.x, size.y, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

} // namespace

bool ViewportTarget::resize(glm::ivec2 size) {
    if (whole_ && size == size_) return false;
    moving_.reset();
    whole_.reset();
    whole_.emplace();
    size_ = size;
    glBindTexture(GL_TEXTURE_2D, whole_->color.name());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size.x, size.y, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, whole_->framebuffer.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, whole_->color.name(), 0);
    requireComplete();
    return true;
}

void ViewportTarget::beginBackground() {
    if (!moving_) {
        moving_.emplace();
        glBindFramebuffer(GL_FRAMEBUFFER, moving_->framebuffer.name());
        attach(GL_COLOR_ATTACHMENT0, moving_->background, GL_RGBA8, size_, 0);
        requireComplete();
        glBindFramebuffer(GL_FRAMEBUFFER, whole_->framebuffer.name());
        attach(GL_DEPTH_ATTACHMENT, moving_->depth, GL_DEPTH_COMPONENT24, size_, 0);
        requireComplete();
    }
    glBindFramebuffer(GL_FRAMEBUFFER, moving_->framebuffer.name());
    glViewport(0, 0, size_.x, size_.y);
}

void ViewportTarget::beginWhole() {
    copy(moving_->framebuffer.name(), whole_->framebuffer.name(), size_);
    glBindFramebuffer(GL_FRAMEBUFFER, whole_->framebuffer.name());
    glViewport(0, 0, size_.x, size_.y);
    glClear(GL_DEPTH_BUFFER_BIT);
}

void ViewportTarget::beginPiece(const FramePiece& piece) {
    if (!piece_) {
        piece_.emplace();
        glBindFramebuffer(GL_FRAMEBUFFER, piece_->framebuffer.name());
        attach(GL_COLOR_ATTACHMENT0, piece_->color, GL_RGBA8, kPiece, kSamples);
        attach(GL_DEPTH_ATTACHMENT, piece_->depth, GL_DEPTH_COMPONENT24, kPiece, kSamples);
        requireComplete();
    }
    glBindFramebuffer(GL_FRAMEBUFFER, piece_->framebuffer.name());
    glViewport(-piece.origin.x, -piece.origin.y, size_.x, size_.y);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, piece.size.x, piece.size.y);
    clear();
}

void ViewportTarget::endPiece(const FramePiece& piece) {
    glDisable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, piece_->framebuffer.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, whole_->framebuffer.name());
    const glm::ivec2 end = piece.origin + piece.size;
    glBlitFramebuffer(0, 0, piece.size.x, piece.size.y, piece.origin.x, piece.origin.y, end.x, end.y,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void ViewportTarget::copyTo(GLuint framebuffer) const {
    copy(whole_->framebuffer.name(), framebuffer, size_);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, size_.x, size_.y);
}

std::size_t ViewportTarget::objectCount() const noexcept {
    return (whole_ ? 2U : 0U) + (moving_ ? 3U : 0U) + (piece_ ? 3U : 0U);
}

} // namespace lumorph
