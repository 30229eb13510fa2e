#include "core/search/sheet_design.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rig/shape_report.h"
#include "core/rig/templates/sheet_file.h"
#include "core/rig/templates/sheet_outline.h"

namespace lumorph {
namespace {

constexpr double kShortestLine = 0.006; ///< metres, as the layout has it
constexpr double kConvex = 0.88;        ///< of a hull that so much of the sheet fills, the rest is slits

/// The angle up to which a sheet so thick bends in its arc, as `sheetRig` allows it.
Angle fullBend(const SheetDevice& sheet) {
    return Angle::radians(std::min(0.5 * std::numbers::pi, sheet.arc / (1.5 * sheet.thickness)));
}

double areaOfPolygon(const std::vector<glm::dvec2>& polygon) {
    double twice = 0.0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const glm::dvec2& a = polygon[k];
        const glm::dvec2& b = polygon[(k + 1) % polygon.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return 0.5 * std::abs(twice);
}

/// The top of a sheet device: triangles that look up, at its highest place.
struct LevelTop {
    std::vector<glm::dvec2> points;
    double area = 0.0;
    double height = 0.0;
};

LevelTop topOf(const TriangleMesh& mesh) {
    LevelTop top;
    top.height = static_cast<double>(boundingBox(mesh.positions).max.y);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        std::vector<glm::dvec2> corners;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 p(mesh.positions[mesh.triangles[t][k]]);
            if (p.y > top.height - 1e-4) corners.emplace_back(p.x, p.z);
        }
        if (corners.size() != 3 || !facesUp(mesh, t)) continue;
        top.area += areaOfPolygon(corners);
        top.points.insert(top.points.end(), corners.begin(), corners.end());
    }
    return top;
}

const Bend& bendOf(const Rig& rig, const Actuator& actuator) {
    const auto* bend = std::get_if<Bend>(&actuator.deformer);
    const bool flat = bend != nullptr && std::abs(glm::normalize(bend->axis).y) < 0.01F &&
                      glm::cross(glm::normalize(bend->axis), glm::normalize(bend->direction)).y > 0.99F;
    if (!flat)
        throw InvalidInput(rig.name() + ": " + inQuotes(actuator.name), "it is no flap of a flat sheet that bends up",
                           "give a sheet device, such as 'lumorph rig new sheet' and 'lumorph rig sheet' make");
    return *bend;
}

/// The line of a bend, as long as what it moves is wide there.
BendLine lineOfBend(const Rig& rig, std::size_t index, const Bend& bend) {
    const glm::dvec3 along = glm::normalize(glm::dvec3(bend.axis));
    const glm::dvec3 across = glm::normalize(glm::dvec3(bend.direction));
    const glm::dvec3 origin(bend.origin);
    double low = 0.0;
    double high = 0.0;
    for (const std::uint32_t v : rig.verticesOf(index)) {
        const glm::dvec3 from = glm::dvec3(rig.restMesh().positions[v]) - origin;
        if (glm::dot(from, across) > 0.5 * bend.length) continue;
        low = std::min(low, glm::dot(from, along));
        high = std::max(high, glm::dot(from, along));
    }
    const auto place = [&](double w) { return glm::dvec2(origin.x + w * along.x, origin.z + w * along.z); };
    BendLine line;
    line.name = rig.actuators()[index].name;
    line.from = place(low);
    line.to = place(high);
    line.ends = BendLine::Ends::free; // as wide as the flap is
    // On the page, where y is up, the left of the way along (x, -z) is where across points or the opposite.
    const glm::dvec2 pageAlong(along.x, -along.z);
    const glm::dvec2 pageAcross(across.x, -across.z);
    const double turn = pageAlong.x * pageAcross.y - pageAlong.y * pageAcross.x;
    if (turn < 0.0) std::swap(line.from, line.to);
    line.side = BendLine::Side::left;
    line.angle = bend.max;
    return line;
}

} // namespace

SheetDevice sheetDeviceOf(const Rig& rig) {
    SheetDevice device;
    if (rig.parts().sheet && !rig.parts().drawing.empty()) { // its lines, as those of a cut top
        device = parseSheetDevice(rig.parts().drawing, rig.name());
        device.top = SheetTop::cut;
        device.pad.clear();
        return device;
    }
    device.name = rig.name();
    const LevelTop top = topOf(rig.restMesh());
    device.outline = convexHull(top.points);
    if (device.outline.size() < 3 || top.area < kConvex * areaOfPolygon(device.outline))
        throw InvalidInput(rig.name(), "its top is no sheet with a convex outline",
                           "give the sheet's outline as a drawing (.svg) instead of the rig");
    for (std::size_t a = 0; a < rig.actuatorCount(); ++a) {
        const Bend& bend = bendOf(rig, rig.actuators()[a]);
        device.thickness = 2.0 * (top.height - static_cast<double>(bend.origin.y));
        device.arc = bend.length;
        device.bends.push_back(lineOfBend(rig, a, bend));
    }
    device.housing = top.height - device.thickness - kSheetAboveHousing;
    device.thickness = std::round(1e6 * device.thickness) / 1e6;
    device.housing = std::round(1e6 * device.housing) / 1e6;
    return device;
}

SheetDesigns::SheetDesigns(SheetDevice sheet, std::size_t most) : sheet_(std::move(sheet)), most_(most) {
    if (most == 0 || most > kMaxBendLines)
        throw InvalidInput(std::to_string(most) + " servos", "a design has 1 to " + std::to_string(kMaxBendLines),
                           "choose a number in that range");
    sheet_.bends.clear();
    sheet_.outline = checkedOutline(sheet_.outline, sheet_.name);
    clearance_ = flapClearance(sheet_);
    angle_ = fullBend(sheet_);
    SheetDevice widest = sheet_;
    widest.bends.emplace_back().angle = angle_;
    clearance_ = flapClearance(widest);
    glm::dvec2 high = sheet_.outline.front();
    low_ = high;
    for (const glm::dvec2& p : sheet_.outline) {
        low_ = glm::min(low_, p);
        high = glm::max(high, p);
        page_.push_back(pageOf(p));
    }
    size_ = high - low_;
}

std::vector<BendLine> SheetDesigns::linesOf(std::span<const double> point) const {
    std::vector<BendLine> lines;
    const double longest = glm::length(size_);
    for (std::size_t k = 0; k < most_; ++k) {
        const auto gene = point.subspan(k * kGenes, kGenes);
        if (gene[kThere] < 0.5) continue;
        const glm::dvec2 middle = low_ + size_ * glm::dvec2(gene[kMiddleX], gene[kMiddleZ]);
        const double turned = 2.0 * std::numbers::pi * gene[kDirection];
        const glm::dvec2 half = 0.5 * (kShortestLine + (longest - kShortestLine) * gene[kLength]) *
                                glm::dvec2(std::cos(turned), std::sin(turned));
        BendLine line;
        line.name = "flap " + std::to_string(lines.size() + 1);
        line.from = middle - half;
        line.to = middle + half;
        line.ends = gene[kEnds] < 0.5 ? BendLine::Ends::free : BendLine::Ends::joined;
        line.side = BendLine::Side::left;
        line.angle = angle_;
        lines.push_back(std::move(line));
    }
    return lines;
}

std::vector<Flap> SheetDesigns::layOut(std::vector<BendLine>& lines) const {
    try {
        return layOutFlaps(page_, lines, clearance_);
    } catch (const InvalidInput&) { // one by one, to see which has no room
    }
    std::vector<BendLine> kept;
    std::vector<Flap> flaps;
    for (const BendLine& line : lines) {
        kept.push_back(line);
        try {
            flaps = layOutFlaps(page_, kept, clearance_);
        } catch (const InvalidInput&) {
            kept.pop_back();
        }
    }
    lines = std::move(kept);
    return flaps;
}

std::vector<Flap> SheetDesigns::flapsOf(std::span<const double> point) const {
    std::vector<BendLine> lines = linesOf(point);
    return layOut(lines);
}

SheetDevice SheetDesigns::deviceOf(std::span<const double> point) const {
    SheetDevice device = sheet_;
    device.bends = linesOf(point);
    (void)layOut(device.bends);
    for (std::size_t k = 0; k < device.bends.size(); ++k) device.bends[k].name = "flap " + std::to_string(k + 1);
    return device;
}

std::vector<double> SheetDesigns::pointOf(const SheetDevice& device) const {
    std::vector<double> point(dimension(), 0.0);
    const double longest = glm::length(size_);
    for (std::size_t k = 0; k < std::min(most_, device.bends.size()); ++k) {
        const BendLine& line = device.bends[k];
        const glm::dvec2 middle = (0.5 * (line.from + line.to) - low_) / size_;
        const glm::dvec2 way = line.side == BendLine::Side::right ? line.from - line.to : line.to - line.from;
        const double turned = std::atan2(way.y, way.x) / (2.0 * std::numbers::pi);
        const double genes[kGenes] = {1.0,
                                      middle.x,
                                      middle.y,
                                      turned - std::floor(turned),
                                      (glm::length(way) - kShortestLine) / (longest - kShortestLine),
                                      line.ends == BendLine::Ends::free ? 0.25 : 0.75};
        for (std::size_t g = 0; g < kGenes; ++g) point[k * kGenes + g] = std::clamp(genes[g], 0.0, 1.0);
    }
    return point;
}

} // namespace lumorph
