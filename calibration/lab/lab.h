#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/image.h"
#include "core/geometry/calibrated_camera.h"
#include "core/geometry/triangle_mesh.h"
#include "core/scene/installation.h"

namespace lumorph {

/// A diffuse surface of the virtual lab, world metres. Both of its sides are seen and lit.
struct LabSurface {
    TriangleMesh mesh;
    glm::vec3 albedo{1.0F}; ///< linear
};

/// A projector of the lab with the picture it sends out.
struct LabProjector {
    InstalledProjector projector; ///< as it truly is, which need not be what calibration believes
    Image image;                  ///< of the projector's size, sRGB or its own gamma; empty: no light leaves it
};

/// All that is in the lab.
struct LabWorld {
    std::vector<LabSurface> surfaces;
    std::vector<TriangleMesh> blockers; ///< black: a visitor's hands, which shadow the projectors
    std::vector<LabProjector> projectors;
    glm::vec3 ambient{0.0F}; ///< radiance of white under the room's light, linear
};

/// What an observer's rays found, kept so that the same view can be lit again by other pictures.
struct LabSight {
    struct Gleam {
        glm::vec2 pixel{0.0F}; ///< of the projector's picture
        float share = 0.0F;    ///< of the picture's light that comes back from white; 0 in shadow
    };
    glm::ivec2 size{0};
    int samples = 1;                      ///< `samples` x `samples` rays a pixel, row after row
    std::vector<std::int32_t> surfaces;   ///< one a ray: of LabWorld::surfaces; -1 where there is nothing, or a blocker
    std::vector<std::uint32_t> triangles; ///< one a ray, of the surface's mesh
    std::vector<Gleam> gleams;            ///< one a ray and projector
};

/// The virtual lab's truth: a CPU ray caster (Embree) that lights surfaces by projectors and looks at them, for judging
/// the renderer. It shares no shader and no camera code with it. Light of a projector on a point: peak x value x albedo
/// x cos(incidence) x (reference distance / distance)^2, values interpolated linearly, in light, between pixel centres
/// as by a lens that is a little soft. A projector that is not enabled is dark.
class Lab {
public:
    /// Throws InvalidInput for a picture of another size than its projector's, a mesh with broken indices or numbers
    /// that are not finite, or a world without surfaces.
    explicit Lab(LabWorld world);
    ~Lab();
    Lab(Lab&&) noexcept;
    Lab& operator=(Lab&&) noexcept;

    /// Gives a projector another picture. Throws InvalidInput as the constructor does.
    void show(std::size_t projector, const Image& image);
    [[nodiscard]] std::size_t projectors() const noexcept;
    /// Throws InvalidInput where there is none of that number.
    [[nodiscard]] const InstalledProjector& projector(std::size_t number) const;

    /// What an observer sees, linear radiance, row 0 at the top; black where nothing is. `samples` x `samples` rays a
    /// pixel, in [1, 16]; throws InvalidInput otherwise.
    [[nodiscard]] std::vector<glm::vec3> radiance(const CalibratedCamera& observer, int samples = 2) const;
    /// The same as a picture, sRGB, 1 is white.
    [[nodiscard]] Image view(const CalibratedCamera& observer, int samples = 2) const;

    /// `radiance` in two steps: where the rays go, and what light the present pictures send there.
    [[nodiscard]] LabSight look(const CalibratedCamera& observer, int samples = 2) const;
    [[nodiscard]] std::vector<glm::vec3> radiance(const LabSight& sight) const;
    /// As `look` with 2 x 2 rays a pixel, of what a single ray a pixel found: a pixel whose neighbours are on the same
    /// surface in the same light gets its rays between theirs, and only the others are looked at again. Throws
    /// InvalidInput for a sight of another observer or more rays.
    [[nodiscard]] LabSight finer(const CalibratedCamera& observer, const LabSight& once) const;

    struct Hit {
        int surface = -1;           ///< of LabWorld::surfaces; -1: a blocker
        std::uint32_t triangle = 0; ///< of its mesh
        glm::dvec3 point{0.0};
        glm::dvec3 normal{0.0}; ///< of the triangle, towards the ray's origin
        double distance = 0.0;
    };
    [[nodiscard]] std::optional<Hit> trace(const glm::dvec3& origin, const glm::dvec3& direction) const;
    /// Whether a projector's light reaches a point on a surface: in its image, from the side that the normal points to,
    /// and not shadowed.
    [[nodiscard]] bool lit(std::size_t projector, const glm::dvec3& point, const glm::dvec3& normal) const;
    /// Whether nothing stands between a point on a surface and a place in the world. `normal` points to the side of the
    /// surface that is meant; a place on its other side is not seen.
    [[nodiscard]] bool sees(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& place) const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
