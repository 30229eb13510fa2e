#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/geometry/calibrated_camera.h"
#include "core/geometry/triangle_mesh.h"
#include "core/render/image.h"
#include "core/scene/scene.h"

namespace lumorph {

/// A diffuse surface of the virtual lab, world metres.
struct LabSurface {
    TriangleMesh mesh;
    glm::vec3 albedo{1.0F}; ///< linear
};

/// A projector of the lab with the picture it sends out.
struct LabProjector {
    SceneProjector projector; ///< as it truly is, which need not be what calibration believes
    Image image;              ///< of the projector's size, sRGB or its own gamma
};

/// All that is in the lab.
struct LabWorld {
    std::vector<LabSurface> surfaces;
    std::vector<TriangleMesh> blockers; ///< black: a visitor's hands, which shadow the projectors
    std::vector<LabProjector> projectors;
    glm::vec3 ambient{0.0F}; ///< radiance of white under the room's light, linear
};

/// The virtual lab's truth: a CPU ray caster (Embree) that lights surfaces by projectors and looks at them, for judging
/// the renderer. It shares no shader and no camera code with it. Light of a projector on a point: peak x value x albedo
/// x cos(incidence) x (reference distance / distance)^2, values interpolated linearly, in light, between pixel centres
/// as by a lens that is a little soft.
class Lab {
public:
    /// Throws InvalidInput for a picture of another size than its projector's, or a world without surfaces.
    explicit Lab(LabWorld world);
    ~Lab();
    Lab(Lab&&) noexcept;
    Lab& operator=(Lab&&) noexcept;

    /// What an observer sees, linear radiance, row 0 at the top; black where nothing is. `samples` x `samples` rays a
    /// pixel.
    [[nodiscard]] std::vector<glm::vec3> radiance(const CalibratedCamera& observer, int samples = 2) const;
    /// The same as a picture, sRGB, 1 is white.
    [[nodiscard]] Image view(const CalibratedCamera& observer, int samples = 2) const;

    struct Hit {
        int surface = -1; ///< of LabWorld::surfaces; -1: a blocker
        glm::dvec3 point{0.0};
        glm::dvec3 normal{0.0}; ///< of the triangle, towards the ray's origin
        double distance = 0.0;
    };
    [[nodiscard]] std::optional<Hit> trace(const glm::dvec3& origin, const glm::dvec3& direction) const;
    /// Whether a projector's light reaches a point on a surface: in its image and not shadowed.
    [[nodiscard]] bool lit(std::size_t projector, const glm::dvec3& point, const glm::dvec3& normal) const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
