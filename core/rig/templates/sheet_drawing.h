#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "core/base/units.h"
#include "core/rig/templates/sheet_device.h"

namespace lumorph {

/// Drawing a sheet device, as functions from a drawing to the next: no window, no state. Points are (x, z), metres, and
/// the origin is the drawing's middle.

/// What of a drawing lies at a place.
struct SheetPart {
    enum class Kind {
        none,
        corner,   ///< `index`: a point of the outline
        edge,     ///< `index`: that from this point of the outline to the next
        line,     ///< `index`: a bend line
        lineFrom, ///< an end of it
        lineTo,
    };
    Kind kind = Kind::none;
    std::size_t index = 0;
    bool operator==(const SheetPart&) const = default;

    [[nodiscard]] bool isLine() const noexcept { return kind >= Kind::line; }
};

/// Points of the outline at which it turns by 25 degrees or more, so that they can be seen and held; those of a curve
/// are none.
[[nodiscard]] std::vector<std::size_t> outlineCorners(const std::vector<glm::dvec2>& outline);

/// The part that is nearest to a place, within `reach`; ends of bend lines before corners, those before lines, and
/// lines before edges. Of `chosen`, a bend line, the ends come first even where another line's are nearer.
[[nodiscard]] SheetPart partAt(const SheetDevice& device, const glm::dvec2& at, double reach,
                               std::optional<std::size_t> chosen = {});

/// A place that is drawn, and what drew it there.
struct SnappedPoint {
    enum class To { nothing, grid, edge, corner, lineEnd, middle, angle };
    glm::dvec2 point{0.0};
    To to = To::nothing;
    bool operator==(const SnappedPoint&) const = default;
};

struct SnapRules {
    double grid = 0.0;  ///< its spacing; 0: none
    double reach = 0.0; ///< of all else; 0: nothing else
    SheetPart without;  ///< what is being moved does not draw itself
};

/// Corners, ends of bend lines, middles of edges and the origin within reach come first, then the crossing of an edge
/// with a line of the grid, then the edge, then the grid.
[[nodiscard]] SnappedPoint snapped(const SheetDevice& device, const glm::dvec2& at, const SnapRules& rules);

/// The same on the ray from `from` that is nearest to `at` of those in whole steps of an angle: edges that it meets
/// within reach, else a length of whole grid steps.
[[nodiscard]] SnappedPoint snappedTurn(const SheetDevice& device, const glm::dvec2& from, const glm::dvec2& at,
                                       Angle step, const SnapRules& rules);

[[nodiscard]] SheetDevice withOutline(SheetDevice device, std::vector<glm::dvec2> outline);
/// Outline and bend lines stretched about the outline's middle. Sizes are positive.
[[nodiscard]] SheetDevice withSize(SheetDevice device, double width, double depth);
/// Another bend line, with a name of its own: "flap 1". An end beyond the sheet's edge is brought back to it, so that
/// one may draw generously.
[[nodiscard]] SheetDevice withLine(SheetDevice device, const glm::dvec2& from, const glm::dvec2& to);
[[nodiscard]] SheetDevice withoutLine(SheetDevice device, std::size_t line);
/// A corner, a bend line's end, or an edge or bend line as a whole (`at` less `held` is the way it goes), at another
/// place. An edge without neighbours that are corners, part of a curve, takes the whole outline along.
[[nodiscard]] SheetDevice withMoved(SheetDevice device, const SheetPart& part, const glm::dvec2& held,
                                    const glm::dvec2& at);
/// A corner more on an edge.
[[nodiscard]] SheetDevice withCorner(SheetDevice device, std::size_t edge, const glm::dvec2& at);
/// The outline keeps at least three.
[[nodiscard]] SheetDevice withoutCorner(SheetDevice device, std::size_t corner);
/// The other side of the bend line moves. `flap`: what it moves now (`sheetFlaps`); may be empty.
[[nodiscard]] SheetDevice withOtherSide(SheetDevice device, std::size_t line, const std::vector<glm::dvec2>& flap);

/// With its copy left for right, about the vertical through the origin: of one bend line, or else of the outline and
/// all lines. What already has its copy gets no second one; outlines that overlap become one, without holes.
/// Throws InvalidInput where the outline and its copy do not meet.
[[nodiscard]] SheetDevice mirrored(const SheetDevice& device, std::optional<std::size_t> line = {});

/// With copies around the origin, `count` in all, 2 to 64: of one bend line, or else of the outline and all lines.
/// Throws InvalidInput as `mirrored`.
[[nodiscard]] SheetDevice repeatedAround(const SheetDevice& device, int count, std::optional<std::size_t> line = {});

/// The outline of all that lies in one of them; holes are filled. Throws InvalidInput when it has several parts.
[[nodiscard]] std::vector<glm::dvec2> unitedOutlines(const std::vector<std::vector<glm::dvec2>>& outlines);

} // namespace lumorph
