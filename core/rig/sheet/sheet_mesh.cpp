#include "core/rig/sheet/sheet_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/geometry/plane_mesh.h"

namespace lumorph {
namespace {

/// Points nearer than this are one, metres.
constexpr double kSame = 1e-7;
constexpr std::size_t kMostNodes = 100'000;

struct Segment {
    glm::dvec2 a;
    glm::dvec2 b;
};

double distanceTo(const Segment& s, const glm::dvec2& p) {
    const glm::dvec2 along = s.b - s.a;
    const double share = std::clamp(glm::dot(p - s.a, along) / glm::dot(along, along), 0.0, 1.0);
    return glm::distance(p, s.a + share * along);
}

/// Whether two segments meet or come nearer than `gap`.
bool near(const Segment& s, const Segment& t, double gap) {
    const auto side = [](const Segment& of, const glm::dvec2& p) { return crossOf(of.b - of.a, p - of.a); };
    if (side(s, t.a) * side(s, t.b) < 0.0 && side(t, s.a) * side(t, s.b) < 0.0) return true;
    return std::min({distanceTo(s, t.a), distanceTo(s, t.b), distanceTo(t, s.a), distanceTo(t, s.b)}) < gap;
}

std::vector<Segment> sidesOf(const std::vector<glm::dvec2>& polygon) {
    std::vector<Segment> sides;
    for (std::size_t k = 0; k < polygon.size(); ++k) sides.push_back({polygon[k], polygon[(k + 1) % polygon.size()]});
    return sides;
}

std::vector<Segment> linesOf(const ElasticSheet& sheet) {
    std::vector<Segment> lines;
    for (const SheetLever& lever : sheet.levers) lines.push_back({lever.from, lever.to});
    return lines;
}

glm::dvec2 middleOf(const std::vector<glm::dvec2>& polygon) {
    glm::dvec2 low = polygon[0];
    glm::dvec2 high = polygon[0];
    for (const glm::dvec2& p : polygon) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    return 0.5 * (low + high);
}

glm::dvec2 mirrored(glm::dvec2 p, int axis, const glm::dvec2& middle) {
    p[axis] = 2.0 * middle[axis] - p[axis];
    return p;
}

/// The number of each segment's mirror image among them; empty when one has none.
std::vector<std::uint32_t> images(const std::vector<Segment>& segments, int axis, const glm::dvec2& middle) {
    std::vector<std::uint32_t> result;
    for (const Segment& s : segments) {
        const Segment image{mirrored(s.a, axis, middle), mirrored(s.b, axis, middle)};
        const auto same = [&](const Segment& t) {
            return std::min(glm::distance(image.a, t.a) + glm::distance(image.b, t.b),
                            glm::distance(image.a, t.b) + glm::distance(image.b, t.a)) < kSame;
        };
        const auto found = std::ranges::find_if(segments, same);
        if (found == segments.end()) return {};
        result.push_back(static_cast<std::uint32_t>(found - segments.begin()));
    }
    return result;
}

/// Meshes the part of a sheet on the upper side of its mirror lines, then mirrors it.
class Mesher {
public:
    Mesher(const ElasticSheet& sheet, double edgeLength)
        : sheet_(sheet), spacing_(edgeLength), middle_(middleOf(sheet.outline)) {}

    SheetMesh build() {
        const std::vector<Segment> outline = sidesOf(sheet_.outline);
        const std::vector<Segment> pad = sidesOf(sheet_.pad);
        const std::vector<Segment> lines = linesOf(sheet_);
        for (int axis = 0; axis < 2; ++axis) {
            const bool mirrors = !images(outline, axis, middle_).empty() &&
                                 images(pad, axis, middle_).size() == pad.size() &&
                                 images(lines, axis, middle_).size() == lines.size();
            if (mirrors) axes_.push_back(axis);
        }
        for (const auto* part : {&outline, &pad, &lines})
            for (const Segment& segment : *part) addClipped(segment);
        addMirrorLines();
        for (const Segment& segment : std::vector(segments_)) sample(segment);
        fill();
        std::vector<glm::uvec3> triangles = triangulate();
        for (int pass = 0; pass < kSmoothings; ++pass) {
            smooth(triangles);
            triangles = triangulate();
        }
        for (const int axis : axes_) reflect(axis, triangles);
        for (glm::uvec3& t : triangles) std::swap(t.y, t.z); // counter-clockwise in (x, z) looks down
        SheetMesh mesh = sheetMesh(points_, std::move(triangles));
        mark(mesh, pad, lines);
        return mesh;
    }

private:
    static constexpr int kSmoothings = 4;

    /// Whether a point is on the upper side of all mirror lines.
    [[nodiscard]] bool inPart(const glm::dvec2& p) const {
        return std::ranges::all_of(axes_, [&](int axis) { return p[axis] > middle_[axis] - kSame; });
    }

    [[nodiscard]] bool inside(const glm::dvec2& p) const { return inPart(p) && insidePolygon(sheet_.outline, p); }

    void addClipped(Segment s) {
        for (const int axis : axes_) {
            const double a = s.a[axis] - middle_[axis];
            const double b = s.b[axis] - middle_[axis];
            if (a < kSame && b < kSame) return; // what lies on the mirror line is added with it
            if (a >= 0.0 && b >= 0.0) continue;
            glm::dvec2& below = a < b ? s.a : s.b;
            below = s.a + (s.b - s.a) * (a / (a - b));
            below[axis] = middle_[axis];
        }
        segments_.push_back(s);
    }

    /// Adds the pieces of the mirror lines inside the sheet, cut where other segments end on them.
    void addMirrorLines() {
        const std::vector<Segment> others = segments_;
        for (const int axis : axes_) {
            std::vector<double> cuts;
            if (axes_.size() == 2) cuts.push_back(middle_[1 - axis]);
            const auto cut = [&](const glm::dvec2& p) {
                if (std::abs(p[axis] - middle_[axis]) < kSame && inPart(p)) cuts.push_back(p[1 - axis]);
            };
            for (const auto& part : {others, linesOf(sheet_), sidesOf(sheet_.pad), sidesOf(sheet_.outline)})
                for (const Segment& s : part) {
                    cut(s.a);
                    cut(s.b);
                }
            std::ranges::sort(cuts);
            for (std::size_t k = 1; k < cuts.size(); ++k) {
                if (cuts[k] - cuts[k - 1] < kSame) continue;
                Segment piece{middle_, middle_};
                piece.a[1 - axis] = cuts[k - 1];
                piece.b[1 - axis] = cuts[k];
                if (inside(0.5 * (piece.a + piece.b))) segments_.push_back(piece);
            }
        }
    }

    std::uint32_t pointAt(const glm::dvec2& p) {
        const std::pair key(std::llround(p.x / kSame), std::llround(p.y / kSame));
        const auto [found, added] = numbers_.try_emplace(key, static_cast<std::uint32_t>(points_.size()));
        if (added) points_.push_back(p);
        return found->second;
    }

    void sample(const Segment& s) {
        const int pieces = std::max(1, static_cast<int>(std::ceil(glm::distance(s.a, s.b) / spacing_ - 0.25)));
        std::uint32_t last = pointAt(s.a);
        for (int k = 1; k <= pieces; ++k) {
            const std::uint32_t next = pointAt(k == pieces ? s.b : s.a + (s.b - s.a) * (double(k) / pieces));
            edges_.emplace_back(last, next);
            last = next;
        }
        fixed_ = points_.size();
    }

    /// Adds an equilateral lattice where it is not too near to a segment.
    void fill() {
        const double row = spacing_ * std::sqrt(0.75);
        glm::dvec2 low = sheet_.outline[0];
        glm::dvec2 high = low;
        for (const glm::dvec2& p : sheet_.outline) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        if ((high.x - low.x) * (high.y - low.y) / (row * spacing_) > kMostNodes)
            throw InvalidInput("sheet mesh", "it would have more than 100,000 nodes", "choose longer edges");
        const auto first = [&](double from, double middle, double step) {
            return static_cast<int>(std::floor((from - middle) / step));
        };
        for (int j = first(low.y, middle_.y, row); middle_.y + j * row < high.y; ++j)
            for (int i = first(low.x, middle_.x, spacing_) - 1; middle_.x + i * spacing_ < high.x; ++i) {
                const glm::dvec2 p = middle_ + glm::dvec2((i + 0.5 * (j & 1)) * spacing_, (j + 0.5) * row);
                const auto close = [&](const Segment& s) { return distanceTo(s, p) < 0.6 * spacing_; };
                if (inside(p) && std::ranges::none_of(segments_, close)) points_.push_back(p);
            }
    }

    [[nodiscard]] std::vector<glm::uvec3> triangulate() const {
        return triangulatePlane(points_, edges_, [&](const glm::dvec2& p) { return inside(p); });
    }

    /// Moves each lattice point to the mean of its neighbours.
    void smooth(const std::vector<glm::uvec3>& triangles) {
        std::vector<glm::dvec2> sum(points_.size(), glm::dvec2(0.0));
        std::vector<int> count(points_.size(), 0);
        for (const glm::uvec3& t : triangles)
            for (int k = 0; k < 3; ++k)
                for (const int other : {(k + 1) % 3, (k + 2) % 3}) {
                    sum[t[k]] += points_[t[other]];
                    ++count[t[k]];
                }
        for (std::size_t k = fixed_; k < points_.size(); ++k) points_[k] = sum[k] / double(count[k]);
    }

    void reflect(int axis, std::vector<glm::uvec3>& triangles) {
        const std::size_t nodes = points_.size();
        std::vector<std::uint32_t> image(nodes);
        for (std::uint32_t k = 0; k < nodes; ++k) {
            if (points_[k][axis] - middle_[axis] < kSame) {
                points_[k][axis] = middle_[axis];
                image[k] = k;
            } else {
                image[k] = static_cast<std::uint32_t>(points_.size());
                points_.push_back(mirrored(points_[k], axis, middle_));
            }
        }
        const std::size_t count = triangles.size();
        for (std::size_t t = 0; t < count; ++t)
            triangles.emplace_back(image[triangles[t].x], image[triangles[t].z], image[triangles[t].y]);
    }

    void mark(SheetMesh& mesh, const std::vector<Segment>& pad, const std::vector<Segment>& lines) const {
        const auto on = [&](const Segment& s, std::uint32_t k) { return distanceTo(s, mesh.points[k]) < kSame; };
        mesh.lineNodes.resize(lines.size());
        for (std::uint32_t k = 0; k < mesh.points.size(); ++k) {
            if (insidePolygon(sheet_.pad, mesh.points[k]) ||
                std::ranges::any_of(pad, [&](const Segment& s) { return on(s, k); }))
                mesh.padNodes.push_back(k);
            for (std::size_t l = 0; l < lines.size(); ++l)
                if (on(lines[l], k)) mesh.lineNodes[l].push_back(k);
        }
        std::map<std::pair<long long, long long>, std::uint32_t> numbers;
        const auto keyOf = [](const glm::dvec2& p) {
            return std::pair(std::llround(p.x / kSame), std::llround(p.y / kSame));
        };
        for (std::uint32_t k = 0; k < mesh.points.size(); ++k) numbers[keyOf(mesh.points[k])] = k;
        std::map<std::array<std::uint32_t, 2>, std::uint32_t> edgeNumbers;
        for (std::uint32_t k = 0; k < mesh.edges.size(); ++k) edgeNumbers[mesh.edges[k]] = k;
        for (const int axis : axes_) {
            MeshMirror mirror{axis, {}, {}, images(lines, axis, middle_)};
            for (const glm::dvec2& p : mesh.points)
                mirror.nodes.push_back(numbers.at(keyOf(mirrored(p, axis, middle_))));
            for (const auto& [a, b] : mesh.edges) {
                const auto [low, high] = std::minmax({mirror.nodes[a], mirror.nodes[b]});
                mirror.edges.push_back(edgeNumbers.at({low, high}));
            }
            mesh.mirrors.push_back(std::move(mirror));
        }
    }

    const ElasticSheet& sheet_;
    double spacing_;
    glm::dvec2 middle_;
    std::vector<int> axes_; ///< about whose middle the drawing is its own mirror image
    std::vector<Segment> segments_;
    std::vector<glm::dvec2> points_;
    std::size_t fixed_ = 0; ///< the points before are on segments
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_;
    std::map<std::pair<long long, long long>, std::uint32_t> numbers_;
};

void requireSheet(bool good, const std::string& subject, const char* why, const char* remedy) {
    if (!good) throw InvalidInput(subject, why, remedy);
}

void checkLever(const ElasticSheet& sheet, std::size_t l) {
    constexpr double kGap = 1e-3; // material around a slot
    const SheetLever& lever = sheet.levers[l];
    const std::string subject = "lever " + inQuotes(lever.name);
    const Segment line{lever.from, lever.to};
    requireSheet(glm::distance(line.a, line.b) >= 2.0 * kGap, subject, "its line is shorter than 2 mm",
                 "draw it longer");
    requireSheet(lever.arm > 0.0 && std::abs(lever.rest.inDegrees()) <= 90.0 && std::abs(lever.end.inDegrees()) <= 90.0,
                 subject, "its arm has no length or passes the vertical", "choose angles from -90 to 90 degrees");
    requireSheet(insidePolygon(sheet.outline, line.a) && insidePolygon(sheet.outline, line.b), subject,
                 "its line ends outside the sheet", "move it inwards");
    for (const Segment& side : sidesOf(sheet.outline))
        requireSheet(!near(line, side, kGap), subject, "its line is nearer than 1 mm to the rim", "move it inwards");
    for (const Segment& side : sidesOf(sheet.pad))
        requireSheet(!near(line, side, kGap) && !insidePolygon(sheet.pad, line.a), subject,
                     "its line touches the clamped pad", "move it outwards, or make the pad smaller");
    for (std::size_t m = 0; m < l; ++m)
        requireSheet(!near(line, {sheet.levers[m].from, sheet.levers[m].to}, kGap), subject,
                     ("its line meets that of " + inQuotes(sheet.levers[m].name)).c_str(),
                     "give each actuator a line of its own");
}

} // namespace

void checkSheet(const ElasticSheet& sheet) {
    checkLayers(sheet.layers);
    requireSheet(sheet.outline.size() >= 3 && std::abs(signedArea(sheet.outline)) > 1e-6, "sheet",
                 "its outline has no area", "draw a polygon in metres");
    requireSheet(sheet.pad.size() >= 3 && std::abs(signedArea(sheet.pad)) > 1e-6, "sheet", "nobody holds it",
                 "draw a pad where it is clamped to the body");
    for (std::size_t l = 0; l < sheet.levers.size(); ++l) checkLever(sheet, l);
}

SheetMesh sheetMesh(std::vector<glm::dvec2> points, std::vector<glm::uvec3> triangles) {
    SheetMesh mesh;
    mesh.points = std::move(points);
    mesh.triangles = std::move(triangles);
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> numbers;
    for (const glm::uvec3& t : mesh.triangles) {
        glm::uvec3 edges(0);
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = t[(k + 1) % 3];
            const std::uint32_t b = t[(k + 2) % 3];
            const std::array edge{std::min(a, b), std::max(a, b)};
            const auto [found, added] = numbers.try_emplace(edge, static_cast<std::uint32_t>(mesh.edges.size()));
            if (added) mesh.edges.push_back(edge);
            edges[k] = found->second;
        }
        mesh.triangleEdges.push_back(edges);
    }
    return mesh;
}

SheetMesh meshSheet(const ElasticSheet& sheet, double edgeLength) {
    checkSheet(sheet);
    requireSheet(edgeLength > 0.0, "sheet mesh", "its edges have no length", "choose a positive one");
    return Mesher(sheet, edgeLength).build();
}

} // namespace lumorph
