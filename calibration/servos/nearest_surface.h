#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// Finds the nearest place on a mesh that deforms: its triangles stay, its vertices move. One thread at a time.
class NearestSurface {
public:
    struct Place {
        std::uint32_t triangle = 0;
        glm::dvec3 shares{0.0}; ///< of its corners: they add up to 1
        glm::dvec3 normal{0.0}; ///< of the triangle, of length 1
        double distance = 0.0;  ///< metres
    };

    explicit NearestSurface(const TriangleMesh& mesh);
    ~NearestSurface();
    NearestSurface(NearestSurface&&) noexcept;
    NearestSurface& operator=(NearestSurface&&) noexcept;

    /// Its vertices are there from now on, as many as before.
    void move(std::span<const glm::vec3> positions);
    /// Empty where nothing is within `farthest` metres.
    [[nodiscard]] std::optional<Place> nearest(const glm::dvec3& point, double farthest) const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
