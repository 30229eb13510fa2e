#pragma once

#include <optional>
#include <span>

#include "core/render/picture_output.h"
#include "core/render/projector_target.h"

namespace lumorph {

/// What an observer sees of device and table in the projectors' light.
class LabPreview {
public:
    LabPreview();

    /// Into a framebuffer of the observer's size, sRGB encoded by it or, if it does not encode, by this.
    void draw(GLuint framebuffer, const CalibratedCamera& observer, float ambient, const ShowFrame& frame,
              const DeviceSurface& device, std::span<const ProjectorTarget* const> projectors, PictureOutput& out);
    /// White where a projector reaches what the observer sees.
    void drawMask(GLuint framebuffer, const CalibratedCamera& observer, const ShowFrame& frame,
                  const DeviceSurface& device, std::span<const ProjectorTarget* const> projectors);

    [[nodiscard]] std::size_t objectCount() const noexcept;

private:
    struct Observer {
        const CalibratedCamera& camera;
        DepthRange range;
        const Scene& scene;
    };
    void drawSurfaces(const Observer& observer, const DeviceSurface& device, float flat);
    void addProjector(const Observer& observer, const DeviceSurface& device, const ProjectorTarget& projector,
                      Program& deviceProgram, Program& tableProgram);

    TableGrid table_;
    std::optional<ColorTarget> radiance_;
    Program flat_, deviceLight_, tableLight_, deviceMask_, tableMask_;
};

} // namespace lumorph
