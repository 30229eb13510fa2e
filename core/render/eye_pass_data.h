#pragma once

#include <string>

#include "core/render/camera_uniforms.h"
#include "core/render/eye_fog.h"
#include "core/render/eye_lighting.h"
#include "core/render/eye_materials.h"
#include "core/render/eye_pass.h"
#include "core/render/eye_programs.h"
#include "core/render/eye_shadow.h"
#include "core/render/eye_surfaces.h"
#include "core/render/lookup_region.h"
#include "core/render/projector_target.h"
#include "core/render/table_grid.h"

namespace lumorph {

/// What the pass keeps, and its steps; `Thing` and `View` are those of one frame.
struct EyePass::Data {
    /// One thing to draw: a mesh, where it stands, and what it looks like.
    struct Thing {
        const EyeMesh* mesh = nullptr; ///< none: the table
        glm::mat4 world{1.0F};
        const Material* material = nullptr;
        float opacity = 1.0F;
        std::uint32_t features = 0;
        float distance = 0.0F;
        bool skin = false;
        std::uint64_t version = 0; ///< of its shape
        bool inTheOpen = false;    ///< no shadow reaches what is drawn of it
    };

    /// Where a frame is drawn to.
    struct View {
        const CalibratedCamera* camera = nullptr;
        DepthRange depth;
        PixelRegion region;                      ///< all that is drawn
        const ProjectorTarget* target = nullptr; ///< of a projector that sends it, to places that no eye sees

        [[nodiscard]] bool unseen() const noexcept { return target != nullptr; }
        [[nodiscard]] std::uint32_t features() const noexcept;
        void apply(Program& program, const ShowFrame& frame, PhysicalSurface surface) const;
    };

    EyePrograms programs;
    EyeMaterials materials;
    EyeSurfaces surfaces;
    EyeShadow shadow;
    EyeLighting lighting;
    EyeFog fog;
    TableGrid table;
    std::string shadowProblem; ///< of a driver that cannot compile what shadows need

    [[nodiscard]] bool showsSkin(const ShowFrame& frame) const;
    [[nodiscard]] std::vector<Thing> shadowThings(const ShowFrame& frame) const;
    void drawShadow(const ShowFrame& frame);
    void drawCaster(const ShowFrame& frame, const Thing& thing, const glm::mat4& clipFromWorld);
    [[nodiscard]] Thing skinThing(const ShowFrame& frame, bool unseen) const;
    [[nodiscard]] std::vector<Thing> itemThings(const ShowFrame& frame, const glm::vec3& eye) const;
    void begin(const ShowFrame& frame, const View& view, unsigned framebuffer) const;
    void draw(const ShowFrame& frame, const View& view, const Thing& thing);
    void draw(const ShowFrame& frame, const View& view, const Thing& thing, std::span<const PixelRectangle> parts);
    [[nodiscard]] PixelRectangle shadowedPixels(const ShowFrame& frame, const View& view) const;
    void drawTable(const ShowFrame& frame, const View& view);
    void drawCreases(const ShowFrame& frame, const View& view);
    void drawBlended(const ShowFrame& frame, const View& view, std::vector<Thing> things);
    void drawSeen(const ShowFrame& frame, const CalibratedCamera& camera, unsigned framebuffer, bool withSkin);
    [[nodiscard]] Box everything(const ShowFrame& frame) const;
};

} // namespace lumorph
