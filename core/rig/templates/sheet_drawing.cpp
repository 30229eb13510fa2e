#include "core/rig/templates/sheet_drawing.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/rig/templates/flap_layout.h"
#include "core/rig/templates/plane_drawing.h"
#include "core/rig/templates/sheet_outline.h"

namespace lumorph {
namespace {

using Outline = std::vector<glm::dvec2>;
using Kind = SheetPart::Kind;
using To = SnappedPoint::To;

constexpr double kCornerTurn = 25.0 * std::numbers::pi / 180.0;
constexpr double kLeastLine = 0.006;  ///< metres
constexpr double kSameLine = 1e-4;    ///< metres; bend lines whose ends are nearer are one
constexpr double kSameOutline = 2e-4; ///< metres; an outline that strays no further from another is the same

glm::dvec2 nearestOn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
    const glm::dvec2 way = b - a;
    const double square = glm::dot(way, way);
    return square > 0.0 ? a + way * std::clamp(glm::dot(p - a, way) / square, 0.0, 1.0) : a;
}

/// The nearest of what is offered, within a reach.
class Nearest {
public:
    Nearest(const glm::dvec2& at, double reach) : at_(at), distance_(reach) {}
    /// Whether it is taken.
    bool offer(const glm::dvec2& point) {
        const double distance = glm::distance(point, at_);
        if (distance > distance_) return false;
        distance_ = distance;
        point_ = point;
        return true;
    }
    [[nodiscard]] const std::optional<glm::dvec2>& point() const noexcept { return point_; }

private:
    glm::dvec2 at_;
    double distance_;
    std::optional<glm::dvec2> point_;
};

template <class Visit> void eachEdge(const Outline& outline, const Visit& visit) {
    for (std::size_t k = 0; k < outline.size(); ++k) visit(k, outline[k], outline[(k + 1) % outline.size()]);
}

/// Whether an edge goes away with the part that is moved.
bool movesAlong(const SheetPart& part, std::size_t edge, std::size_t count) {
    const bool corner = part.kind == Kind::corner && (edge == part.index || (edge + 1) % count == part.index);
    return corner || part.kind == Kind::edge;
}

SnappedPoint snappedToPoints(const SheetDevice& device, const glm::dvec2& at, const SnapRules& rules) {
    Nearest nearest(at, rules.reach);
    To to = To::nothing;
    const auto offer = [&](const glm::dvec2& point, To kind) {
        if (nearest.offer(point)) to = kind;
    };
    offer(glm::dvec2(0.0), To::middle);
    const std::size_t count = device.outline.size();
    eachEdge(device.outline, [&](std::size_t k, const glm::dvec2& a, const glm::dvec2& b) {
        // The middle of a chord of a curve is nothing that anyone sees.
        if (!movesAlong(rules.without, k, count) && glm::distance(a, b) > 4.0 * rules.reach)
            offer(0.5 * (a + b), To::middle);
    });
    for (const std::size_t k : outlineCorners(device.outline))
        if (rules.without.kind != Kind::edge && rules.without != SheetPart{Kind::corner, k})
            offer(device.outline[k], To::corner);
    for (std::size_t k = 0; k < device.bends.size(); ++k) {
        const bool moved = rules.without.isLine() && rules.without.index == k;
        if (!moved || rules.without.kind == Kind::lineTo) offer(device.bends[k].from, To::lineEnd);
        if (!moved || rules.without.kind == Kind::lineFrom) offer(device.bends[k].to, To::lineEnd);
    }
    return {nearest.point().value_or(at), to};
}

/// Where an edge crosses the lines of a grid next to a place.
void offerCrossings(Nearest& nearest, const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& at, double grid) {
    for (int axis = 0; axis < 2; ++axis) {
        const double way = b[axis] - a[axis];
        const double share = std::abs(way) < 1e-12 ? -1.0 : (grid * std::round(at[axis] / grid) - a[axis]) / way;
        if (share >= 0.0 && share <= 1.0) nearest.offer(a + share * (b - a));
    }
}

std::optional<glm::dvec2> snappedToEdges(const SheetDevice& device, const glm::dvec2& at, const SnapRules& rules) {
    Nearest crossing(at, rules.reach);
    Nearest edge(at, rules.reach);
    eachEdge(device.outline, [&](std::size_t k, const glm::dvec2& a, const glm::dvec2& b) {
        if (movesAlong(rules.without, k, device.outline.size())) return;
        edge.offer(nearestOn(a, b, at));
        if (rules.grid > 0.0) offerCrossings(crossing, a, b, at, rules.grid);
    });
    return edge.point() && crossing.point() ? crossing.point() : edge.point();
}

/// Shares of a way between which both its ends lie on the sheet or at its edge; all of it where it does not cross that.
std::pair<double, double> sharesOnSheet(const Outline& outline, const glm::dvec2& from, const glm::dvec2& to) {
    const glm::dvec2 way = to - from;
    double first = 1.0;
    double last = 0.0;
    eachEdge(outline, [&](std::size_t, const glm::dvec2& a, const glm::dvec2& b) {
        const double across = crossOf(way, b - a);
        if (std::abs(across) < 1e-15) return;
        const double along = crossOf(a - from, b - a) / across;
        const double share = crossOf(a - from, way) / across;
        if (along < 0.0 || along > 1.0 || share < 0.0 || share > 1.0) return;
        first = std::min(first, along);
        last = std::max(last, along);
    });
    if (insidePolygon(outline, from)) first = 0.0;
    if (insidePolygon(outline, to)) last = 1.0;
    // What is cut to a dot would not be found again.
    if ((last - first) * glm::length(way) < kLeastLine) return {0.0, 1.0};
    return {first, last};
}

std::string freeName(const SheetDevice& device, std::string base) {
    while (!base.empty() && (std::isdigit(static_cast<unsigned char>(base.back())) != 0)) base.pop_back();
    while (!base.empty() && base.back() == ' ') base.pop_back();
    if (base.empty()) base = "flap";
    for (std::size_t number = 1;; ++number) {
        std::string name = base + ' ' + std::to_string(number);
        if (std::ranges::find(device.bends, name, &BendLine::name) == device.bends.end()) return name;
    }
}

bool sameLine(const BendLine& a, const BendLine& b) {
    const auto near = [](const glm::dvec2& p, const glm::dvec2& q) { return glm::distance(p, q) < kSameLine; };
    return (near(a.from, b.from) && near(a.to, b.to)) || (near(a.from, b.to) && near(a.to, b.from));
}

void addCopy(SheetDevice& device, BendLine copy) {
    const auto same = [&](const BendLine& line) { return sameLine(line, copy); };
    if (std::ranges::any_of(device.bends, same)) return;
    copy.name = freeName(device, copy.name);
    device.bends.push_back(std::move(copy));
}

double distanceTo(const Outline& outline, const glm::dvec2& p) {
    double least = std::numeric_limits<double>::max();
    eachEdge(outline, [&](std::size_t, const glm::dvec2& a, const glm::dvec2& b) {
        least = std::min(least, glm::distance(nearestOn(a, b, p), p));
    });
    return least;
}

bool sameOutline(const Outline& a, const Outline& b) {
    const auto near = [](const Outline& outline) {
        return [&](const glm::dvec2& p) { return distanceTo(outline, p) < kSameOutline; };
    };
    return std::ranges::all_of(a, near(b)) && std::ranges::all_of(b, near(a));
}

/// The drawing with copies of one line or of all; `maps` say where each copy lies.
template <class Map>
SheetDevice withCopies(const SheetDevice& device, std::optional<std::size_t> line, const std::vector<Map>& maps) {
    SheetDevice result = device;
    Outline outline = device.outline;
    std::vector<Outline> outlines{outline};
    for (const Map& map : maps) {
        if (!line) {
            Outline copy;
            for (const glm::dvec2& p : outline) copy.push_back(map.point(p));
            if (!sameOutline(copy, outline)) outlines.push_back(std::move(copy));
        }
        for (std::size_t k = 0; k < device.bends.size(); ++k)
            if (!line || k == *line) addCopy(result, map.line(device.bends[k]));
    }
    if (outlines.size() > 1) result.outline = unitedOutlines(outlines);
    return result;
}

struct Turn {
    double cosine = 1.0;
    double sine = 0.0;

    [[nodiscard]] glm::dvec2 point(const glm::dvec2& p) const {
        return {cosine * p.x - sine * p.y, sine * p.x + cosine * p.y};
    }
    [[nodiscard]] BendLine line(BendLine bend) const {
        bend.from = point(bend.from);
        bend.to = point(bend.to);
        return bend;
    }
};

struct Mirror {
    [[nodiscard]] static glm::dvec2 point(const glm::dvec2& p) { return {-p.x, p.y}; }
    [[nodiscard]] static BendLine line(BendLine bend) {
        using Side = BendLine::Side;
        bend.from = point(bend.from);
        bend.to = point(bend.to);
        if (bend.side != Side::smaller) bend.side = bend.side == Side::left ? Side::right : Side::left;
        return bend;
    }
};

/// Loops around the triangles that are kept, each as points; those around areas counter-clockwise, those around holes
/// the other way.
std::vector<Outline> loopsAround(const PlaneMesh& plane, const std::vector<bool>& kept) {
    std::map<PlaneEdge, std::size_t> faces;
    for (std::size_t t = 0; t < plane.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) faces[{plane.triangles[t][k], plane.triangles[t][(k + 1) % 3]}] = t;
    std::multimap<std::uint32_t, std::uint32_t> walls;
    for (const auto& [edge, face] : faces) {
        const auto across = faces.find({edge.second, edge.first});
        if (kept[face] && (across == faces.end() || !kept[across->second])) walls.emplace(edge.first, edge.second);
    }
    std::vector<Outline> loops;
    while (!walls.empty()) {
        Outline loop;
        std::uint32_t at = walls.begin()->first;
        for (auto wall = walls.find(at); wall != walls.end(); wall = walls.find(at)) {
            loop.push_back(plane.points[at]);
            at = wall->second;
            walls.erase(wall);
        }
        loops.push_back(std::move(loop));
    }
    return loops;
}

/// Without the points at which it does not turn.
Outline withoutStraights(const Outline& loop) {
    Outline kept;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const glm::dvec2 in = loop[k] - (kept.empty() ? loop.back() : kept.back());
        const glm::dvec2 out = loop[(k + 1) % loop.size()] - loop[k];
        if (std::abs(crossOf(in, out)) > 1e-6 * glm::length(in) * glm::length(out)) kept.push_back(loop[k]);
    }
    return kept;
}

bool onCurve(const Outline& outline, std::size_t edge) {
    const std::vector<std::size_t> corners = outlineCorners(outline);
    const auto corner = [&](std::size_t k) { return std::ranges::find(corners, k) != corners.end(); };
    return !corner(edge) || !corner((edge + 1) % outline.size());
}

} // namespace

std::vector<std::size_t> outlineCorners(const Outline& outline) {
    std::vector<std::size_t> corners;
    const std::size_t count = outline.size();
    for (std::size_t k = 0; k < count; ++k) {
        const glm::dvec2 in = outline[k] - outline[(k + count - 1) % count];
        const glm::dvec2 out = outline[(k + 1) % count] - outline[k];
        if (std::abs(std::atan2(crossOf(in, out), glm::dot(in, out))) >= kCornerTurn) corners.push_back(k);
    }
    return corners;
}

SheetPart partAt(const SheetDevice& device, const glm::dvec2& at, double reach, std::optional<std::size_t> chosen) {
    SheetPart part;
    const auto offer = [&](Nearest& nearest, const glm::dvec2& point, Kind kind, std::size_t index) {
        if (nearest.offer(point)) part = {kind, index};
    };
    const auto offerEnds = [&](Nearest& nearest, std::size_t k) {
        offer(nearest, device.bends[k].from, Kind::lineFrom, k);
        offer(nearest, device.bends[k].to, Kind::lineTo, k);
    };
    if (chosen && *chosen < device.bends.size()) {
        Nearest nearest(at, reach);
        offerEnds(nearest, *chosen);
        if (nearest.point()) return part;
    }
    Nearest end(at, reach);
    for (std::size_t k = 0; k < device.bends.size(); ++k) offerEnds(end, k);
    if (end.point()) return part;
    Nearest corner(at, reach);
    for (const std::size_t k : outlineCorners(device.outline)) offer(corner, device.outline[k], Kind::corner, k);
    if (corner.point()) return part;
    Nearest line(at, reach);
    for (std::size_t k = 0; k < device.bends.size(); ++k)
        offer(line, nearestOn(device.bends[k].from, device.bends[k].to, at), Kind::line, k);
    if (line.point()) return part;
    Nearest edge(at, reach);
    eachEdge(device.outline, [&](std::size_t k, const glm::dvec2& a, const glm::dvec2& b) {
        offer(edge, nearestOn(a, b, at), Kind::edge, k);
    });
    return part;
}

SnappedPoint snapped(const SheetDevice& device, const glm::dvec2& at, const SnapRules& rules) {
    if (rules.reach > 0.0) {
        if (const SnappedPoint point = snappedToPoints(device, at, rules); point.to != To::nothing) return point;
        if (const auto edge = snappedToEdges(device, at, rules)) return {*edge, To::edge};
    }
    if (rules.grid > 0.0) return {rules.grid * glm::round(at / rules.grid), To::grid};
    return {at, To::nothing};
}

SnappedPoint snappedTurn(const SheetDevice& device, const glm::dvec2& from, const glm::dvec2& at, Angle step,
                         const SnapRules& rules) {
    const glm::dvec2 way = at - from;
    const double turn = step.inRadians() * std::round(std::atan2(way.y, way.x) / step.inRadians());
    const glm::dvec2 direction(std::cos(turn), std::sin(turn));
    double length = std::max(0.0, glm::dot(way, direction));
    Nearest edge(from + direction * length, rules.reach);
    eachEdge(device.outline, [&](std::size_t, const glm::dvec2& a, const glm::dvec2& b) {
        const double across = crossOf(direction, b - a);
        if (std::abs(across) < 1e-12) return;
        const double along = crossOf(a - from, b - a) / across;
        const double share = crossOf(a - from, direction) / across;
        if (along > 0.0 && share >= 0.0 && share <= 1.0) edge.offer(from + along * direction);
    });
    if (edge.point()) return {*edge.point(), To::edge};
    if (rules.grid > 0.0) length = rules.grid * std::round(length / rules.grid);
    return {from + length * direction, To::angle};
}

SheetDevice withOutline(SheetDevice device, Outline outline) {
    device.outline = std::move(outline);
    device.pad.clear(); // it belonged to the outline before
    return device;
}

SheetDevice withSize(SheetDevice device, double width, double depth) {
    const OutlineBox box = boxOf(device.outline);
    const glm::dvec2 size = box.size();
    if (!(size.x > 0.0 && size.y > 0.0 && width > 0.0 && depth > 0.0)) return device;
    const glm::dvec2 scale = glm::dvec2(width, depth) / size;
    const auto move = [&](glm::dvec2& p) { p = box.middle() + scale * (p - box.middle()); };
    for (glm::dvec2& p : device.outline) move(p);
    for (glm::dvec2& p : device.pad) move(p);
    for (BendLine& bend : device.bends) {
        move(bend.from);
        move(bend.to);
    }
    return device;
}

SheetDevice withLine(SheetDevice device, const glm::dvec2& from, const glm::dvec2& to) {
    BendLine bend;
    bend.name = freeName(device, "flap");
    const auto [first, last] = sharesOnSheet(device.outline, from, to);
    bend.from = from + first * (to - from);
    bend.to = from + last * (to - from);
    device.bends.push_back(std::move(bend));
    return device;
}

SheetDevice withoutLine(SheetDevice device, std::size_t line) {
    if (line < device.bends.size()) device.bends.erase(device.bends.begin() + static_cast<std::ptrdiff_t>(line));
    return device;
}

SheetDevice withMoved(SheetDevice device, const SheetPart& part, const glm::dvec2& held, const glm::dvec2& at) {
    if (part.isLine() && part.index < device.bends.size()) {
        BendLine& bend = device.bends[part.index];
        if (part.kind == Kind::lineFrom) bend.from = at;
        if (part.kind == Kind::lineTo) bend.to = at;
        if (part.kind == Kind::line) {
            bend.from += at - held;
            bend.to += at - held;
        }
    } else if (part.kind == Kind::corner && part.index < device.outline.size()) {
        device.outline[part.index] = at;
    } else if (part.kind == Kind::edge && part.index < device.outline.size()) {
        if (onCurve(device.outline, part.index)) {
            for (glm::dvec2& p : device.outline) p += at - held;
        } else {
            device.outline[part.index] += at - held;
            device.outline[(part.index + 1) % device.outline.size()] += at - held;
        }
    }
    return device;
}

SheetDevice withCorner(SheetDevice device, std::size_t edge, const glm::dvec2& at) {
    if (edge < device.outline.size())
        device.outline.insert(device.outline.begin() + static_cast<std::ptrdiff_t>(edge) + 1, at);
    return device;
}

SheetDevice withoutCorner(SheetDevice device, std::size_t corner) {
    if (device.outline.size() > 3 && corner < device.outline.size())
        device.outline.erase(device.outline.begin() + static_cast<std::ptrdiff_t>(corner));
    return device;
}

SheetDevice withOtherSide(SheetDevice device, std::size_t line, const Outline& flap) {
    using Side = BendLine::Side;
    if (line >= device.bends.size()) return device;
    BendLine& bend = device.bends[line];
    Side now = bend.side;
    if (now == Side::smaller) {
        const glm::dvec2 along = bend.to - bend.from;
        double across = 0.0; // z runs down the page: what turns left has a negative cross product
        for (const glm::dvec2& p : flap) across += crossOf(along, p - bend.from);
        now = across < 0.0 ? Side::left : Side::right;
    }
    bend.side = now == Side::left ? Side::right : Side::left;
    return device;
}

SheetDevice mirrored(const SheetDevice& device, std::optional<std::size_t> line) {
    return withCopies(device, line, std::vector<Mirror>(1));
}

SheetDevice repeatedAround(const SheetDevice& device, int count, std::optional<std::size_t> line) {
    constexpr int kMost = 64;
    if (count < 2 || count > kMost)
        throw InvalidInput(std::to_string(count) + " copies", "that is not from 2 to 64", "choose another number");
    std::vector<Turn> turns;
    for (int k = 1; k < count; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / count;
        turns.push_back({std::cos(angle), std::sin(angle)});
    }
    return withCopies(device, line, turns);
}

Outline unitedOutlines(const std::vector<Outline>& outlines) {
    PlaneDrawing pool;
    std::vector<Outline> pages;
    for (const Outline& outline : outlines) {
        pages.emplace_back();
        for (const glm::dvec2& p : outline) pages.back().push_back(pageOf(p));
        eachEdge(pages.back(), [&](std::size_t, const glm::dvec2& a, const glm::dvec2& b) { pool.addEdge(a, b); });
    }
    const PlaneMesh plane = pool.triangulate();
    std::vector<bool> kept;
    for (const glm::uvec3& t : plane.triangles) {
        const glm::dvec2 p = (plane.points[t.x] + plane.points[t.y] + plane.points[t.z]) / 3.0;
        kept.push_back(std::ranges::any_of(pages, [&](const Outline& page) { return insidePolygon(page, p); }));
    }
    std::vector<Outline> loops = loopsAround(plane, kept);
    std::erase_if(loops, [](const Outline& loop) { return signedArea(loop) < 1.0; }); // holes, and slivers of 1 mm2
    if (loops.size() != 1)
        throw InvalidInput("outline", "it and its copies do not meet",
                           "let it reach the middle of the page, and try again");
    Outline united;
    for (const glm::dvec2& p : withoutStraights(loops.front())) united.push_back(placeOf(p));
    return united;
}

} // namespace lumorph
