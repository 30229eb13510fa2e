#include "app/studio/rendering/frame_reader.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "core/base/error.h"

namespace lumorph::studio {
namespace {

constexpr GLuint64 kPatience = 2'000'000'000; // nanoseconds for a frame that is on its way

DeviceError noMemory() { return {"OpenGL", "the driver cannot hold a frame of this size", "make the window smaller"}; }

void turnOver(QImage& picture) {
    const auto stride = static_cast<std::size_t>(picture.bytesPerLine());
    std::vector<uchar> row(stride);
    // Through bits() once: scanLine() would look for other owners at every row.
    uchar* const bits = picture.bits();
    for (int low = 0, high = picture.height() - 1; low < high; ++low, --high) {
        uchar* const a = bits + stride * static_cast<std::size_t>(low);
        uchar* const b = bits + stride * static_cast<std::size_t>(high);
        std::memcpy(row.data(), a, stride);
        std::memcpy(a, b, stride);
        std::memcpy(b, row.data(), stride);
    }
}

} // namespace

FrameReader::Surface::Surface(QSize wanted) : size(wanted) {
    glBindTexture(GL_TEXTURE_2D, color.name());
    // The order of the bytes in a QImage: drivers that heed it need not swap them when the frame is read.
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size.width(), size.height(), 0, GL_BGRA, GL_UNSIGNED_INT_8_8_8_8_REV,
                 nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color.name(), 0);
    const bool complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (!complete) throw noMemory();
}

FrameReader::~FrameReader() {
    if (fence_) glDeleteSync(static_cast<GLsync>(fence_));
}

unsigned FrameReader::framebuffer(QSize drawn) {
    if (!drawn_ || drawn_->size != drawn) {
        drawn_.reset();
        drawn_.emplace(drawn);
    }
    return drawn_->framebuffer.name();
}

void FrameReader::start(QSize pixels) {
    started_ = true;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, drawn_->framebuffer.name());
    // OpenGL's row 0 is the lowest. Drawing it upside down costs a graphics card nothing; the processor rather swaps
    // the rows itself.
    const bool scale = way_ == ReadBack::buffered || drawn_->size != pixels;
    if (scale)
        scaleInto(pixels);
    else
        scaled_.reset();
    if (way_ == ReadBack::buffered)
        readIntoBuffer(pixels);
    else
        readDirectly(pixels, !scale);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void FrameReader::scaleInto(QSize pixels) {
    if (!scaled_ || scaled_->size != pixels) {
        scaled_.reset();
        scaled_.emplace(pixels);
    }
    glBindFramebuffer(GL_READ_FRAMEBUFFER, drawn_->framebuffer.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, scaled_->framebuffer.name());
    glBlitFramebuffer(0, 0, drawn_->size.width(), drawn_->size.height(), 0, pixels.height(), pixels.width(), 0,
                      GL_COLOR_BUFFER_BIT, drawn_->size == pixels ? GL_NEAREST : GL_LINEAR);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, scaled_->framebuffer.name());
}

void FrameReader::readDirectly(QSize pixels, bool upsideDown) {
    picture_ = pool_.take(pixels);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, pixels.width(), pixels.height(), GL_BGRA, GL_UNSIGNED_INT_8_8_8_8_REV, picture_.bits());
    if (upsideDown) turnOver(picture_);
}

void FrameReader::readIntoBuffer(QSize pixels) {
    const auto bytes = 4 * static_cast<GLsizeiptr>(pixels.width()) * pixels.height();
    if (!buffer_) buffer_.emplace();
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer_->name());
    if (bufferSize_ != pixels) glBufferData(GL_PIXEL_PACK_BUFFER, bytes, nullptr, GL_STREAM_READ);
    bufferSize_ = pixels;
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, pixels.width(), pixels.height(), GL_BGRA, GL_UNSIGNED_INT_8_8_8_8_REV, nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    if (fence_) glDeleteSync(static_cast<GLsync>(fence_)); // of a frame that nobody collected
    fence_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glFlush();
}

QImage FrameReader::collect() {
    started_ = false;
    if (way_ == ReadBack::direct) return std::exchange(picture_, {});
    const GLenum waited = glClientWaitSync(static_cast<GLsync>(fence_), GL_SYNC_FLUSH_COMMANDS_BIT, kPatience);
    glDeleteSync(static_cast<GLsync>(fence_));
    fence_ = nullptr;
    if (waited == GL_WAIT_FAILED) throw DeviceError("OpenGL", "the driver lost a frame", "draw it again");
    QImage picture = pool_.take(bufferSize_);
    const auto bytes = static_cast<GLsizeiptr>(picture.sizeInBytes());
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer_->name());
    if (const void* mapped = glMapBufferRange(GL_PIXEL_PACK_BUFFER, 0, bytes, GL_MAP_READ_BIT))
        std::memcpy(picture.bits(), mapped, static_cast<std::size_t>(bytes));
    else
        picture.fill(Qt::black);
    glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    return picture;
}

std::size_t FrameReader::objectCount() const noexcept {
    return (drawn_ ? 2U : 0U) + (scaled_ ? 2U : 0U) + (buffer_ ? 1U : 0U);
}

} // namespace lumorph::studio
