#pragma once

#include <optional>

#include <QImage>
#include <QSize>

#include "app/studio/rendering/image_pool.h"
#include "core/render/gl/gl_objects.h"

namespace lumorph::studio {

/// How a frame leaves OpenGL: at once, as software drivers like it, or through a pixel buffer that is looked at after
/// the next frame has been handed to the driver.
enum class ReadBack { direct, buffered };

/// The frame of one viewport in the current OpenGL context: a framebuffer to draw into, scaled to the size wanted while
/// it is read. Objects are made again only when a size changes. Throws DeviceError when the driver has no memory.
class FrameReader {
public:
    FrameReader(ReadBack way, ImagePool& pool) : way_(way), pool_(pool) {}
    ~FrameReader();
    FrameReader(const FrameReader&) = delete;
    FrameReader& operator=(const FrameReader&) = delete;

    /// A framebuffer with colour to draw into.
    [[nodiscard]] unsigned framebuffer(QSize drawn);
    /// Begins to read what was drawn, as a picture of `pixels`. The picture before it must have been collected.
    void start(QSize pixels);
    [[nodiscard]] bool started() const noexcept { return started_; }
    /// Waits for the picture that was started; row 0 is the top.
    [[nodiscard]] QImage collect();

    [[nodiscard]] std::size_t objectCount() const noexcept;

private:
    struct Surface {
        explicit Surface(QSize wanted);
        QSize size;
        gl::Texture color;
        gl::Framebuffer framebuffer;
    };
    void scaleInto(QSize pixels);
    void readDirectly(QSize pixels, bool upsideDown);
    void readIntoBuffer(QSize pixels);

    ReadBack way_;
    ImagePool& pool_;
    std::optional<Surface> drawn_;
    std::optional<Surface> scaled_;
    std::optional<gl::Buffer> buffer_;
    QSize bufferSize_;
    void* fence_ = nullptr; ///< GLsync
    QImage picture_;
    bool started_ = false;
};

} // namespace lumorph::studio
