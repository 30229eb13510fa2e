#include "core/rig/templates/sheet_device.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <unordered_map>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/geometry/disjoint_sets.h"
#include "core/geometry/plane_mesh.h"
#include "core/rig/templates/continuous_sheet.h"
#include "core/rig/templates/flap_layout.h"
#include "core/rig/templates/plane_drawing.h"
#include "core/rig/templates/sheet_file.h"
#include "core/rig/templates/sheet_outline.h"
#include "core/rig/templates/sound_rig.h"

namespace lumorph {
namespace {

// Millimetres.
constexpr double kGap = 1e3 * kSheetAboveHousing; ///< of skirt between housing and sheet
constexpr int kArcRows = 10;
constexpr int kSkirtShares = 12;
constexpr double kSpacing = 10.0; ///< between points where the sheet stays straight
constexpr double kIsland = 4.0;   ///< square millimetres: smaller still pieces between slits are left out

using Polygon = std::vector<glm::dvec2>;

/// By how much a skirt leaves its flap's outline while it rises, at most.
double bulgeOf(double thickness, double arc, double angle) {
    double bulge = 0.0;
    for (int s = 1; s <= 40; ++s)
        for (int t = 1; t <= 40; ++t) {
            const double turned = angle * s * t / 1600.0;
            const double radius = arc / turned;
            const double below = 0.5 * thickness + kGap * (1.0 - s / 40.0);
            const double at = std::min(turned, std::acos(radius / (radius + below))); // where it is largest
            bulge = std::max(bulge, (radius + below) * std::sin(at) - radius * at);
        }
    return bulge;
}

void requireMeasure(double metres, double least, double most, const char* what) {
    if (!(std::isfinite(metres) && metres >= least && metres <= most)) {
        const auto inCm = [](double m) {
            std::string text = std::to_string(100.0 * m);
            text.erase(text.find_last_not_of('0') + 1);
            if (text.back() == '.') text.pop_back();
            return text;
        };
        throw InvalidInput(std::string("sheet: ") + what,
                           std::isfinite(metres) ? inCm(metres) + " cm cannot be built" : "it is no finite number",
                           "choose " + inCm(least) + " to " + inCm(most) + " cm");
    }
}

void checkSheet(const SheetDevice& device) {
    requireMeasure(device.thickness, 0.0002, 0.02, "thickness");
    requireMeasure(device.housing, 0.001, 0.5, "housing");
    requireMeasure(device.arc, 0.002, 0.2, "arc");
    if (device.bends.size() > kMaxBendLines)
        throw InvalidInput("sheet", std::to_string(device.bends.size()) + " bend lines are too many",
                           "a sheet takes at most " + std::to_string(kMaxBendLines));
    for (const BendLine& bend : device.bends) {
        const double radius = device.arc / std::max(1e-3, bend.angle.inRadians());
        if (radius < 1.5 * device.thickness)
            throw InvalidInput("bend line " + inQuotes(bend.name),
                               "a sheet so thick cannot bend so far in so short an arc",
                               "choose a longer arc, a smaller angle or a thinner sheet");
    }
}

class SheetBuilder {
public:
    explicit SheetBuilder(const SheetDevice& device) : device_(device) {
        clearance_ = flapClearance(device);
        for (const glm::dvec2& p : checkedOutline(device.outline, "sheet")) outline_.push_back(pageOf(p));
        const double thickness = 1e3 * device.thickness;
        ledge_ = 1e3 * device.housing;
        bottom_ = ledge_ + kGap;
        top_ = bottom_ + thickness;
    }

    [[nodiscard]] std::vector<Flap> layOut() const { return layOutFlaps(outline_, device_.bends, clearance_); }

    RigParts build() {
        flaps_ = layOut();
        housing_ = grownHull(outline_, clearance_.slit());
        draw();
        plane_ = pool_.triangulate();
        labelTriangles();
        dropIslands();
        openPoints();
        findNeighbours();
        findMovers();
        raise();
        RigParts parts;
        parts.name = device_.name;
        parts.restMesh = std::move(mesh_);
        parts.pathInside = true;
        parts.drawing = writeSheetDevice(device_);
        for (std::size_t f = 0; f < flaps_.size(); ++f) parts.actuators.push_back(actuator(f));
        return parts;
    }

private:
    enum : int { kNoSheet = -2, kBody = -1 }; ///< labels of triangles; 0 and more are flaps

    // The drawing.

    void draw() {
        for (std::size_t k = 0; k < housing_.size(); ++k)
            pool_.addEdge(housing_[k], housing_[(k + 1) % housing_.size()]);
        for (const Flap& flap : flaps_) drawFlap(flap);
        drawStillEdges();
    }

    void drawFlap(const Flap& flap) {
        const double row = 1e3 * device_.arc / kArcRows;
        const auto rowOf = [&](const glm::dvec2& p) { return p.y / row; };
        std::vector<glm::dvec2> rim = flap.rim;
        for (glm::dvec2& p : rim) { // no thread between a row and the rim
            const double nearest = std::round(rowOf(p));
            if (nearest >= 1.0 && nearest <= kArcRows && std::abs(p.y - nearest * row) < 0.15) p.y = nearest * row;
        }
        for (std::size_t k = 0; k + 1 < rim.size(); ++k) {
            std::vector<double> shares{1.0};
            for (int r = 1; r <= kArcRows; ++r)
                if ((rim[k].y > r * row) != (rim[k + 1].y > r * row))
                    shares.push_back((r * row - rim[k].y) / (rim[k + 1].y - rim[k].y));
            std::ranges::sort(shares);
            glm::dvec2 last = rim[k];
            for (const double share : shares) {
                const glm::dvec2 next = rim[k] + share * (rim[k + 1] - rim[k]);
                pool_.addLine(flap.frame.page(last), flap.frame.page(next), kSpacing);
                last = next;
            }
        }
        pool_.addLine(flap.outline.back(), flap.outline.front(), kSpacing);
        for (int r = 1; r <= kArcRows; ++r) {
            std::vector<double> ends;
            for (std::size_t k = 0; k + 1 < rim.size(); ++k)
                if ((rim[k].y > r * row) != (rim[k + 1].y > r * row))
                    ends.push_back(rim[k].x +
                                   (r * row - rim[k].y) * (rim[k + 1].x - rim[k].x) / (rim[k + 1].y - rim[k].y));
            std::ranges::sort(ends);
            for (std::size_t k = 0; k + 1 < ends.size(); k += 2)
                pool_.addLine(flap.frame.page({ends[k], r * row}), flap.frame.page({ends[k + 1], r * row}), kSpacing);
        }
    }

    /// The edges of the sheet without the flaps' cutouts.
    void drawStillEdges() {
        std::vector<const Polygon*> polygons{&outline_};
        for (const Flap& flap : flaps_) polygons.push_back(&flap.cutout);
        for (std::size_t p = 0; p < polygons.size(); ++p) {
            const Polygon& polygon = *polygons[p];
            for (std::size_t k = 0; k < polygon.size(); ++k) {
                const glm::dvec2& a = polygon[k];
                const glm::dvec2 way = polygon[(k + 1) % polygon.size()] - a;
                std::vector<double> shares{0.0, 1.0};
                for (std::size_t q = 0; q < polygons.size(); ++q)
                    if (q != p) addCrossings(a, way, *polygons[q], shares);
                std::ranges::sort(shares);
                for (std::size_t s = 0; s + 1 < shares.size(); ++s) {
                    const glm::dvec2 middle = a + way * (0.5 * (shares[s] + shares[s + 1]));
                    if (isStillEdge(middle, p)) pool_.addEdge(a + way * shares[s], a + way * shares[s + 1]);
                }
            }
        }
    }

    static void addCrossings(const glm::dvec2& a, const glm::dvec2& way, const Polygon& other,
                             std::vector<double>& shares) {
        for (std::size_t k = 0; k < other.size(); ++k) {
            const glm::dvec2 to = other[k] - a;
            const glm::dvec2 next = other[(k + 1) % other.size()] - other[k];
            const double turn = crossOf(way, next);
            if (turn == 0.0) continue;
            const double s = crossOf(to, next) / turn;
            const double t = crossOf(to, way) / turn;
            if (s > 0.0 && s < 1.0 && t >= 0.0 && t <= 1.0) shares.push_back(s);
        }
    }

    [[nodiscard]] bool isStillEdge(const glm::dvec2& p, std::size_t polygon) const {
        if (polygon > 0 && !insidePolygon(outline_, p)) return false;
        for (std::size_t f = 0; f < flaps_.size(); ++f)
            if (f + 1 != polygon && insidePolygon(flaps_[f].cutout, p)) return false;
        return true;
    }

    // The plane, seen from above.

    void labelTriangles() {
        std::vector<glm::uvec3> kept;
        for (const glm::uvec3& t : plane_.triangles) {
            const glm::dvec2 p = (plane_.points[t.x] + plane_.points[t.y] + plane_.points[t.z]) / 3.0;
            if (!insidePolygon(housing_, p)) continue;
            kept.push_back(t);
            labels_.push_back(labelAt(p));
        }
        plane_.triangles = std::move(kept);
        for (std::uint32_t t = 0; t < plane_.triangles.size(); ++t)
            for (int k = 0; k < 3; ++k) faces_[key(plane_.triangles[t][k], plane_.triangles[t][(k + 1) % 3])] = t;
    }

    [[nodiscard]] int labelAt(const glm::dvec2& p) const {
        for (std::size_t f = 0; f < flaps_.size(); ++f)
            if (insidePolygon(flaps_[f].outline, p)) return static_cast<int>(f);
        if (!insidePolygon(outline_, p)) return kNoSheet;
        for (const Flap& flap : flaps_)
            if (insidePolygon(flap.cutout, p)) return kNoSheet;
        return kBody;
    }

    static std::uint64_t key(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; }

    /// The label on the other side of a triangle's edge.
    [[nodiscard]] int across(std::uint32_t a, std::uint32_t b) const {
        const auto found = faces_.find(key(b, a));
        return found == faces_.end() ? static_cast<int>(kNoSheet) : labels_[found->second];
    }

    /// Still pieces that slits have cut off and that no flap hangs on.
    void dropIslands() {
        DisjointSets sets(plane_.triangles.size());
        const auto eachEdge = [&](const auto& visit) {
            for (std::uint32_t t = 0; t < plane_.triangles.size(); ++t)
                for (int k = 0; k < 3; ++k)
                    if (labels_[t] == kBody) visit(t, plane_.triangles[t][k], plane_.triangles[t][(k + 1) % 3]);
        };
        eachEdge([&](std::uint32_t t, std::uint32_t a, std::uint32_t b) {
            if (across(a, b) == kBody) sets.join(t, faces_.at(key(b, a)));
        });
        std::map<std::uint32_t, double> areas;
        for (std::uint32_t t = 0; t < plane_.triangles.size(); ++t) {
            if (labels_[t] != kBody) continue;
            const glm::uvec3& c = plane_.triangles[t];
            areas[sets.find(t)] +=
                0.5 * crossOf(plane_.points[c.y] - plane_.points[c.x], plane_.points[c.z] - plane_.points[c.x]);
        }
        eachEdge([&](std::uint32_t t, std::uint32_t a, std::uint32_t b) {
            if (across(a, b) >= 0) areas[sets.find(t)] = kIsland;
        });
        for (std::uint32_t t = 0; t < plane_.triangles.size(); ++t)
            if (labels_[t] == kBody && areas[sets.find(t)] < kIsland) labels_[t] = kNoSheet;
    }

    /// Where parts of the sheet touch in a single point, still triangles there give way.
    void openPoints() {
        for (int round = 0; round < 8; ++round) {
            std::vector<std::vector<std::uint32_t>> corners(plane_.points.size());
            std::vector<int> walls(plane_.points.size(), 0);
            for (std::uint32_t t = 0; t < plane_.triangles.size(); ++t)
                for (int k = 0; k < 3; ++k) {
                    const std::uint32_t v = plane_.triangles[t][k];
                    corners[v].push_back(t);
                    if (labels_[t] != kNoSheet && across(v, plane_.triangles[t][(k + 1) % 3]) == kNoSheet) ++walls[v];
                }
            bool opened = false;
            for (std::size_t v = 0; v < walls.size(); ++v)
                if (walls[v] > 1) opened = openPoint(corners[v]) || opened;
            if (!opened) return;
            dropIslands();
        }
    }

    /// Takes the smallest fan of still triangles away; false where every fan is part of a flap.
    bool openPoint(const std::vector<std::uint32_t>& corners) {
        std::vector<std::vector<std::uint32_t>> fans;
        std::vector<std::uint32_t> left = corners;
        while (!left.empty()) {
            std::vector<std::uint32_t> fan{left.back()};
            left.pop_back();
            for (std::size_t i = 0; i < fan.size(); ++i)
                for (int k = 0; k < 3; ++k) {
                    const glm::uvec3& c = plane_.triangles[fan[i]];
                    const auto found = faces_.find(key(c[(k + 1) % 3], c[k]));
                    if (found == faces_.end() || (labels_[found->second] == kNoSheet) != (labels_[fan[0]] == kNoSheet))
                        continue;
                    const auto place = std::ranges::find(left, found->second);
                    if (place == left.end()) continue;
                    fan.push_back(*place);
                    left.erase(place);
                }
            if (std::ranges::all_of(fan, [&](auto t) { return labels_[t] == kBody; })) fans.push_back(std::move(fan));
        }
        if (fans.empty()) return false;
        const auto area = [&](const std::vector<std::uint32_t>& fan) {
            double sum = 0.0;
            for (const std::uint32_t t : fan) {
                const glm::uvec3& c = plane_.triangles[t];
                sum += crossOf(plane_.points[c.y] - plane_.points[c.x], plane_.points[c.z] - plane_.points[c.x]);
            }
            return sum;
        };
        for (const std::uint32_t t : *std::ranges::min_element(fans, {}, area)) labels_[t] = kNoSheet;
        return true;
    }

    /// What lies around each point; a sheet that touches itself in one has no closed surface there.
    void findNeighbours() {
        around_.resize(plane_.points.size());
        std::vector<int> walls(plane_.points.size(), 0);
        for (std::uint32_t t = 0; t < plane_.triangles.size(); ++t)
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t v = plane_.triangles[t][k];
                const std::uint32_t next = plane_.triangles[t][(k + 1) % 3];
                around_[v].push_back(labels_[t]);
                if (labels_[t] == kNoSheet || across(v, next) != kNoSheet) continue;
                walls_.emplace_back(v, next);
                ++walls[v];
            }
        for (std::size_t v = 0; v < walls.size(); ++v)
            if (walls[v] > 1)
                throw InvalidInput(nearest(plane_.points[v]), "two parts of the sheet touch in a single point there",
                                   "move the line a little");
    }

    /// The bend line nearest to a place, or the sheet.
    [[nodiscard]] std::string nearest(const glm::dvec2& page) const {
        std::string name = "sheet";
        double least = 1e9;
        for (const Flap& flap : flaps_)
            for (const glm::dvec2& p : flap.cutout)
                if (glm::distance(p, page) < least) {
                    least = glm::distance(p, page);
                    name = "bend line " + inQuotes(flap.name);
                }
        return name;
    }

    void findMovers() {
        mover_.assign(plane_.points.size(), -1);
        for (std::size_t v = 0; v < around_.size(); ++v)
            for (const int label : around_[v]) {
                if (label < 0) continue;
                const Flap& flap = flaps_[static_cast<std::size_t>(label)];
                if (flap.frame.local(plane_.points[v]).y < 0.5 * PlaneDrawing::kSnap) continue;
                if (std::ranges::any_of(around_[v], [&](int l) { return l != label && l != kNoSheet; }))
                    throw InvalidInput("bend line " + inQuotes(flap.name), "its flap cannot be cut free of the rest",
                                       "move the line a little");
                mover_[v] = label;
            }
    }

    // The solid.

    std::uint32_t addVertex(const glm::dvec2& page, double y, int flap = -1, double weight = 0.0) {
        const auto index = static_cast<std::uint32_t>(mesh_.positions.size());
        mesh_.positions.emplace_back(1e-3 * glm::dvec3(page.x, y, -page.y));
        if (flap >= 0 && weight > 0.0)
            influences_[static_cast<std::size_t>(flap)].push_back({index, static_cast<float>(weight)});
        return index;
    }

    void raise() {
        influences_.resize(flaps_.size());
        std::vector<bool> walled(plane_.points.size(), false);
        std::vector<bool> tall(plane_.points.size(), false);
        for (const auto& [a, b] : walls_) {
            walled[a] = walled[b] = true;
            if (mover_[a] >= 0 || mover_[b] >= 0) tall[a] = tall[b] = true;
        }
        columns_.resize(plane_.points.size());
        for (std::uint32_t v = 0; v < columns_.size(); ++v) {
            const bool onLedge = walled[v] || std::ranges::find(around_[v], kNoSheet) != around_[v].end();
            const bool onSheet = std::ranges::any_of(around_[v], [](int label) { return label != kNoSheet; });
            if (onLedge) columns_[v].push_back(addVertex(plane_.points[v], ledge_));
            for (int row = 1; tall[v] && row <= kSkirtShares; ++row) {
                const double share = static_cast<double>(row) / kSkirtShares;
                columns_[v].push_back(
                    addVertex(plane_.points[v], ledge_ + share * (bottom_ - ledge_), mover_[v], share));
            }
            if (onSheet) columns_[v].push_back(addVertex(plane_.points[v], top_, mover_[v], 1.0));
        }
        for (std::size_t t = 0; t < plane_.triangles.size(); ++t) {
            const glm::uvec3& c = plane_.triangles[t];
            const auto at = [&](std::uint32_t v) {
                return labels_[t] == kNoSheet ? columns_[v].front() : columns_[v].back();
            };
            mesh_.triangles.emplace_back(at(c.x), at(c.y), at(c.z));
        }
        for (const auto& [a, b] : walls_) addWall(columns_[a], columns_[b], mesh_.triangles);
        addHousing();
    }

    void addHousing() {
        std::vector<std::uint32_t> low;
        std::vector<std::uint32_t> high;
        for (const glm::dvec2& p : housing_) {
            high.push_back(columns_[pool_.add(p)].front());
            low.push_back(addVertex(p, 0.0));
        }
        const std::size_t count = low.size();
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t n = (k + 1) % count;
            mesh_.triangles.emplace_back(low[k], low[n], high[n]);
            mesh_.triangles.emplace_back(low[k], high[n], high[k]);
        }
        for (std::size_t k = 1; k + 1 < count; ++k) mesh_.triangles.emplace_back(low[0], low[k + 1], low[k]);
    }

    Actuator actuator(std::size_t f) {
        const Flap& flap = flaps_[f];
        const glm::dvec3 direction(flap.frame.across.x, 0.0, -flap.frame.across.y);
        Actuator actuator;
        actuator.name = flap.name;
        actuator.deformer =
            Bend{glm::vec3(1e-3 * glm::dvec3(flap.frame.origin.x, 0.5 * (bottom_ + top_), -flap.frame.origin.y)),
                 glm::vec3(glm::cross(direction, glm::dvec3(0.0, 1.0, 0.0))),
                 glm::vec3(direction),
                 device_.arc,
                 Angle(),
                 flap.angle};
        actuator.influences = std::move(influences_[f]);
        actuator.maxVelocity = 120.0 / flap.angle.inDegrees(); // an SG90 under load: 120 degrees a second
        actuator.drive = {static_cast<int>(f), 1000.0, 2000.0};
        return actuator;
    }

    const SheetDevice& device_;
    Polygon outline_;
    FlapClearance clearance_;
    double ledge_ = 0.0;
    double bottom_ = 0.0;
    double top_ = 0.0;
    std::vector<Flap> flaps_;
    Polygon housing_;
    PlaneDrawing pool_;
    PlaneMesh plane_;
    std::vector<int> labels_; ///< one a triangle
    std::unordered_map<std::uint64_t, std::uint32_t> faces_;
    std::vector<std::vector<int>> around_;                       ///< labels around each point
    std::vector<std::pair<std::uint32_t, std::uint32_t>> walls_; ///< edges of the sheet, the sheet to their left
    std::vector<int> mover_;                                     ///< the flap that moves each point; -1 for none
    std::vector<std::vector<std::uint32_t>> columns_;
    std::vector<std::vector<Influence>> influences_;
    TriangleMesh mesh_;
};

} // namespace

FlapClearance flapClearance(const SheetDevice& device) {
    checkSheet(device);
    double widest = 0.0;
    for (const BendLine& bend : device.bends) widest = std::max(widest, bend.angle.inRadians());
    return {bulgeOf(1e3 * device.thickness, 1e3 * device.arc, std::clamp(widest, 0.1, 0.5 * std::numbers::pi))};
}

Rig sheetRig(const SheetDevice& device, const Progress& progress, SheetQuality quality) {
    if (device.top == SheetTop::continuous && !device.bends.empty()) {
        checkSheet(device);
        return continuousSheet(device, quality, progress);
    }
    progress.report(0.0, "laying out the flaps");
    Rig rig(SheetBuilder(device).build());
    requireSound(rig, progress);
    progress.report(1.0, "looking the solid over");
    return rig;
}

std::vector<std::vector<glm::dvec2>> sheetFlaps(const SheetDevice& device) {
    std::vector<std::vector<glm::dvec2>> polygons;
    for (const Flap& flap : SheetBuilder(device).layOut()) {
        polygons.emplace_back();
        for (const glm::dvec2& p : flap.outline) polygons.back().push_back(placeOf(p));
    }
    return polygons;
}

} // namespace lumorph
