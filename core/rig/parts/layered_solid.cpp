#include "core/rig/parts/layered_solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <unordered_map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/geometry/mesh_check.h"
#include "core/rig/templates/plane_drawing.h"
#include "core/rig/templates/sheet_outline.h"

namespace lumorph {
namespace {

constexpr int kDiscSides = 24;

std::uint64_t key(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; }

/// The triangles of the plane and which of them each layer fills.
class LayerBuilder {
public:
    explicit LayerBuilder(const LayeredDrawing& drawing) : drawing_(drawing) {
        plane_ = planeOf(drawing);
        for (std::uint32_t t = 0; t < plane_.triangles.size(); ++t)
            for (int k = 0; k < 3; ++k) faces_[key(plane_.triangles[t][k], plane_.triangles[t][(k + 1) % 3])] = t;
        corners_.resize(plane_.points.size());
        for (std::uint32_t t = 0; t < plane_.triangles.size(); ++t)
            for (int k = 0; k < 3; ++k) corners_[plane_.triangles[t][k]].push_back(t);
        for (const SolidLayer& layer : drawing.layers) fill(layer.region);
    }

    LayeredSolid build() {
        LayeredSolid solid;
        for (std::size_t layer = 0; layer <= filled_.size(); ++layer) addFlats(layer);
        for (std::size_t layer = 0; layer < filled_.size(); ++layer) {
            std::vector<std::pair<std::uint32_t, std::uint32_t>> walls = wallsOf(layer);
            for (const auto& [a, b] : walls) addWall(a, b, layer);
            solid.layers.push_back({drawing_.layers[layer].top, loopsOf(walls)});
        }
        solid.mesh = std::move(mesh_);
        return solid;
    }

private:
    /// Twice: where lines cross, points come into being that others then keep away from.
    static PlaneMesh planeOf(const LayeredDrawing& drawing) {
        PlaneDrawing pool;
        for (const SolidLayer& layer : drawing.layers)
            for (const PlanePolygon* polygon : layer.region.outlines())
                for (std::size_t k = 0; k < polygon->size(); ++k)
                    pool.addEdge((*polygon)[k], (*polygon)[(k + 1) % polygon->size()]);
        for (const glm::dvec2& p : pool.triangulate().points) pool.add(p);
        return pool.triangulate();
    }

    void fill(const Region& region) {
        std::vector<bool> filled;
        for (const glm::uvec3& t : plane_.triangles)
            filled.push_back(region.holds((plane_.points[t.x] + plane_.points[t.y] + plane_.points[t.z]) / 3.0));
        filled_.push_back(std::move(filled));
        for (int round = 0; round < 8 && openPoints(filled_.back()); ++round) {
        }
    }

    [[nodiscard]] bool across(const std::vector<bool>& filled, std::uint32_t a, std::uint32_t b) const {
        const auto found = faces_.find(key(b, a));
        return found != faces_.end() && filled[found->second];
    }

    /// True where something gave way.
    bool openPoints(std::vector<bool>& filled) const {
        std::vector<int> walls(plane_.points.size(), 0);
        for (std::uint32_t t = 0; t < plane_.triangles.size(); ++t)
            for (int k = 0; k < 3; ++k) {
                const glm::uvec3& c = plane_.triangles[t];
                if (filled[t] && !across(filled, c[k], c[(k + 1) % 3])) ++walls[c[k]];
            }
        bool opened = false;
        for (std::size_t v = 0; v < walls.size(); ++v)
            if (walls[v] > 1) {
                for (const std::uint32_t t : smallestFan(filled, corners_[v])) filled[t] = false;
                opened = true;
            }
        return opened;
    }

    [[nodiscard]] double areaOf(std::uint32_t t) const {
        const glm::uvec3& c = plane_.triangles[t];
        return turnOf(plane_.points[c.y] - plane_.points[c.x], plane_.points[c.z] - plane_.points[c.x]);
    }

    /// Of the filled triangles around a point, those that hang together and are least.
    [[nodiscard]] std::vector<std::uint32_t> smallestFan(const std::vector<bool>& filled,
                                                         std::vector<std::uint32_t> left) const {
        std::erase_if(left, [&](std::uint32_t t) { return !filled[t]; });
        std::vector<std::uint32_t> best;
        double least = std::numeric_limits<double>::max();
        while (!left.empty()) {
            std::vector<std::uint32_t> fan{left.back()};
            left.pop_back();
            double area = 0.0;
            for (std::size_t i = 0; i < fan.size(); ++i) {
                area += areaOf(fan[i]);
                for (int k = 0; k < 3; ++k) {
                    const glm::uvec3& c = plane_.triangles[fan[i]];
                    const auto next = faces_.find(key(c[(k + 1) % 3], c[k]));
                    if (next == faces_.end()) continue;
                    const auto place = std::ranges::find(left, next->second);
                    if (place == left.end()) continue;
                    fan.push_back(*place);
                    left.erase(place);
                }
            }
            if (area < least) {
                least = area;
                best = std::move(fan);
            }
        }
        return best;
    }

    [[nodiscard]] std::vector<std::pair<std::uint32_t, std::uint32_t>> wallsOf(std::size_t layer) const {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> walls;
        for (std::uint32_t t = 0; t < plane_.triangles.size(); ++t)
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t a = plane_.triangles[t][k];
                const std::uint32_t b = plane_.triangles[t][(k + 1) % 3];
                if (filled_[layer][t] && !across(filled_[layer], a, b)) walls.emplace_back(a, b);
            }
        return walls;
    }

    [[nodiscard]] std::vector<PlanePolygon>
    loopsOf(const std::vector<std::pair<std::uint32_t, std::uint32_t>>& walls) const {
        std::map<std::uint32_t, std::uint32_t> next(walls.begin(), walls.end());
        std::vector<PlanePolygon> loops;
        while (!next.empty()) {
            PlanePolygon loop;
            for (auto at = next.begin(); at != next.end();) {
                loop.push_back(plane_.points[at->first]);
                const std::uint32_t to = at->second;
                next.erase(at);
                at = next.find(to);
            }
            loops.push_back(std::move(loop));
        }
        return loops;
    }

    std::uint32_t vertex(std::uint32_t point, std::size_t level) {
        const auto [place, isNew] =
            vertices_.try_emplace(key(point, static_cast<std::uint32_t>(level)), mesh_.positions.size());
        if (isNew)
            mesh_.positions.emplace_back(plane_.points[point].x, plane_.points[point].y,
                                         level == 0 ? 0.0 : drawing_.layers[level - 1].top);
        return place->second;
    }

    /// What lies level between this layer and the one below.
    void addFlats(std::size_t layer) {
        for (std::uint32_t t = 0; t < plane_.triangles.size(); ++t) {
            const bool below = layer > 0 && filled_[layer - 1][t];
            const bool above = layer < filled_.size() && filled_[layer][t];
            if (below == above) continue;
            const glm::uvec3& c = plane_.triangles[t];
            const std::array v{vertex(c.x, layer), vertex(c.y, layer), vertex(c.z, layer)};
            below ? mesh_.triangles.emplace_back(v[0], v[1], v[2]) : mesh_.triangles.emplace_back(v[0], v[2], v[1]);
        }
    }

    void addWall(std::uint32_t a, std::uint32_t b, std::size_t layer) {
        const std::array v{vertex(a, layer), vertex(b, layer), vertex(b, layer + 1), vertex(a, layer + 1)};
        mesh_.triangles.emplace_back(v[0], v[1], v[2]);
        mesh_.triangles.emplace_back(v[0], v[2], v[3]);
    }

    const LayeredDrawing& drawing_;
    PlaneMesh plane_;
    std::unordered_map<std::uint64_t, std::uint32_t> faces_;
    std::vector<std::vector<std::uint32_t>> corners_;
    std::vector<std::vector<bool>> filled_; ///< one a layer, one a triangle
    std::unordered_map<std::uint64_t, std::uint32_t> vertices_;
    TriangleMesh mesh_;
};

bool insideEdges(const PlanePolygon& polygon, const glm::dvec2& low, const glm::dvec2& high, const glm::dvec2& point) {
    return point.x > low.x && point.x < high.x && point.y > low.y && point.y < high.y && insidePolygon(polygon, point);
}

} // namespace

PlanePolygon rectangle(const glm::dvec2& low, const glm::dvec2& high) {
    return {low, {high.x, low.y}, high, {low.x, high.y}};
}

PlanePolygon disc(const glm::dvec2& centre, double radius) {
    PlanePolygon polygon;
    for (int k = 0; k < kDiscSides; ++k) {
        const double angle = 2.0 * std::numbers::pi * (k + 0.5) / kDiscSides;
        polygon.push_back(centre + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
    return polygon;
}

PlanePolygon arm(const glm::dvec2& from, double fromRadius, const glm::dvec2& to, double toRadius) {
    PlanePolygon points = disc(from, fromRadius);
    for (const glm::dvec2& p : disc(to, toRadius)) points.push_back(p);
    return convexHull(std::move(points));
}

PlanePolygon leftOf(const PlanePolygon& polygon, const glm::dvec2& from, const glm::dvec2& way, double margin) {
    const auto depth = [&](const glm::dvec2& p) { return turnOf(way, p - from) - margin; };
    PlanePolygon left;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2& a = polygon[i];
        const glm::dvec2& b = polygon[(i + 1) % polygon.size()];
        if (depth(a) >= 0.0) left.push_back(a);
        if ((depth(a) >= 0.0) != (depth(b) >= 0.0)) left.push_back(a + (b - a) * (depth(a) / (depth(a) - depth(b))));
    }
    return left;
}

PlanePolygon shrunk(const PlanePolygon& convex, double margin) {
    PlanePolygon left = convex;
    for (std::size_t k = 0; k < convex.size(); ++k)
        left = leftOf(left, convex[k], glm::normalize(convex[(k + 1) % convex.size()] - convex[k]), margin);
    return left;
}

Region& Region::paint(Act act, std::vector<PlanePolygon> outlines) {
    Step step{act, {}};
    for (PlanePolygon& polygon : outlines) {
        glm::dvec2 low(std::numeric_limits<double>::max());
        glm::dvec2 high(std::numeric_limits<double>::lowest());
        for (const glm::dvec2& p : polygon) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        step.outlines.push_back({std::move(polygon), low, high});
    }
    steps_.push_back(std::move(step));
    return *this;
}

Region& Region::append(const Region& other) {
    steps_.insert(steps_.end(), other.steps_.begin(), other.steps_.end());
    return *this;
}

bool Region::holds(const glm::dvec2& point) const {
    bool filled = false;
    for (const Step& step : steps_) {
        if (filled == (step.act == Act::add)) continue; // nothing that this step could change
        bool inside = false;
        for (const Outline& outline : step.outlines)
            inside = inside != insideEdges(outline.polygon, outline.low, outline.high, point);
        filled = step.act == Act::add ? inside : step.act == Act::cut ? !inside : inside;
    }
    return filled;
}

std::vector<const PlanePolygon*> Region::outlines() const {
    std::vector<const PlanePolygon*> all;
    for (const Step& step : steps_)
        for (const Outline& outline : step.outlines) all.push_back(&outline.polygon);
    return all;
}

std::pair<glm::dvec2, glm::dvec2> Region::bounds() const {
    glm::dvec2 low(std::numeric_limits<double>::max());
    glm::dvec2 high(std::numeric_limits<double>::lowest());
    for (const Step& step : steps_)
        for (const Outline& outline : step.outlines)
            if (step.act == Act::add) {
                low = glm::min(low, outline.low);
                high = glm::max(high, outline.high);
            }
    return {low, high};
}

void LayeredDrawing::keep(const PlanePolygon& outline) {
    for (SolidLayer& layer : layers) layer.region.keep(outline);
}

LayeredSolid solidOf(const LayeredDrawing& drawing, const std::string& part) {
    LayeredSolid solid = LayerBuilder(drawing).build();
    if (solid.mesh.empty())
        throw InvalidInput("part " + inQuotes(part), "nothing would be left of it", "choose a smaller tolerance");
    const MeshReport report = checkMesh(solid.mesh, IntersectionTest::skip);
    if (!report.solid() || report.degenerateTriangles > 0)
        throw InvalidInput("part " + inQuotes(part), "it would be no closed solid with these measures",
                           "change the tolerance or a measure of the rig a little");
    return solid;
}

} // namespace lumorph
