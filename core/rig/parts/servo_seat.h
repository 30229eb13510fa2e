#pragma once

#include "core/rig/parts/layered_solid.h"
#include "core/rig/parts/servo_body.h"

namespace lumorph {

/// Where a seat stands on the page, millimetres: its shaft's axis, seen from above, runs through `shaft` along `out`,
/// from the bottom of the case to the horn; the case reaches along `side`.
struct SeatPlace {
    glm::dvec2 shaft{0.0}; ///< at the bottom of the case
    glm::dvec2 side{1.0, 0.0};
    glm::dvec2 out{0.0, 1.0};

    /// (X, Y) of the servo's drawing on the page.
    [[nodiscard]] glm::dvec2 page(const glm::dvec2& drawn) const noexcept {
        return shaft + side * drawn.x + out * drawn.y;
    }
    [[nodiscard]] PlanePolygon page(PlanePolygon drawn) const;
    /// True where `out` is to the right of `side`: the mirror image of the usual seat.
    [[nodiscard]] bool mirrored() const noexcept { return side.x * out.y - side.y * out.x < 0.0; }
};

/// A seat that holds a servo lying on its side: a trough for the case, slots for the tabs, which take the thrust of the
/// shaft, and room for the cable at the end near the shaft. Measures are the drawing's and `tolerance` on every side.
class ServoSeat {
public:
    static constexpr double kScrewPilot = 1.7; ///< diameter, for self-tapping screws of 2 mm
    static constexpr double kScrewHole = 2.4;  ///< where they pass through

    ServoSeat(const ServoBody& body, double tolerance) : body_(body), tolerance_(tolerance) {}

    /// Outermost border, in the servo's drawing.
    [[nodiscard]] PlanePolygon outline() const;
    /// From the seat's own foot to its top without a plinth: as thick as the servo.
    [[nodiscard]] double thickness() const noexcept { return body_.width + tolerance_; }
    /// The solid foot that fills so much height: none where it would be too thin to print.
    [[nodiscard]] static double plinthOf(double height) noexcept { return height < 0.4 ? 0.0 : height; }
    /// Where its two screws go in, in the servo's drawing.
    [[nodiscard]] std::vector<glm::dvec2> screws() const;
    /// The seat upon `plinth` millimetres of solid foot.
    [[nodiscard]] LayeredDrawing drawing(const SeatPlace& place, double plinth) const;
    /// A lid for a seat that stands alone, held by the same screws.
    [[nodiscard]] LayeredDrawing cap() const;

private:
    [[nodiscard]] Region trough(const SeatPlace& place) const;

    ServoBody body_;
    double tolerance_;
};

} // namespace lumorph
