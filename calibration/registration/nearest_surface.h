#pragma once

#include <memory>
#include <optional>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// The place of a mesh that is nearest to a point (Embree). Safe to share between threads.
class NearestSurface {
public:
    /// Throws InvalidInput for a mesh without triangles or with broken indices.
    explicit NearestSurface(TriangleMesh mesh);
    ~NearestSurface();
    NearestSurface(NearestSurface&&) noexcept;
    NearestSurface& operator=(NearestSurface&&) noexcept;

    struct Place {
        glm::dvec3 point{0.0};
        glm::dvec3 normal{0.0}; ///< of its triangle, length 1
    };
    /// Nothing where none is within so many metres.
    [[nodiscard]] std::optional<Place> of(const glm::dvec3& point, double within) const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
