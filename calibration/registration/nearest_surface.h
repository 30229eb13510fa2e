#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// The place of a mesh that is nearest to a point (Embree). The mesh may deform: its triangles stay, its vertices move.
/// Threads may share it while nobody moves it.
class NearestSurface {
public:
    struct Place {
        glm::dvec3 point{0.0};
        std::uint32_t triangle = 0;
        glm::dvec3 shares{0.0}; ///< of its corners: they add up to 1
        glm::dvec3 normal{0.0}; ///< of the triangle, of length 1
        double distance = 0.0;  ///< metres
    };

    /// Throws InvalidInput for a mesh without triangles or with broken indices.
    explicit NearestSurface(const TriangleMesh& mesh);
    ~NearestSurface();
    NearestSurface(NearestSurface&&) noexcept;
    NearestSurface& operator=(NearestSurface&&) noexcept;

    /// Its vertices are there from now on, as many as before.
    void move(std::span<const glm::vec3> positions);
    /// Nothing where none is within so many metres.
    [[nodiscard]] std::optional<Place> of(const glm::dvec3& point, double within) const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
