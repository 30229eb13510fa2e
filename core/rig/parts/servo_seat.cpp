#include "core/rig/parts/servo_seat.h"

namespace lumorph {
namespace {

// Millimetres.
constexpr double kSeatWall = 2.0;
constexpr double kCapThickness = 2.0;
constexpr double kCableRoom = 5.0;   ///< along the case
constexpr double kCableShare = 0.25; ///< of the servo's width: so much wall stays below the cable
constexpr double kScrewAlong = 10.0; ///< from the bottom of the case

} // namespace

PlanePolygon SeatPlace::page(PlanePolygon drawn) const {
    for (glm::dvec2& p : drawn) p = page(p);
    return drawn;
}

PlanePolygon ServoSeat::outline() const {
    const double overhang = 0.5 * (body_.tabs - body_.length) + tolerance_ + kSeatWall;
    return rectangle({-body_.shaft - overhang, -tolerance_ - kSeatWall},
                     {body_.length - body_.shaft + overhang, body_.height});
}

std::vector<glm::dvec2> ServoSeat::screws() const {
    // Between the case and the outermost border, beside the case below the tabs.
    const double beyond = 0.5 * (0.5 * (body_.tabs - body_.length) + kSeatWall + 2.0 * tolerance_);
    return {{-body_.shaft - beyond, kScrewAlong}, {body_.length - body_.shaft + beyond, kScrewAlong}};
}

Region ServoSeat::trough(const SeatPlace& place) const {
    const double near = -body_.shaft - tolerance_;
    const double far = body_.length - body_.shaft + tolerance_;
    const double overhang = 0.5 * (body_.tabs - body_.length);
    Region region;
    region.add(place.page(outline()))
        .cut(place.page(rectangle({near, -tolerance_}, {far, body_.height + 1.0})))
        .cut(place.page(rectangle({near - overhang, body_.tabBottom - tolerance_},
                                  {far + overhang, body_.tabBottom + body_.tabThickness + tolerance_})));
    for (const glm::dvec2& screw : screws()) region.cut(place.page(disc(screw, 0.5 * kScrewPilot)));
    return region;
}

LayeredDrawing ServoSeat::drawing(const SeatPlace& place, double plinth) const {
    LayeredDrawing drawing;
    const double foot = plinthOf(plinth);
    if (foot > 0.0) {
        Region solid;
        solid.add(place.page(outline()));
        for (const glm::dvec2& screw : screws()) solid.cut(place.page(disc(screw, 0.5 * kScrewPilot)));
        drawing.layers.push_back({foot, solid});
    }
    const double beyond = -body_.shaft - 0.5 * (body_.tabs - body_.length) - tolerance_ - kSeatWall - 1.0;
    Region open = trough(place);
    open.cut(place.page(rectangle({beyond, 1.0}, {-body_.shaft, 1.0 + kCableRoom})));
    drawing.layers.push_back({foot + kCableShare * body_.width, trough(place)});
    drawing.layers.push_back({foot + thickness(), open});
    return drawing;
}

LayeredDrawing ServoSeat::cap() const {
    Region plate;
    plate.add(outline());
    for (const glm::dvec2& screw : screws()) plate.cut(disc(screw, 0.5 * kScrewHole));
    return {{{kCapThickness, plate}}};
}

} // namespace lumorph
