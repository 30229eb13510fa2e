#include "core/rig/templates/continuous_sheet.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/geometry/plane_mesh.h"
#include "core/rig/servo_types.h"
#include "core/rig/sheet/joint_states.h"
#include "core/rig/templates/flap_layout.h"
#include "core/rig/templates/sheet_file.h"
#include "core/rig/templates/sheet_outline.h"
#include "core/rig/templates/sound_rig.h"

namespace lumorph {
namespace {

// Metres.
constexpr double kPadGap = 0.003; ///< from the rim and the bend lines to a pad that is not drawn
constexpr double kSamePoint = 1e-5;
constexpr double kLeastPad = 5e-5; ///< square metres
constexpr double kLongestSlot = 0.03;
constexpr double kGoodSlot = 0.008;
constexpr double kShortestSlot = 0.004;
constexpr double kSlotGap = 0.002;    ///< of sheet beside the ends of a slot
constexpr double kFirstInset = 0.006; ///< of sheet between a slot and the rim
constexpr double kMostLift = 0.0358;
constexpr double kLiftOfWay = 0.8;    ///< lift as a share of the way from the pad
constexpr double kShaftBelow = 0.008; ///< the shaft under the sheet at rest
constexpr double kShortestArm = 0.016;
constexpr double kSteepest = 69.0; ///< degrees of an arm at full stroke
constexpr double kHousingMargin = 0.0005;
constexpr int kWallShares = 6;
constexpr int kWallRows = 4;
constexpr double kLoadedSpeed = 120.0; ///< degrees a second of a small servo under load

/// How far below the rim a row of the wall under it lies at rest, as a share of the wall's height.
double wallDepth(double share) {
    const double left = 1.0 - share;
    return left * (1.1 - 0.1 * left);
}

/// What of a polygon lies behind a line; `ahead` points to the side that goes.
std::vector<glm::dvec2> behind(const std::vector<glm::dvec2>& polygon, const glm::dvec2& on, const glm::dvec2& ahead) {
    std::vector<glm::dvec2> kept;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const glm::dvec2& a = polygon[k];
        const glm::dvec2& b = polygon[(k + 1) % polygon.size()];
        const double before = glm::dot(a - on, ahead);
        const double after = glm::dot(b - on, ahead);
        if (before <= 0.0) kept.push_back(a);
        if ((before < 0.0 && after > 0.0) || (before > 0.0 && after < 0.0))
            kept.push_back(a + (b - a) * (before / (before - after)));
    }
    return kept;
}

/// A polygon whose sides have moved inwards.
std::vector<glm::dvec2> inset(const std::vector<glm::dvec2>& polygon, double by) {
    const double turn = signedArea(polygon) > 0.0 ? 1.0 : -1.0;
    const auto inwards = [&](const glm::dvec2& a, const glm::dvec2& b) {
        const glm::dvec2 along = glm::normalize(b - a);
        return turn * glm::dvec2(-along.y, along.x);
    };
    std::vector<glm::dvec2> moved;
    const std::size_t count = polygon.size();
    for (std::size_t k = 0; k < count; ++k) {
        const glm::dvec2 in = inwards(polygon[(k + count - 1) % count], polygon[k]);
        const glm::dvec2 out = inwards(polygon[k], polygon[(k + 1) % count]);
        moved.push_back(polygon[k] + (in + out) * (by / std::max(0.2, 1.0 + glm::dot(in, out))));
    }
    return moved;
}

/// The pad that is drawn; without one, what lies behind all bend lines.
std::vector<glm::dvec2> padOf(const SheetDevice& device, const std::vector<Flap>& flaps) {
    if (!device.pad.empty()) return device.pad;
    std::vector<glm::dvec2> still;
    for (const glm::dvec2& p : device.outline) still.push_back(pageOf(p));
    for (const Flap& flap : flaps) still = behind(still, flap.frame.origin, flap.frame.across);
    const auto same = [](const glm::dvec2& a, const glm::dvec2& b) { return glm::distance(a, b) < 1e3 * kSamePoint; };
    // Not std::ranges::unique: clang 14, which builds the fuzzers, cannot read its result.
    still.erase(std::unique(still.begin(), still.end(), same), still.end());
    if (still.size() > 1 && same(still.front(), still.back())) still.pop_back();
    std::vector<glm::dvec2> pad;
    if (still.size() >= 3)
        for (const glm::dvec2& p : inset(still, 1e3 * kPadGap)) pad.push_back(placeOf(p));
    // Where it is narrower than twice the inset it is turned inside out; a page is a mirror image of the device.
    const bool turned = !pad.empty() && signedArea(still) * signedArea(pad) > 0.0;
    if (pad.empty() || turned || std::abs(signedArea(pad)) < kLeastPad)
        throw InvalidInput("sheet: pad", "behind the bend lines nothing is left to clamp the sheet on",
                           "move the bend lines outwards, or make the sheet larger");
    return pad;
}

double distanceTo(const std::vector<glm::dvec2>& polygon, const glm::dvec2& p) {
    double least = 1e9;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const glm::dvec2& a = polygon[k];
        const glm::dvec2 way = polygon[(k + 1) % polygon.size()] - a;
        const double share = std::clamp(glm::dot(p - a, way) / glm::dot(way, way), 0.0, 1.0);
        least = std::min(least, glm::distance(p, a + share * way));
    }
    return least;
}

/// The widest piece of a flap at a distance from its bend line: its ends along the line, in millimetres.
std::optional<std::pair<double, double>> widestAt(const Flap& flap, double u) {
    std::vector<double> ends;
    for (std::size_t k = 0; k < flap.rim.size(); ++k) {
        const glm::dvec2& a = flap.rim[k];
        const glm::dvec2& b = flap.rim[(k + 1) % flap.rim.size()];
        if ((a.y > u) != (b.y > u)) ends.push_back(a.x + (b.x - a.x) * (u - a.y) / (b.y - a.y));
    }
    std::ranges::sort(ends);
    std::optional<std::pair<double, double>> widest;
    for (std::size_t k = 0; k + 1 < ends.size(); k += 2)
        if (!widest || ends[k + 1] - ends[k] > widest->second - widest->first) widest = {ends[k], ends[k + 1]};
    return widest;
}

/// The slot of a flap's lever: as near to its far end as there is room for a good one.
std::pair<glm::dvec2, glm::dvec2> slotOf(const Flap& flap) {
    double depth = 0.0;
    for (const glm::dvec2& p : flap.rim) depth = std::max(depth, p.y);
    double longest = 0.0, at = 0.0, middle = 0.0;
    for (double u = depth - 1e3 * kFirstInset; u > 0.4 * depth && longest < 1e3 * kGoodSlot; u -= 0.25) {
        const auto piece = widestAt(flap, u);
        if (!piece) continue;
        const double length = std::min(1e3 * kLongestSlot, piece->second - piece->first - 2e3 * kSlotGap);
        if (length <= longest) continue;
        longest = length;
        at = u;
        middle = 0.5 * (piece->first + piece->second);
    }
    if (longest < 1e3 * kShortestSlot)
        throw InvalidInput("bend line " + inQuotes(flap.name), "the part that it moves has no room for a lever's slot",
                           "move the line, so that the part is at least 15 mm deep and 10 mm wide");
    const auto end = [&](double way) { return placeOf(flap.frame.page({middle + 0.5 * way * longest, at})); };
    return {end(-1.0), end(1.0)};
}

SheetLever leverOf(const Flap& flap, const std::vector<glm::dvec2>& pad) {
    SheetLever lever;
    lever.name = flap.name;
    std::tie(lever.from, lever.to) = slotOf(flap);
    const double way = std::min(distanceTo(pad, lever.from), distanceTo(pad, lever.to));
    const double lift = std::min(kMostLift, kLiftOfWay * way) * std::sin(flap.angle.inRadians());
    lever.arm = std::max(kShortestArm, (lift + kShaftBelow) / std::sin(Angle::degrees(kSteepest).inRadians()));
    lever.rest = Angle::radians(std::asin(kShaftBelow / lever.arm));
    lever.end = Angle::radians(std::asin((kShaftBelow + lift) / lever.arm));
    return lever;
}

/// The mesh of the sheet and what hangs under it.
class SolidBuilder {
public:
    SolidBuilder(const SheetDevice& device, const JointStates& states)
        : device_(device), mesh_(states.mesh), motion_{states.modes, {}},
          top_(device.housing + kSheetAboveHousing + device.thickness) {}

    void build(RigParts& parts) {
        for (std::uint32_t node = 0; node < mesh_.points.size(); ++node)
            addVertex(mesh_.points[node], top_, node, 1.0F);
        for (const glm::uvec3& t : mesh_.triangles) solid_.triangles.push_back(t);
        addSkirt();
        addHousing();
        parts.restMesh = std::move(solid_);
        parts.sheet = std::move(motion_);
    }

private:
    std::uint32_t addVertex(const glm::dvec2& place, double y, std::uint32_t row = SheetMotion::kNoRow,
                            float share = 1.0F) {
        solid_.positions.emplace_back(place.x, y, place.y);
        motion_.followers.push_back({row, share});
        return static_cast<std::uint32_t>(solid_.positions.size() - 1);
    }

    /// The nodes of the rim, counter-clockwise seen from above.
    [[nodiscard]] std::vector<std::uint32_t> rim() const {
        std::unordered_set<std::uint64_t> edges;
        const auto key = [](std::uint64_t a, std::uint64_t b) { return a << 32 | b; };
        for (const glm::uvec3& t : mesh_.triangles)
            for (int k = 0; k < 3; ++k) edges.insert(key(t[k], t[(k + 1) % 3]));
        std::unordered_map<std::uint32_t, std::uint32_t> next;
        for (const glm::uvec3& t : mesh_.triangles)
            for (int k = 0; k < 3; ++k)
                if (!edges.contains(key(t[(k + 1) % 3], t[k]))) next[t[k]] = t[(k + 1) % 3];
        std::vector<std::uint32_t> loop{std::ranges::min_element(next)->first};
        while (next.at(loop.back()) != loop.front()) loop.push_back(next.at(loop.back()));
        return loop;
    }

    /// Rows under the rim that follow its path at shares of it, and a foot on the housing that stays. They keep below
    /// that path, so that the wall rises from row to row where the rim slides in the plane, or sinks a little between
    /// the states that were solved; the last share of the way has no row, for there the wall would touch the sheet.
    void addSkirt() {
        for (const std::uint32_t node : rim()) {
            const glm::dvec2 place = mesh_.points[node];
            std::vector<std::uint32_t> column{addVertex(place, device_.housing)};
            for (int row = 1; row <= kWallRows; ++row) {
                const float share = static_cast<float>(row) / kWallShares;
                column.push_back(addVertex(place, std::lerp(top_, device_.housing, wallDepth(share)), node, share));
            }
            column.push_back(node);
            columns_.push_back(std::move(column));
        }
        for (std::size_t k = 0; k < columns_.size(); ++k)
            addWall(columns_[k], columns_[(k + 1) % columns_.size()], solid_.triangles);
    }

    void addHousing() {
        std::vector<std::uint32_t> vertices;
        std::vector<glm::dvec2> border, points; // x to the right, y away from the viewer
        std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
        const auto addLoop = [&](std::size_t first) {
            for (std::size_t k = first; k < points.size(); ++k)
                edges.emplace_back(k, k + 1 < points.size() ? k + 1 : first);
        };
        for (const std::vector<std::uint32_t>& column : columns_) {
            vertices.push_back(column.front());
            const glm::vec3& p = solid_.positions[column.front()];
            points.emplace_back(p.x, -p.z);
        }
        border = points;
        addLoop(0);
        std::vector<std::uint32_t> low;
        for (const glm::dvec2& p : grownHull(border, kHousingMargin)) {
            points.push_back(p);
            vertices.push_back(addVertex({p.x, -p.y}, device_.housing));
            low.push_back(addVertex({p.x, -p.y}, 0.0));
        }
        addLoop(border.size());
        const auto high = std::span(vertices).subspan(border.size());
        for (std::size_t k = 0; k < low.size(); ++k) {
            const std::size_t n = (k + 1) % low.size();
            solid_.triangles.emplace_back(low[k], low[n], high[n]);
            solid_.triangles.emplace_back(low[k], high[n], high[k]);
        }
        for (std::size_t k = 1; k + 1 < low.size(); ++k) solid_.triangles.emplace_back(low[0], low[k + 1], low[k]);
        const auto onLedge = [&](const glm::dvec2& p) { return !insidePolygon(border, p); };
        for (const glm::uvec3& t : triangulatePlane(points, edges, onLedge))
            solid_.triangles.emplace_back(vertices[t.x], vertices[t.y], vertices[t.z]);
    }

    const SheetDevice& device_;
    const SheetMesh& mesh_;
    SheetMotion motion_;
    double top_;
    TriangleMesh solid_;
    std::vector<std::vector<std::uint32_t>> columns_; ///< of each node of the rim, the foot first
};

Actuator actuatorOf(const SheetLever& lever, const LeverLoad& load, int axis) {
    const ServoType* servo = cheapestServo(load.torque);
    if (servo == nullptr)
        throw InvalidInput("lever " + inQuotes(lever.name),
                           "no servo of the table holds the " + std::to_string(std::lround(1e3 * load.torque)) +
                               " mN m that it needs, with half of its stall torque",
                           "choose a thinner sheet or a softer material, or let it lift less");
    Actuator actuator;
    actuator.name = lever.name;
    actuator.deformer = SheetLift{axis, lever.rest, lever.end, load.torque};
    const double turn = lever.end.inDegrees() - lever.rest.inDegrees();
    actuator.maxVelocity = kLoadedSpeed / turn;
    // Around the middle of its travel.
    const double half = 0.5 * turn / servo->travel.inDegrees() * (servo->pulseMax - servo->pulseMin);
    const double middle = 0.5 * (servo->pulseMin + servo->pulseMax);
    actuator.drive = {axis, std::round(middle - half), std::round(middle + half), std::string(servo->name)};
    return actuator;
}

/// How finely to solve it.
BakeSettings bakeSettings(const SheetDevice& device, SheetQuality quality) {
    // Edges as long as give a sheet without holes about 380 nodes; 100 in a preview.
    const double side = std::sqrt(std::abs(signedArea(device.outline)));
    if (quality == SheetQuality::preview) return {side / 8.8, 2, 1e-3};
    return {side / 17.6, device.bends.size() <= 2 ? 5 : device.bends.size() <= 4 ? 4 : 3, 2e-4};
}

} // namespace

ElasticSheet elasticSheetOf(const SheetDevice& device) {
    const std::vector<glm::dvec2> outline = checkedOutline(device.outline, "sheet");
    std::vector<glm::dvec2> page;
    page.reserve(outline.size());
    for (const glm::dvec2& p : outline) page.push_back(pageOf(p));
    const std::vector<Flap> flaps = layOutFlaps(page, device.bends, {}); // nothing is cut: no slit needs room
    ElasticSheet sheet;
    sheet.outline = outline;
    sheet.pad = padOf(device, flaps);
    for (const glm::dvec2& p : sheet.pad)
        if (!insidePolygon(outline, p) || distanceTo(outline, p) < 1e-3)
            throw InvalidInput("sheet: pad", "it reaches the sheet's rim", "keep it 1 mm or more inside");
    sheet.layers = {{sheetMaterial(device.material), device.thickness}};
    for (const Flap& flap : flaps) sheet.levers.push_back(leverOf(flap, sheet.pad));
    return sheet;
}

Rig continuousSheet(const SheetDevice& device, SheetQuality quality, const Progress& progress) {
    const ElasticSheet sheet = elasticSheetOf(device);
    const JointStates states = bakeJointStates(sheet, bakeSettings(device, quality), progress.part(0.0, 0.95));
    RigParts parts;
    parts.name = device.name;
    SolidBuilder(device, states).build(parts);
    parts.pathInside = true;
    parts.drawing = writeSheetDevice(device);
    for (std::size_t l = 0; l < sheet.levers.size(); ++l)
        parts.actuators.push_back(actuatorOf(sheet.levers[l], states.largestLoads[l], static_cast<int>(l)));
    Rig rig(std::move(parts));
    requireSound(rig, progress.part(0.95, 1.0));
    return rig;
}

} // namespace lumorph
