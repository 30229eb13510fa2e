#pragma once

#include <memory>

#include <QImage>
#include <QSize>

namespace lumorph::studio {

/// Images whose memory is used again once the last copy is gone, so that a stream of frames allocates nothing. Images
/// may outlive the pool and die in any thread.
class ImagePool {
public:
    ImagePool();
    ~ImagePool();

    /// An RGB32 image of undefined content. Throws DeviceError when there is no memory.
    [[nodiscard]] QImage take(QSize size);
    /// Buffers that were ever allocated, for tests.
    [[nodiscard]] std::size_t allocations() const;

private:
    struct Data;
    std::shared_ptr<Data> data_;
};

} // namespace lumorph::studio
