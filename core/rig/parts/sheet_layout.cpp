#include "core/rig/parts/sheet_layout.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <glm/geometric.hpp>

#include "core/geometry/plane_mesh.h"
#include "core/rig/templates/continuous_sheet.h"
#include "core/rig/templates/sheet_file.h"
#include "core/rig/templates/sheet_outline.h"

namespace lumorph {
namespace {

constexpr double kLevel = 1e-5;     ///< metres: heights nearer than this are one
constexpr double kUsualGap = 0.002; ///< metres, from a housing to its sheet, where no bend tells it
constexpr double kLeastSheet = 0.1; ///< millimetres

glm::dvec2 onPage(const glm::vec3& p) { return pageOf({p.x, p.z}); }

/// Level triangles at a height that look up (or down).
std::vector<bool> levelAt(const TriangleMesh& mesh, double height, bool up) {
    std::vector<bool> keep;
    for (const glm::uvec3& t : mesh.triangles) {
        bool level = true;
        for (int k = 0; k < 3; ++k) level = level && std::abs(mesh.positions[t[k]].y - height) < kLevel;
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 n = glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
        keep.push_back(level && (n.y > 0.0) == up && n.y != 0.0);
    }
    return keep;
}

/// The height of the largest level area that looks up, below the top; none where there is none.
std::optional<double> ledgeOf(const TriangleMesh& mesh, double top) {
    std::map<long, double> areas; // by height in hundredths of a millimetre
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 b(mesh.positions[t.y]);
        const glm::dvec3 c(mesh.positions[t.z]);
        const glm::dvec3 n = glm::cross(b - a, c - a);
        if (std::max({a.y, b.y, c.y}) - std::min({a.y, b.y, c.y}) < kLevel && n.y > 0.0 && a.y < top - kLevel)
            areas[std::lround(1e5 * a.y)] += n.y;
    }
    if (areas.empty()) return std::nullopt;
    return 1e-5 * std::ranges::max_element(areas, {}, [](const auto& entry) { return entry.second; })->first;
}

/// The bend, where this actuator bends a level sheet upwards.
const Bend* upwardBend(const Actuator& actuator) {
    const auto* bend = std::get_if<Bend>(&actuator.deformer);
    if (bend == nullptr || bend->max.inRadians() <= 0.0) return nullptr;
    const glm::dvec3 axis = glm::normalize(glm::dvec3(bend->axis));
    const glm::dvec3 across = glm::normalize(glm::dvec3(bend->direction));
    const bool level = std::abs(axis.y) < 1e-3 && std::abs(across.y) < 1e-3;
    return level && glm::cross(axis, across).y > 0.9 ? bend : nullptr;
}

constexpr double kSlotHalf = 2.6;   ///< of a captive lever's slot, beside its middle
constexpr double kSlotBeyond = 2.5; ///< of that slot beyond the nose

/// The continuous sheet that the rig was drawn as, while it still has the drawing's levers.
std::optional<ElasticSheet> continuousSheetOf(const Rig& rig) {
    if (!rig.parts().sheet || rig.parts().drawing.empty()) return std::nullopt;
    const SheetDevice device = parseSheetDevice(rig.parts().drawing, rig.name());
    if (device.top != SheetTop::continuous || device.bends.size() != rig.actuatorCount()) return std::nullopt;
    for (const Actuator& actuator : rig.actuators())
        if (!std::holds_alternative<SheetLift>(actuator.deformer)) return std::nullopt;
    return elasticSheetOf(device);
}

/// A lever of it; `across` points away from the pad.
SheetFlap flapOf(const SheetLever& lever, std::size_t index, const glm::dvec2& pad) {
    SheetFlap flap;
    flap.actuator = index;
    flap.angle = lever.end;
    const glm::dvec2 from = pageOf(lever.from), to = pageOf(lever.to);
    flap.frame.origin = 0.5 * (from + to);
    flap.frame.along = glm::normalize(to - from);
    flap.frame.across = {-flap.frame.along.y, flap.frame.along.x};
    if (glm::dot(flap.frame.across, flap.frame.origin - pad) < 0.0) {
        flap.frame.along = -flap.frame.along;
        flap.frame.across = -flap.frame.across;
    }
    flap.high = 0.5 * glm::distance(from, to);
    flap.low = -flap.high;
    flap.captive = {1e3 * lever.arm, 1e3 * lever.heightAt(1.0)};
    return flap;
}

/// As long as the nose slides inwards while its arm goes from level to its end.
PlanePolygon slotOf(const SheetFlap& flap) {
    const auto& [arm, lift] = *flap.captive;
    const double slide = arm - std::sqrt(std::max(0.0, arm * arm - lift * lift));
    PlanePolygon slot = rectangle({-kSlotHalf, -slide - kSlotBeyond}, {kSlotHalf, kSlotBeyond});
    for (glm::dvec2& p : slot) p = flap.frame.page(p);
    return slot;
}

SheetFlap flapOf(const Rig& rig, std::size_t index, const Bend& bend, const std::vector<bool>& top) {
    SheetFlap flap;
    flap.actuator = index;
    flap.arc = 1e3 * bend.length;
    flap.angle = bend.max;
    flap.frame.origin = onPage(bend.origin);
    flap.frame.across = glm::normalize(glm::dvec2(bend.direction.x, -bend.direction.z));
    flap.frame.along = {flap.frame.across.y, -flap.frame.across.x};
    std::set<std::uint32_t> moved;
    for (const Influence& influence : rig.actuators()[index].influences)
        if (influence.weight > 0.5F) moved.insert(influence.vertex);
    const TriangleMesh& mesh = rig.restMesh();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::uvec3& c = mesh.triangles[t];
        if (!top[t] || (!moved.contains(c.x) && !moved.contains(c.y) && !moved.contains(c.z))) continue;
        flap.triangles.push_back({});
        for (int k = 0; k < 3; ++k) flap.triangles.back().push_back(flap.frame.local(onPage(mesh.positions[c[k]])));
    }
    if (flap.triangles.empty()) return flap;
    flap.low = flap.high = flap.triangles.front().front().x;
    for (const PlanePolygon& triangle : flap.triangles)
        for (const glm::dvec2& p : triangle) {
            flap.low = std::min(flap.low, p.x);
            flap.high = std::max(flap.high, p.x);
        }
    return flap;
}

} // namespace

double SheetFlap::depthAt(double along) const {
    double depth = 0.0;
    for (const PlanePolygon& triangle : triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec2& a = triangle[k];
            const glm::dvec2& b = triangle[(k + 1) % 3];
            if ((a.x > along) != (b.x > along))
                depth = std::max(depth, a.y + (b.y - a.y) * (along - a.x) / (b.x - a.x));
        }
    return depth;
}

std::vector<PlanePolygon> bordersOf(const TriangleMesh& mesh, const std::vector<bool>& keep) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int k = 0; keep[t] && k < 3; ++k) edges.emplace(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
    std::multimap<std::uint32_t, std::uint32_t> next;
    for (const auto& [a, b] : edges)
        if (!edges.contains({b, a})) next.emplace(a, b);
    std::vector<PlanePolygon> borders;
    while (!next.empty()) {
        PlanePolygon border;
        for (auto at = next.begin(); at != next.end();) {
            border.push_back(onPage(mesh.positions[at->first]));
            const std::uint32_t to = at->second;
            next.erase(at);
            at = next.find(to);
        }
        borders.push_back(std::move(border));
    }
    return borders;
}

std::optional<SheetLayout> sheetPlanOf(const Rig& rig) {
    const TriangleMesh& mesh = rig.restMesh();
    const Box box = boundingBox(mesh.positions);
    const std::vector<bool> top = levelAt(mesh, box.max.y, true);
    const std::vector<bool> bottom = levelAt(mesh, box.min.y, false);
    const std::optional<double> ledge = ledgeOf(mesh, box.max.y);
    if (!ledge || *ledge < box.min.y + kLevel || std::ranges::find(bottom, true) == bottom.end()) return std::nullopt;
    SheetLayout plan;
    std::vector<bool> still = top;
    double neutral = 0.5 * (*ledge + kUsualGap + box.max.y);
    const std::optional<ElasticSheet> joined = continuousSheetOf(rig);
    if (joined) {
        neutral = box.max.y - 0.5 * joined->layers.front().thickness;
        PlanePolygon pad;
        for (const glm::dvec2& corner : joined->pad) pad.push_back(pageOf(corner));
        const OutlineBox middle = boxOf(pad);
        for (std::size_t l = 0; l < joined->levers.size(); ++l)
            plan.flaps.push_back(flapOf(joined->levers[l], l, middle.middle()));
        plan.still = {std::move(pad)};
    }
    for (std::size_t a = 0; !joined && a < rig.actuatorCount(); ++a) {
        const Bend* bend = upwardBend(rig.actuators()[a]);
        if (bend == nullptr) return std::nullopt;
        plan.flaps.push_back(flapOf(rig, a, *bend, top));
        if (plan.flaps.back().triangles.empty()) return std::nullopt;
        neutral = bend->origin.y;
        std::vector<bool> moves(mesh.positions.size(), false);
        for (const Influence& influence : rig.actuators()[a].influences) moves[influence.vertex] = true;
        for (std::size_t t = 0; t < still.size(); ++t)
            for (int k = 0; k < 3; ++k) still[t] = still[t] && !moves[mesh.triangles[t][k]];
    }
    plan.ledge = 1e3 * (*ledge - box.min.y);
    plan.top = 1e3 * (static_cast<double>(box.max.y) - box.min.y);
    plan.underside = plan.top - 2e3 * (box.max.y - neutral);
    if (plan.underside < plan.ledge + kLeastSheet || plan.top < plan.underside + kLeastSheet) return std::nullopt;
    PlanePolygon corners;
    for (std::size_t t = 0; t < bottom.size(); ++t)
        for (int k = 0; bottom[t] && k < 3; ++k) corners.push_back(onPage(mesh.positions[mesh.triangles[t][k]]));
    plan.housing = convexHull(std::move(corners));
    plan.sheet = bordersOf(mesh, top);
    if (joined)
        for (const SheetFlap& flap : plan.flaps) plan.sheet.push_back(slotOf(flap));
    else
        plan.still = bordersOf(mesh, still);
    return plan;
}

} // namespace lumorph
