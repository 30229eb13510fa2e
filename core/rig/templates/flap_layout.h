#pragma once

#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include "core/rig/templates/sheet_device.h"

namespace lumorph {

/// A bend line's own frame on the page (x to the right, y up, millimetres): w along the line, u away from it.
struct LineFrame {
    glm::dvec2 origin{0.0};
    glm::dvec2 along{1.0, 0.0};
    glm::dvec2 across{0.0, 1.0}; ///< to the free end

    [[nodiscard]] glm::dvec2 local(const glm::dvec2& page) const noexcept;
    [[nodiscard]] glm::dvec2 page(const glm::dvec2& local) const noexcept;
};

/// A flap as it lies on the page, millimetres.
struct Flap {
    std::string name;
    LineFrame frame;
    Angle angle;
    /// Its rim in the line's frame from one end of the bend line to the other: both ends have u = 0, w never falls.
    std::vector<glm::dvec2> rim;
    std::vector<glm::dvec2> outline; ///< the same on the page
    std::vector<glm::dvec2> cutout;  ///< on the page: the flap with its slits, where the still sheet ends
};

/// How far things stay from one another, millimetres.
struct FlapClearance {
    double bulge = 0.0; ///< by which a rising skirt leaves the flap's outline at most
    [[nodiscard]] double slit() const noexcept { return bulge + 0.35; } ///< from a flap to the still sheet
    [[nodiscard]] double between() const noexcept {
        return 2 * bulge + 0.4;
    } ///< from flap to flap; less than two slits
};

/// Lays the flaps out, in the order of the lines. `outline` is a simple polygon on the page, millimetres. Throws
/// InvalidInput naming the line that has no room, and what takes it.
[[nodiscard]] std::vector<Flap> layOutFlaps(const std::vector<glm::dvec2>& outline, const std::vector<BendLine>& bends,
                                            const FlapClearance& clearance);

/// Device coordinates (x, z) in metres on the page, in millimetres, and the other way round.
[[nodiscard]] inline glm::dvec2 pageOf(const glm::dvec2& place) noexcept { return {1e3 * place.x, -1e3 * place.y}; }
[[nodiscard]] inline glm::dvec2 placeOf(const glm::dvec2& page) noexcept { return {1e-3 * page.x, -1e-3 * page.y}; }

} // namespace lumorph
