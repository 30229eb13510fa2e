#include "core/render/gl/gl_objects.h"

#include "app/studio/rendering/frame_drawer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "app/studio/rendering/frame_reader.h"
#include "core/base/error.h"

namespace lumorph::studio {
namespace {

using Clock = std::chrono::steady_clock;

QSize drawnSize(const FrameSchedule::Work& work) {
    const auto side = [&](int pixels) { return std::max(1, static_cast<int>(std::lround(pixels * work.resolution))); };
    return {side(work.request.pixels.width()), side(work.request.pixels.height())};
}

QImage toQImage(const Image& image) {
    const glm::ivec2 size = image.size();
    const QImage seen(reinterpret_cast<const uchar*>(image.pixels().data()), size.x, size.y,
                      4 * static_cast<qsizetype>(size.x), QImage::Format_RGBX8888);
    return seen.convertToFormat(QImage::Format_RGB32);
}

} // namespace

struct FrameDrawer::Data {
    struct Viewport {
        Viewport(ReadBack way, ImagePool& pool) : reader(way, pool) {}
        FrameReader reader;
        FrameSchedule::Work work; ///< of the frame that is on its way
        Clock::time_point begun;
    };

    void collect(Viewport& viewport) {
        if (!viewport.reader.started()) return;
        DrawnFrame frame;
        frame.image = viewport.reader.collect();
        frame.scene = viewport.work.request.scene;
        frame.camera = viewport.work.request.camera;
        frame.still = viewport.work.quality == ViewportQuality::still;
        frame.resolution = viewport.work.resolution;
        // Frames overlap on a graphics card: what counts is how long this one kept the next from coming.
        const auto now = Clock::now();
        const auto from = std::max(viewport.begun, delivered);
        frame.milliseconds = std::chrono::duration<double, std::milli>(now - from).count();
        delivered = now;
        deliver(viewport.work, std::move(frame));
    }
    void collectAll() {
        for (auto& [number, viewport] : viewports) collect(viewport);
    }

    ReadBack way = ReadBack::direct;
    Deliver deliver;
    ImagePool pool;
    ViewportRenderer renderer;
    std::map<int, Viewport> viewports;
    Clock::time_point delivered;
};

FrameDrawer::FrameDrawer(const GlDriver& driver, Deliver deliver) : data_(std::make_unique<Data>()) {
    data_->way = driver.software ? ReadBack::direct : ReadBack::buffered;
    data_->deliver = std::move(deliver);
}
FrameDrawer::~FrameDrawer() = default;

bool FrameDrawer::draw(const FrameSchedule::Work& work, const std::function<bool()>& interrupted) {
    const auto begun = Clock::now();
    Data::Viewport& viewport = data_->viewports.try_emplace(work.viewport, data_->way, data_->pool).first->second;
    const FrameRequest& wanted = work.request;
    const QSize size = drawnSize(work);
    const unsigned framebuffer = viewport.reader.framebuffer(size);
    const bool complete =
        data_->renderer.draw(framebuffer, {size.width(), size.height()}, *wanted.scene, wanted.camera, work.quality,
                             static_cast<float>(wanted.scale * work.resolution), interrupted);
    data_->collectAll();
    if (!complete) return false;
    viewport.work = work;
    viewport.begun = begun;
    viewport.reader.start(wanted.pixels);
    if (data_->way == ReadBack::direct) data_->collect(viewport);
    return true;
}

void FrameDrawer::collect() { data_->collectAll(); }

void FrameDrawer::forget(int viewport) { data_->viewports.erase(viewport); }

QImage FrameDrawer::picture(const FrameRequest& request) {
    data_->collectAll();
    return toQImage(renderViewport(data_->renderer, *request.scene, request.camera,
                                   {request.pixels.width(), request.pixels.height()}));
}

std::size_t FrameDrawer::objectCount() const {
    std::size_t count = data_->renderer.objectCount();
    for (const auto& [number, viewport] : data_->viewports) count += viewport.reader.objectCount();
    return count;
}

std::size_t FrameDrawer::takeErrors() {
    std::size_t count = 0;
    // A lost context reports errors without end.
    while (count < 100 && glGetError() != GL_NO_ERROR) ++count;
    return count;
}

} // namespace lumorph::studio
