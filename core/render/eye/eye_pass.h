#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "core/geometry/calibrated_camera.h"
#include "core/render/gl/pixel_region.h"
#include "core/render/gl/program.h"
#include "core/scene/show_frame.h"

namespace lumorph {

/// The bare device or table on which light falls.
enum class PhysicalSurface { device, table };

/// Places of a projector's picture that no eye sees, and how what is drawn there becomes what the projector sends.
struct UnseenPlaces {
    const CalibratedCamera& camera; ///< the projector's
    const PixelRegion& region;      ///< what of its picture is drawn
    PixelRectangle device;          ///< holds the device as it is
    unsigned framebuffer = 0;       ///< its depth hides all that is drawn already
    std::uint32_t features = 0;     ///< of eye_feature, for its output
    /// Sets the uniforms of its output in the current program; may bind three textures, to this unit and the next ones.
    std::function<void(Program& program, PhysicalSurface surface, int unit)> setOutput;
};

/// Draws the virtual scene: the device's skin, the table and all items, lit, shadowed, in fog, with holes. Keeps
/// programs, buffers and textures between frames.
class EyePass {
public:
    EyePass();
    ~EyePass();
    EyePass(EyePass&&) noexcept;
    EyePass& operator=(EyePass&&) noexcept;

    /// Uploads what changed since the last frame and draws the shadow map. Before the two below.
    void prepare(const ShowFrame& frame);

    /// The picture that the eye should see, through an undistorted camera, into a framebuffer of the camera's size with
    /// depth: linear light in [0, 1] after tone mapping (a format of at least 16 bits, or sRGB encoded by the
    /// framebuffer with GL_FRAMEBUFFER_SRGB); alpha is 1. All of the frame is filled.
    void draw(const ShowFrame& frame, const CalibratedCamera& camera, unsigned framebuffer);

    /// The same without the device's skin, for places that the device does not hide.
    void drawBesideDevice(const ShowFrame& frame, const CalibratedCamera& camera, unsigned framebuffer);

    /// Device and table alone as they are, physically, shaded by what does not depend on a viewer: their materials in
    /// diffuse light with shadows, without reflection, refraction, holes and items above them. For places that no eye
    /// sees; as a projector sends it, to those within its area that are not done.
    void drawUnseen(const ShowFrame& frame, const UnseenPlaces& places);

    /// Programs this driver refused, with file and line, and the plain one that stands in for them.
    [[nodiscard]] std::vector<std::string> warnings() const;
    [[nodiscard]] std::size_t objectCount() const noexcept;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
