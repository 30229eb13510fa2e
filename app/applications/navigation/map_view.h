#pragma once

#include <glm/vec2.hpp>

namespace lumorph::navigation {

/// Half the sides of the tablet's sheet in x and z, metres, on which the map lies.
inline constexpr glm::dvec2 kHalf{0.105, 0.075};

/// What of a map is seen: as a plain value. Places are metres on the map, points x and z of the device.
struct MapView {
    glm::dvec2 centre{0.0}; ///< the place in the device's middle
    double width = 2000.0;  ///< of the ground along the device's longer side, metres
    double turn = 0.0;      ///< of the map about its centre, radians; positive: clockwise seen from above

    [[nodiscard]] double scale() const noexcept { return width / (2.0 * kHalf.x); } ///< metres of ground a metre
    [[nodiscard]] glm::dvec2 placeAt(const glm::dvec2& point) const noexcept;
    [[nodiscard]] glm::dvec2 pointAt(const glm::dvec2& place) const noexcept;
    bool operator==(const MapView&) const = default;
};

/// How far a map of this size may be seen without anything beyond it, however it is turned; and all of it, with some of
/// the board around.
[[nodiscard]] double widestView(const glm::dvec2& mapSize) noexcept;
[[nodiscard]] double wholeView(const glm::dvec2& mapSize) noexcept;
/// The view that comes closest to a wished one: as little as can be of what is beyond the map.
[[nodiscard]] MapView within(MapView view, const glm::dvec2& mapSize, double narrowest) noexcept;

/// The way from one view to another that seems even to the eye: out, over and in (van Wijk and Nuij, "Smooth and
/// efficient zooming and panning", 2003).
class Flight {
public:
    Flight(const MapView& from, const MapView& to) noexcept;

    [[nodiscard]] double seconds() const noexcept { return seconds_; }
    /// At a time from 0 to `seconds()`; it begins and ends gently.
    [[nodiscard]] MapView at(double seconds) const noexcept;
    [[nodiscard]] const MapView& end() const noexcept { return to_; }

private:
    MapView from_, to_;
    double distance_ = 0.0, r0_ = 0.0, length_ = 0.0, seconds_ = 1.0;
};

} // namespace lumorph::navigation
