#include "app/studio/rendering/image_pool.h"

#include <mutex>
#include <new>
#include <vector>

#include "core/base/error.h"

namespace lumorph::studio {

struct ImagePool::Data {
    struct Buffer {
        std::unique_ptr<uchar[]> bytes;
        std::size_t size = 0;
    };
    // What an image carries to bring its buffer home.
    struct Loan {
        std::shared_ptr<Data> home;
        Buffer buffer;
    };

    static constexpr std::size_t kKept = 8;

    Buffer fetch(std::size_t size) {
        const std::lock_guard lock(mutex);
        for (auto& buffer : free)
            if (buffer.size == size) {
                Buffer taken = std::move(buffer);
                buffer = std::move(free.back());
                free.pop_back();
                return taken;
            }
        ++allocations;
        return {std::make_unique_for_overwrite<uchar[]>(size), size};
    }

    static void bringBack(void* what) {
        const std::unique_ptr<Loan> loan(static_cast<Loan*>(what));
        const std::lock_guard lock(loan->home->mutex);
        auto& free = loan->home->free;
        // The oldest go first: sizes that are no longer asked for.
        if (free.size() >= kKept) free.erase(free.begin());
        free.push_back(std::move(loan->buffer));
    }

    mutable std::mutex mutex;
    std::vector<Buffer> free;
    std::size_t allocations = 0;
};

ImagePool::ImagePool() : data_(std::make_shared<Data>()) {}
ImagePool::~ImagePool() = default;

QImage ImagePool::take(QSize size) {
    const auto stride = 4 * static_cast<qsizetype>(size.width());
    try {
        auto loan = std::make_unique<Data::Loan>(
            Data::Loan{data_, data_->fetch(static_cast<std::size_t>(stride * size.height()))});
        uchar* const bytes = loan->buffer.bytes.get();
        return {bytes, size.width(), size.height(), stride, QImage::Format_RGB32, &Data::bringBack, loan.release()};
    } catch (const std::bad_alloc&) {
        throw DeviceError("picture", "there is no memory for it", "choose a smaller size");
    }
}

std::size_t ImagePool::allocations() const {
    const std::lock_guard lock(data_->mutex);
    return data_->allocations;
}

} // namespace lumorph::studio
