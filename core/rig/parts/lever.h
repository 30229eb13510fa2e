#pragma once

#include <optional>

#include "core/base/units.h"
#include "core/rig/parts/layered_solid.h"
#include "core/rig/parts/servo_body.h"
#include "core/rig/parts/sheet_layout.h"

namespace lumorph {

/// A lever that lies under a flap at rest and pushes it up with its nose. In the plane across the bend line: u away
/// from the line to the free end, v upwards from the sheet's underside; millimetres.
struct Lever {
    double pivot = 0.0;  ///< u of the shaft
    double below = 0.0;  ///< the shaft lies so far below the underside
    double length = 0.0; ///< from the shaft to the middle of its round nose
    Angle rest;          ///< above level, when the nose touches the flap at rest
    Angle end;           ///< above level, when the flap is up; at most the flap's own angle
    Angle lifted;        ///< of the flap at the end
    [[nodiscard]] Angle turn() const { return Angle::radians(end.inRadians() - rest.inRadians()); }
    /// u of the foremost point of its nose at rest.
    [[nodiscard]] double reach() const;

    static constexpr double kNose = 1.5; ///< radius of the nose
    static constexpr double kThickness = 4.4;
};

/// The lever that bends a flap as far as it can be bent from there, and of those the one that reaches least far: at the
/// end its nose lies on the flap beyond the arc and its arm clears the arc, at rest its nose is within the flap.
/// `depth` is the flap's, `below` as in Lever. The flap is lifted less than its angle where it is too short; none when
/// that would be less than 20 degrees.
[[nodiscard]] std::optional<Lever> leverFor(const SheetFlap& flap, double thickness, double depth, double below,
                                            const ServoBody& body, double tolerance);

/// How its servo turns while the flap goes evenly from rest to where it is lifted, the nose always on the flap's
/// underside. `thickness` is the sheet's.
[[nodiscard]] PulseCurve pulseCurveOf(const Lever& lever, const SheetFlap& flap, double thickness);

/// The lever whose nose is captive in a slot of a continuous sheet: its arm and its lift are given. None where the
/// shaft lies too deep for that arm.
[[nodiscard]] std::optional<Lever> captiveLever(const SheetFlap::Captive& captive, double below);

/// What a lever is made of, seen from the side: around shaft and horn, beam, nose. Its shaft lies at the origin, the
/// arm along x, the flap on the side of +y.
[[nodiscard]] std::vector<PlanePolygon> leverShapes(const Lever& lever, const ServoBody& body, double tolerance);
/// The lever as it is printed: its shaft at the origin, the arm along x, with a bed for the servo's own horn that looks
/// up. The flap is on the side of +y, of -y when it is `mirrored`.
[[nodiscard]] LayeredDrawing leverDrawing(const Lever& lever, const ServoBody& body, double tolerance, bool mirrored);
/// From the bottom of a servo's case to the middle of a lever on its horn.
[[nodiscard]] double leverPlane(const ServoBody& body);
/// Radius of the lever around the shaft.
[[nodiscard]] double leverHub(const ServoBody& body, double tolerance);

} // namespace lumorph
