#pragma once

#include <functional>
#include <memory>

#include <QImage>

#include "app/studio/rendering/frame_schedule.h"
#include "core/render/gl/gl_driver.h"

namespace lumorph::studio {

/// Draws frames of viewports in the current OpenGL context and reads them back. A frame may come out of it only after
/// the next one was begun (graphics cards), so `collect` until nothing is left. All calls in one thread, the context
/// being current, the destructor too.
class FrameDrawer {
public:
    /// `deliver` gets each frame with the work it answers and the milliseconds it took.
    using Deliver = std::function<void(const FrameSchedule::Work&, DrawnFrame)>;
    FrameDrawer(const GlDriver& driver, Deliver deliver);
    ~FrameDrawer();

    /// False when `interrupted` gave it up. Throws what the renderer throws.
    bool draw(const FrameSchedule::Work& work, const std::function<bool()>& interrupted);
    /// Delivers all frames that were begun.
    void collect();
    void forget(int viewport);
    [[nodiscard]] QImage picture(const FrameRequest& request);

    [[nodiscard]] std::size_t objectCount() const;
    /// OpenGL errors since the last call.
    [[nodiscard]] static std::size_t takeErrors();

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::studio
