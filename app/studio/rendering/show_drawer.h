#pragma once

#include <functional>
#include <memory>

#include "app/studio/rendering/frame_drawer.h"
#include "app/studio/rendering/show_pace.h"

namespace lumorph::studio {

/// Draws the show in the current OpenGL context and reads its views back. As with viewports, pictures may come out of
/// it only after the next frame was begun (graphics cards), so `collect` until nothing is left. All calls in one
/// thread, the context being current, the destructor too.
class ShowDrawer {
public:
    /// `deliver` gets each frame with the work it answers; its total time says how long it kept the next from coming.
    using Deliver = std::function<void(const ShowPace::Work&, DrawnShow)>;
    ShowDrawer(const GlDriver& driver, Deliver deliver);
    ~ShowDrawer();

    /// Throws what the renderer throws; then nothing is kept of it, and the next call begins anew.
    void draw(const ShowPace::Work& work);
    /// Delivers the frame that was begun, if any.
    void collect();
    /// Gives all OpenGL objects back.
    void clear();

    [[nodiscard]] std::size_t objectCount() const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::studio
