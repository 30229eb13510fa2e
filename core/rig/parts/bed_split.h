#pragma once

#include <string>
#include <vector>

#include "core/rig/parts/layered_solid.h"

namespace lumorph {

/// Where parts that cover an area are cut, so that each piece lies on the print bed: straight seams, all the way up,
/// with dovetails in the plane. Millimetres.
class BedSplit {
public:
    /// `area` is convex. `clearance` is between a tongue and its socket. Seams halve the area (or cut it in three, and
    /// so on); `shift` moves them by a share in [-1, 1] of what the bed allows, along x and y. Throws InvalidInput
    /// where the bed is too small for any piece.
    BedSplit(const PlanePolygon& area, double bed, double clearance, const glm::dvec2& shift = glm::dvec2(0.0));

    [[nodiscard]] bool needed() const noexcept { return !seamsX_.empty() || !seamsY_.empty(); }
    /// What lies around the seams and is to stay free of small features; convex.
    [[nodiscard]] std::vector<PlanePolygon> strips() const;
    /// The pieces in rows, from the lower left.
    [[nodiscard]] std::vector<LayeredDrawing> pieces(const LayeredDrawing& drawing) const;

private:
    struct Seam {
        double at = 0.0;
        std::vector<double> tongues; ///< their middles along the seam
    };
    [[nodiscard]] std::vector<Seam> seamsAlong(int axis, double bed, double shift) const;
    /// All below (or, with the clearance, above) a seam.
    [[nodiscard]] PlanePolygon sideOf(const Seam& seam, int axis, bool below) const;

    PlanePolygon area_;
    glm::dvec2 low_{0.0};
    glm::dvec2 high_{0.0};
    double clearance_;
    std::vector<Seam> seamsX_;
    std::vector<Seam> seamsY_;
};

} // namespace lumorph
