#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "core/render/projector/picture_output.h"
#include "core/render/projector/projector_target.h"

namespace lumorph {

/// What an observer sees of device and table in the projectors' light, and of the hands that keep it from them.
class LabPreview {
public:
    LabPreview();

    /// Into a framebuffer of the observer's size, sRGB encoded by it or, if it does not encode, by this. Where the
    /// driver refuses a program of light, a bright device on a dark table (black, if that is refused too), and
    /// `problem`.
    void draw(GLuint framebuffer, const CalibratedCamera& observer, float room, const ShowFrame& frame,
              const DeviceSurface& device, std::span<const ProjectorTarget* const> projectors, PictureOutput& out);
    /// White where a projector reaches what the observer sees. Throws DataError where the driver refuses the program:
    /// what stood in for it would be wrong.
    void drawMask(GLuint framebuffer, const CalibratedCamera& observer, const ShowFrame& frame,
                  const DeviceSurface& device, std::span<const ProjectorTarget* const> projectors);

    /// Empty, or what the driver refuses, with file and line, and what stands in for it.
    [[nodiscard]] const std::string& problem() const noexcept { return problem_; }
    [[nodiscard]] std::size_t objectCount() const noexcept;

private:
    struct Observer {
        const CalibratedCamera& camera;
        DepthRange range;
        const Installation& installation;
        std::span<const Capsule> hands;
        float room = 0.0F; ///< light of it
    };
    /// Programs of one kind of light, on device and table.
    struct Light {
        Program device, table;
    };
    void drawSurfaces(const Observer& observer, const DeviceSurface& device, float onDevice, float onTable);
    void drawWith(Light& light, const Observer& observer, const DeviceSurface& device,
                  const std::function<void(Program&)>& set);
    void drawRoom(const Observer& observer, const DeviceSurface& device, bool showing);
    void drawFullFrame(Program& program, const Observer& observer);
    void drawLit(const Observer& observer, const DeviceSurface& device,
                 std::span<const ProjectorTarget* const> projectors);
    void drawStandIn(const Observer& observer, const DeviceSurface& device);
    void addLight(const Observer& observer, const DeviceSurface& device,
                  std::span<const ProjectorTarget* const> projectors);
    void addProjector(const Observer& observer, const DeviceSurface& device, const ProjectorTarget& projector,
                      Light& light);

    TableGrid table_;
    std::optional<ColorTarget> radiance_;
    gl::VertexArray noAttributes_;
    Program flat_, room_, hands_;
    Light roomLight_, light_, measuredLight_, mask_;
    std::string problem_;
    bool standInRefused_ = false;
};

} // namespace lumorph
