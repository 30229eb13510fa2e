#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// A polygon on the print bed, millimetres; closed, either way round.
using PlanePolygon = std::vector<glm::dvec2>;

/// Positive where `b` lies to the left of `a`.
[[nodiscard]] inline double turnOf(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

[[nodiscard]] PlanePolygon rectangle(const glm::dvec2& low, const glm::dvec2& high);
[[nodiscard]] PlanePolygon disc(const glm::dvec2& centre, double radius);
/// The convex hull of two discs: an arm that grows thinner.
[[nodiscard]] PlanePolygon arm(const glm::dvec2& from, double fromRadius, const glm::dvec2& to, double toRadius);
/// What of a convex polygon lies to the left of a line by `margin` and more; `way` has length 1.
[[nodiscard]] PlanePolygon leftOf(const PlanePolygon& polygon, const glm::dvec2& from, const glm::dvec2& way,
                                  double margin);
/// A convex polygon, counter-clockwise, without all that is nearer to its border than `margin`; empty where nothing is
/// left.
[[nodiscard]] PlanePolygon shrunk(const PlanePolygon& convex, double margin);

/// A part of the plane, painted step by step: each step adds, cuts or keeps what lies inside its outlines (even-odd).
class Region {
public:
    Region& add(std::vector<PlanePolygon> outlines) { return paint(Act::add, std::move(outlines)); }
    Region& cut(std::vector<PlanePolygon> outlines) { return paint(Act::cut, std::move(outlines)); }
    Region& keep(std::vector<PlanePolygon> outlines) { return paint(Act::keep, std::move(outlines)); }
    Region& add(PlanePolygon outline) { return add(std::vector<PlanePolygon>{std::move(outline)}); }
    Region& cut(PlanePolygon outline) { return cut(std::vector<PlanePolygon>{std::move(outline)}); }
    Region& keep(PlanePolygon outline) { return keep(std::vector<PlanePolygon>{std::move(outline)}); }

    /// The steps of another one, after these.
    Region& append(const Region& other);

    [[nodiscard]] bool holds(const glm::dvec2& point) const;
    [[nodiscard]] std::vector<const PlanePolygon*> outlines() const;
    /// Low and high of everything that is added.
    [[nodiscard]] std::pair<glm::dvec2, glm::dvec2> bounds() const;

private:
    enum class Act { add, cut, keep };
    struct Outline {
        PlanePolygon polygon;
        glm::dvec2 low;
        glm::dvec2 high;
    };
    struct Step {
        Act act;
        std::vector<Outline> outlines;
    };
    Region& paint(Act act, std::vector<PlanePolygon> outlines);
    std::vector<Step> steps_;
};

/// One layer of a part: the same region from the top of the layer below up to `top`, millimetres.
struct SolidLayer {
    double top = 0.0;
    Region region;
};

/// What a part is printed of: layers from z = 0 up.
struct LayeredDrawing {
    std::vector<SolidLayer> layers;

    void keep(const PlanePolygon& outline);
};

/// A layer as it became, for drawings: its borders, even-odd.
struct LayerOutline {
    double top = 0.0;
    std::vector<PlanePolygon> borders;
};

struct LayeredSolid {
    TriangleMesh mesh; ///< millimetres, +Z up, from z = 0
    std::vector<LayerOutline> layers;
};

/// The closed solid of the layers. All layers are triangulated as one plane, so that what lies above one another meets
/// edge to edge; places nearer than 0.03 mm become one. Where parts of a layer would touch in a point alone, the
/// smaller gives way there. Throws InvalidInput naming the part when nothing is left, or when it is no closed solid.
[[nodiscard]] LayeredSolid solidOf(const LayeredDrawing& drawing, const std::string& part);

} // namespace lumorph
