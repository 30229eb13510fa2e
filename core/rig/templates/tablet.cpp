#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/base/resources.h"
#include "core/geometry/plane_mesh.h"
#include "core/rig/rig_file.h"
#include "core/rig/templates/bundled_rigs.h"
#include "core/rig/templates/sheet_outline.h"

// The cut sheet is cut like an opened envelope. Bend lines cut off the four corners; two more, along x,
// end the wide flaps of the long edges, which slits part from the rest. Seen from above, a flap that
// bends upwards draws back towards its bend line and stays within its own outline, so that no two
// flaps ever meet. Under each flap's rim hangs a skirt whose rows follow the rim's path at shares of
// its angle: the solid grows as the flap rises and holds all that the flap has passed.

namespace lumorph {
namespace {

// Millimetres.
constexpr double kInset = 0.5; ///< the sheet ends inside the housing, so that a skirt's bulge stays inside too
constexpr double kLedge = 16.0;
constexpr double kSheetBottom = 18.0;
constexpr double kNeutral = 19.0;
constexpr double kSheetTop = 20.0;
constexpr double kArc = 20.0;
constexpr double kStrip = 3.5; ///< of still sheet between a corner's bend line and the slit
constexpr double kSlit = 1.0;
constexpr double kRow = 2.0;     ///< between rows in the arc
constexpr double kColumn = 11.0; ///< between columns where the sheet stays straight
constexpr int kSkirtRows = 12;

// Of the continuous one, as shares of half its size.
constexpr double kPadX = 100.0 / 210.0;
constexpr double kPadZ = 30.0 / 150.0;
constexpr double kEdgeLine = 86.0 / 210.0; ///< half the length of the long edges' lines
constexpr double kCornerLine = 0.75;       ///< how far a corner's line is from the corner, along both edges

constexpr std::array kNames{"corner front left", "corner front right", "corner back left",
                            "corner back right", "edge front",         "edge back"};

/// What can be chosen, and what follows from it.
struct Measures {
    explicit Measures(const TabletSize& size)
        : halfLength(5.0 * size.width), halfWidth(5.0 * size.depth), cornerAlongX(10.0 * size.cornerAlongWidth),
          cornerAlongZ(10.0 * size.cornerAlongDepth), sheetX(halfLength - kInset), sheetZ(halfWidth - kInset),
          edgeLine(sheetZ - (10.0 * size.reach - kNeutral + kArc * (1.0 - 2.0 / std::numbers::pi))) {}

    double halfLength;
    double halfWidth;
    double cornerAlongX;
    double cornerAlongZ;
    double sheetX;
    double sheetZ;
    /// The bend line of the edge flaps: at 90 degrees an arc of kArc rises by kArc * 2 / pi and the rest
    /// of the flap stands upright on it.
    double edgeLine;
};

void requirePart(bool good, const char* parameter, const char* why, const char* remedy) {
    if (!good) throw InvalidInput(std::string("tablet: ") + parameter, why, remedy);
}

/// Refuses measures with which a part would vanish or reach into another.
void checkMeasures(const Measures& m) {
    constexpr double kLeast = kArc + 2.0;
    requirePart(m.sheetZ - m.edgeLine > kLeast, "reach", "the flaps of the long edges would vanish",
                "choose a larger one");
    requirePart(m.edgeLine > 2.0, "reach", "the flaps of the long edges would meet in the middle",
                "choose a smaller one, or a larger depth");
    requirePart(m.cornerAlongX * m.cornerAlongZ / std::hypot(m.cornerAlongX, m.cornerAlongZ) > kLeast,
                "cornerX, cornerZ", "the corners would vanish", "choose larger ones");
    requirePart(m.cornerAlongZ < m.sheetZ - 2.0, "cornerZ", "the corners of one side would meet",
                "choose a smaller one, or a larger depth");
    const double slope = m.cornerAlongX / m.cornerAlongZ;
    const double slit = (kStrip + kSlit) * std::hypot(1.0, slope);
    requirePart(m.sheetX - m.cornerAlongX - slit > 5.0, "cornerX",
                "nothing would be left of the flaps of the long edges", "choose a smaller one, or a larger width");
    requirePart(m.sheetX - m.cornerAlongX + slope * (m.sheetZ - m.edgeLine) - slit < m.sheetX - 1.0, "reach",
                "the flaps of the long edges would reach past the corners",
                "choose a smaller one, or a larger cornerZ");
}

struct TabletFlap {
    const char* name;
    glm::dvec2 origin;    ///< a point of its bend line, (x, z)
    glm::dvec2 direction; ///< to its free end
};

/// Vertices above one point of the sheet's outline, from the ledge to the sheet's top.
struct Column {
    glm::dvec2 place{0.0};
    int flap = -1;     ///< that moves it
    bool tall = false; ///< carries the skirt's rows, moving or not
    std::vector<std::uint32_t> vertices;
};

/// The outline of one quarter, from the middle of the long edge to the middle of the short edge.
struct Quarter {
    std::vector<Column> columns;
    std::size_t edgeLineEnd = 0;
    std::size_t cornerLineBegin = 0;
    std::size_t cornerLineEnd = 0;
};

/// Distances from the bend line at which a side of a flap has columns, nearest first.
std::vector<double> columnDistances(double end) {
    std::vector<double> distances;
    for (double u = kRow; u < kArc + 0.5 * kRow; u += kRow) distances.push_back(u);
    const int rest = static_cast<int>(std::ceil((end - kArc) / kColumn));
    for (int k = 1; k <= rest; ++k) distances.push_back(kArc + (end - kArc) * k / rest);
    return distances;
}

Quarter firstQuarter(const Measures& m, int edgeFlap, int cornerFlap) {
    const double slope = m.cornerAlongX / m.cornerAlongZ; // of the corner's bend line, x against z
    const double perX = std::sqrt(1.0 + slope * slope);   // distance across the line to distance along x
    const double lineX = m.sheetX - m.cornerAlongX;
    const auto side = [&](double z, double across) { return lineX + slope * (m.sheetZ - z) - across * perX; };
    Quarter quarter;
    auto& columns = quarter.columns;

    const double tip = side(m.sheetZ, kStrip + kSlit);
    const int steps = static_cast<int>(std::round(tip / kColumn));
    for (int k = 0; k < steps; ++k) // the middle itself lies between the first columns of two quarters
        columns.push_back({{tip * (2 * k + 1) / (2 * steps + 1), m.sheetZ}, edgeFlap, true, {}});
    auto distances = columnDistances(m.sheetZ - m.edgeLine);
    for (auto u = distances.rbegin(); u != distances.rend(); ++u) {
        const double z = u == distances.rbegin() ? m.sheetZ : m.edgeLine + *u;
        columns.push_back({{side(z, kStrip + kSlit), z}, edgeFlap, true, {}});
    }
    quarter.edgeLineEnd = columns.size();
    columns.push_back({{side(m.edgeLine, kStrip + kSlit), m.edgeLine}, -1, true, {}});
    columns.push_back({{side(m.edgeLine, kStrip), m.edgeLine}, -1, false, {}});
    columns.push_back({{side(m.sheetZ, kStrip), m.sheetZ}, -1, false, {}});

    quarter.cornerLineBegin = columns.size();
    columns.push_back({{lineX, m.sheetZ}, -1, true, {}});
    const double altitude = m.cornerAlongX * m.cornerAlongZ / std::hypot(m.cornerAlongX, m.cornerAlongZ);
    distances = columnDistances(altitude);
    for (const double u : distances)
        columns.push_back(
            {{u == altitude ? m.sheetX : lineX + m.cornerAlongX * u / altitude, m.sheetZ}, cornerFlap, true, {}});
    columns.back().place.x = m.sheetX;
    for (auto u = distances.rbegin() + 1; u != distances.rend(); ++u)
        columns.push_back({{m.sheetX, m.sheetZ - m.cornerAlongZ * (1.0 - *u / altitude)}, cornerFlap, true, {}});
    quarter.cornerLineEnd = columns.size();
    columns.push_back({{m.sheetX, m.sheetZ - m.cornerAlongZ}, -1, true, {}});
    return quarter;
}

class TabletBuilder {
public:
    explicit TabletBuilder(const Measures& measures) : m_(measures) {
        const glm::dvec2 corner = glm::normalize(glm::dvec2(m_.cornerAlongZ, m_.cornerAlongX));
        const auto at = [&](double x, double z) {
            return TabletFlap{"", {x * (m_.sheetX - m_.cornerAlongX), z * m_.sheetZ}, {x * corner.x, z * corner.y}};
        };
        flaps_ = {at(-1, 1),
                  at(1, 1),
                  at(-1, -1),
                  at(1, -1),
                  TabletFlap{"", {0, m_.edgeLine}, {0, 1}},
                  TabletFlap{"", {0, -m_.edgeLine}, {0, -1}}};
        for (std::size_t f = 0; f < flaps_.size(); ++f) flaps_[f].name = kNames[f];
        influences_.resize(flaps_.size());
    }

    Rig build() {
        layOutline();
        for (Column& column : outline_) raise(column);
        addTop();
        addWalls();
        addHousing();
        RigParts parts;
        parts.name = "tablet";
        parts.restMesh = std::move(mesh_);
        parts.pathInside = true;
        for (std::size_t f = 0; f < flaps_.size(); ++f) parts.actuators.push_back(actuator(f));
        return Rig(std::move(parts));
    }

private:
    std::uint32_t addVertex(const glm::dvec2& place, double y, int flap = -1, double weight = 0.0) {
        const auto index = static_cast<std::uint32_t>(mesh_.positions.size());
        mesh_.positions.emplace_back(1e-3 * glm::dvec3(place.x, y, place.y));
        if (flap >= 0 && weight > 0.0) influences_[flap].push_back({index, static_cast<float>(weight)});
        return index;
    }

    void layOutline() {
        for (const auto& [sx, sz, edge, corner] :
             {std::tuple(1, 1, 4, 1), std::tuple(1, -1, 5, 3), std::tuple(-1, -1, 5, 2), std::tuple(-1, 1, 4, 0)}) {
            Quarter quarter = firstQuarter(m_, edge, corner);
            for (Column& column : quarter.columns) column.place *= glm::dvec2(sx, sz);
            const std::size_t first = outline_.size();
            const std::size_t count = quarter.columns.size();
            const bool turned = sx != sz; // a mirrored quarter runs the other way round
            if (turned) std::ranges::reverse(quarter.columns);
            const auto place = [&](std::size_t k) { return first + (turned ? count - 1 - k : k); };
            edgeLineEnds_[edge - 4].push_back(place(quarter.edgeLineEnd));
            cornerLines_.push_back({place(quarter.cornerLineBegin), place(quarter.cornerLineEnd)});
            outline_.insert(outline_.end(), quarter.columns.begin(), quarter.columns.end());
        }
    }

    void raise(Column& column) {
        column.vertices.push_back(addVertex(column.place, kLedge));
        for (int row = 1; column.tall && row <= kSkirtRows; ++row) {
            const double share = static_cast<double>(row) / kSkirtRows;
            column.vertices.push_back(
                addVertex(column.place, kLedge + share * (kSheetBottom - kLedge), column.flap, share));
        }
        column.vertices.push_back(addVertex(column.place, kSheetTop, column.flap, 1.0));
    }

    /// A line across the sheet from one column to another, with points of its own between.
    void addLine(const Column& from, const Column& to, int flap) {
        const double length = glm::distance(from.place, to.place);
        const int steps = std::max(1, static_cast<int>(std::round(length / kColumn)));
        std::uint32_t last = from.vertices.back();
        for (int k = 1; k <= steps; ++k) {
            std::uint32_t next = to.vertices.back();
            if (k < steps) {
                const glm::dvec2 place = from.place + (to.place - from.place) * (static_cast<double>(k) / steps);
                next = addVertex(place, kSheetTop, flap, 1.0);
                topVertices_.push_back(next);
                topPlaces_.push_back(place);
            }
            lines_.push_back({last, next});
            last = next;
        }
    }

    /// Bend lines, and rows beside them as long as the sheet is curved.
    void addRows(std::size_t lineBegin, int stepBegin, std::size_t lineEnd, int stepEnd, int flap) {
        const int rows = static_cast<int>(std::round(kArc / kRow));
        const auto size = static_cast<int>(outline_.size());
        for (int row = 0; row <= rows; ++row) {
            const auto column = [&](std::size_t line, int step) -> const Column& {
                return outline_[static_cast<std::size_t>((static_cast<int>(line) + step * row + size) % size)];
            };
            addLine(column(lineBegin, stepBegin), column(lineEnd, stepEnd), row == 0 ? -1 : flap);
        }
    }

    void addTop() {
        for (const Column& column : outline_) {
            topVertices_.push_back(column.vertices.back());
            topPlaces_.push_back(column.place);
        }
        for (std::size_t k = 0; k < outline_.size(); ++k)
            lines_.push_back({outline_[k].vertices.back(), outline_[(k + 1) % outline_.size()].vertices.back()});
        for (const auto& [begin, end] : cornerLines_) {
            const int inwards = outline_[begin + 1].flap >= 0 ? 1 : -1;
            addRows(begin, inwards, end, -inwards, outline_[begin + static_cast<std::size_t>(inwards)].flap);
        }
        for (const auto& ends : edgeLineEnds_) {
            const int step = outline_[ends[0] + 1].flap >= 0 ? 1 : -1;
            addRows(ends[0], step, ends[1], -step, outline_[ends[0] + static_cast<std::size_t>(step)].flap);
        }
        triangulate(topVertices_, topPlaces_, lines_, [&](const glm::dvec2& p) { return insidePolygon(border(), p); });
    }

    /// Seen from above with y upwards, z runs down the page.
    static glm::dvec2 page(const glm::dvec2& place) { return {place.x, -place.y}; }

    const std::vector<glm::dvec2>& border() {
        if (border_.empty())
            for (const Column& column : outline_) border_.push_back(page(column.place));
        return border_;
    }

    void triangulate(const std::vector<std::uint32_t>& vertices, const std::vector<glm::dvec2>& places,
                     const std::vector<std::pair<std::uint32_t, std::uint32_t>>& lines,
                     const std::function<bool(const glm::dvec2&)>& keep) {
        std::vector<std::uint32_t> number(mesh_.positions.size(), 0);
        std::vector<glm::dvec2> points;
        for (std::size_t k = 0; k < vertices.size(); ++k) {
            number[vertices[k]] = static_cast<std::uint32_t>(k);
            points.push_back(page(places[k]));
        }
        std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
        edges.reserve(lines.size());
        for (const auto& [a, b] : lines) edges.push_back({number[a], number[b]});
        for (const glm::uvec3& t : triangulatePlane(points, edges, keep))
            mesh_.triangles.emplace_back(vertices[t.x], vertices[t.y], vertices[t.z]);
    }

    /// Walls between neighbouring columns: rim and skirt where they move, plain where they stay.
    void addWalls() {
        for (std::size_t k = 0; k < outline_.size(); ++k)
            addWall(outline_[k].vertices, outline_[(k + 1) % outline_.size()].vertices, mesh_.triangles);
    }

    void addHousing() {
        std::vector<std::uint32_t> vertices;
        std::vector<glm::dvec2> places;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> lines;
        for (const Column& column : outline_) {
            vertices.push_back(column.vertices.front());
            places.push_back(column.place);
        }
        for (std::size_t k = 0; k < outline_.size(); ++k)
            lines.push_back({vertices[k], vertices[(k + 1) % outline_.size()]});
        const std::array<glm::dvec2, 4> corners{
            glm::dvec2(-m_.halfLength, m_.halfWidth), glm::dvec2(m_.halfLength, m_.halfWidth),
            glm::dvec2(m_.halfLength, -m_.halfWidth), glm::dvec2(-m_.halfLength, -m_.halfWidth)};
        std::array<std::uint32_t, 4> high{};
        std::array<std::uint32_t, 4> low{};
        for (std::size_t k = 0; k < 4; ++k) {
            high[k] = addVertex(corners[k], kLedge);
            low[k] = addVertex(corners[k], 0.0);
            vertices.push_back(high[k]);
            places.push_back(corners[k]);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t n = (k + 1) % 4;
            lines.push_back({high[k], high[n]});
            mesh_.triangles.emplace_back(low[k], low[n], high[n]);
            mesh_.triangles.emplace_back(low[k], high[n], high[k]);
        }
        mesh_.triangles.emplace_back(low[0], low[3], low[2]);
        mesh_.triangles.emplace_back(low[0], low[2], low[1]);
        triangulate(vertices, places, lines, [&](const glm::dvec2& p) { return !insidePolygon(border(), p); });
    }

    Actuator actuator(std::size_t f) {
        const TabletFlap& flap = flaps_[f];
        const glm::dvec3 direction(flap.direction.x, 0.0, flap.direction.y);
        Actuator actuator;
        actuator.name = flap.name;
        actuator.deformer = Bend{glm::vec3(1e-3 * glm::dvec3(flap.origin.x, kNeutral, flap.origin.y)),
                                 glm::vec3(glm::cross(direction, glm::dvec3(0.0, 1.0, 0.0))),
                                 glm::vec3(direction),
                                 1e-3 * kArc,
                                 Angle(),
                                 Angle::degrees(90.0)};
        actuator.influences = influences_[f];
        std::ranges::sort(actuator.influences, {}, &Influence::vertex);
        actuator.levels = 33;
        actuator.maxVelocity = 120.0 / 90.0; // an SG90 under load
        actuator.drive = {static_cast<int>(f), 1000.0, 2000.0};
        return actuator;
    }

    Measures m_;
    std::vector<TabletFlap> flaps_;
    std::vector<Column> outline_;
    std::vector<std::pair<std::size_t, std::size_t>> cornerLines_; ///< columns at the ends of the corners' bend lines
    std::array<std::vector<std::size_t>, 2> edgeLineEnds_;
    std::vector<std::uint32_t> topVertices_;
    std::vector<glm::dvec2> topPlaces_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> lines_;
    std::vector<glm::dvec2> border_;
    std::vector<std::vector<Influence>> influences_;
    TriangleMesh mesh_;
};

} // namespace

SheetDevice tabletDrawing(double width, double depth, double thickness) {
    SheetDevice device;
    device.name = "tablet";
    device.top = SheetTop::continuous;
    device.thickness = thickness;
    const glm::dvec2 half = 0.5 * glm::dvec2(width, depth) - 1e-3 * kInset;
    device.outline = rectangleOutline(2.0 * half.x, 2.0 * half.y);
    const auto at = [&](double x, double z) { return glm::dvec2(x, z) * half; };
    device.pad = {at(-kPadX, -kPadZ), at(kPadX, -kPadZ), at(kPadX, kPadZ), at(-kPadX, kPadZ)};
    for (std::size_t k = 0; k < 4; ++k) {
        const double x = k % 2 == 0 ? -1.0 : 1.0;
        const double z = k < 2 ? 1.0 : -1.0;
        const double reach = kCornerLine * std::min(half.x, half.y);
        BendLine line;
        line.name = kNames[k];
        line.from = {x * (half.x - reach), z * half.y};
        line.to = {x * half.x, z * (half.y - reach)};
        device.bends.push_back(line);
    }
    for (const double z : {1.0, -1.0}) {
        BendLine line;
        line.name = kNames[z > 0.0 ? 4 : 5];
        line.from = at(-kEdgeLine, z * kPadZ);
        line.to = at(kEdgeLine, z * kPadZ);
        line.ends = BendLine::Ends::free;
        line.side = z > 0.0 ? BendLine::Side::right : BendLine::Side::left;
        device.bends.push_back(line);
    }
    return device;
}

Rig bakedTablet() { return readRig(resourceFile("models/tablet.glb")); }

Rig cutTabletRig(const TabletSize& size) {
    const Measures measures(size);
    checkMeasures(measures);
    return TabletBuilder(measures).build();
}

} // namespace lumorph
