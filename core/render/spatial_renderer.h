#pragma once

#include <memory>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "core/base/image.h"
#include "core/geometry/calibrated_camera.h"
#include "core/scene/show_frame.h"

namespace lumorph {

/// Milliseconds of the passes of the last frame, on the CPU's clock up to the end of the drawing (`glFinish`) where
/// measuring is on.
struct SpatialTimes {
    double upload = 0.0, shadow = 0.0, eye = 0.0, projectors = 0.0, total = 0.0;
    double mixed = 0.0; ///< within `projectors`: of pixels that lie on several surfaces
};

/// Light of a room, as radiance of white that faces up: dim enough for projectors, and to work in.
constexpr float kDimRoom = 0.035F, kWorkRoom = 0.6F;

/// The two passes of spatial augmented reality (R26-R35) in the current OpenGL 4.1 context: what the eye should see,
/// and what each projector sends out so that it does. Everything it holds dies with it, the same context being current.
class SpatialRenderer {
public:
    SpatialRenderer();
    ~SpatialRenderer();
    SpatialRenderer(SpatialRenderer&&) noexcept;
    SpatialRenderer& operator=(SpatialRenderer&&) noexcept;

    /// Pixels of the eye pass, 1280 x 800 at first.
    void setEyeSize(glm::ivec2 size);
    /// `glFinish` between the passes, so that `times` are true ones.
    void setMeasuring(bool on);

    /// Uploads what changed and draws shadow map, eye pass and all enabled projectors. Afterwards the others below show
    /// this frame.
    void draw(const ShowFrame& frame);
    /// The same without projectors, for a preview of the eye alone.
    void drawEye(const ShowFrame& frame);

    /// Draws what the eye should see in the last frame into a framebuffer of the eye pass's size, as drawLab does.
    void showEye(unsigned framebuffer);
    /// Texture of the last frame (sRGB encoded, row 0 at the bottom as OpenGL has it), valid until the next; 0: none.
    [[nodiscard]] unsigned projectorTexture(std::size_t projector) const;

    /// Draws what an observer sees of the lit device and table into a framebuffer of the observer's size: the live form
    /// of the virtual lab. It is sRGB encoded by the framebuffer or, if that does not encode, by this. With light
    /// of the room, floor and walls are seen too; without, what no projector reaches is black, as physics says.
    void drawLab(unsigned framebuffer, const CalibratedCamera& observer, float roomLight = 0.0F);

    /// The same without the projectors' light, in a room that is lit to work in: the shape that a hand would feel.
    void drawBare(unsigned framebuffer, const CalibratedCamera& observer);

    [[nodiscard]] Image readEye();
    [[nodiscard]] Image readProjector(std::size_t projector) const;
    [[nodiscard]] Image readLab(const CalibratedCamera& observer, float roomLight = 0.0F);
    [[nodiscard]] Image readBare(const CalibratedCamera& observer);
    /// White where the surface that the eye pass's camera sees is seen by an enabled projector too. Throws DataError
    /// where the driver refuses its program.
    [[nodiscard]] Image readMask();

    [[nodiscard]] SpatialTimes times() const;
    /// Programs that this driver would not compile, with file, line and what stands in for them; empty when all is
    /// well.
    [[nodiscard]] std::vector<std::string> warnings() const;
    [[nodiscard]] std::size_t objectCount() const noexcept;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
