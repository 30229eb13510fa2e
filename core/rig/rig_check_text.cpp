#include "core/rig/rig_check_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/base/text.h"

namespace lumorph {
namespace {

using Kind = RigFinding::Kind;

constexpr std::size_t kMostNames = 3;

std::string number(double value, const char* format = "%.1f") {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

std::string millimetres(double metres) { return number(1e3 * metres) + " mm"; }
std::string percent(double share) { return number(100.0 * share, "%.0f") + " %"; }
std::string metresASecond(double speed) { return number(speed, "%.2f") + " m/s"; }

std::string degrees(Angle angle) { return number(angle.inDegrees()) + " degrees"; }

/// Where an actuator stands at a stroke, in the unit of its range.
struct Standing {
    double stroke;
    std::string operator()(const Hinge& d) const { return degrees(between(d.min, d.max)); }
    std::string operator()(const Bend& d) const { return degrees(between(d.min, d.max)); }
    std::string operator()(const Slide& d) const { return millimetres(std::lerp(d.min, d.max, stroke)); }
    std::string operator()(const MorphTarget&) const { return number(stroke, "%.2f"); }
    std::string operator()(const SkinJoint& d) const {
        const double at = std::lerp(d.min, d.max, stroke);
        return d.motion == SkinJoint::Motion::rotate ? degrees(Angle::radians(at)) : millimetres(at);
    }
    std::string operator()(const SheetLift& d) const { return degrees(between(d.min, d.max)); }

private:
    [[nodiscard]] Angle between(Angle min, Angle max) const {
        return Angle::radians(std::lerp(min.inRadians(), max.inRadians(), stroke));
    }
};

std::string standing(const Rig& rig, std::size_t actuator, double stroke) {
    return std::visit(Standing{stroke}, rig.actuators()[actuator].deformer);
}

std::string joined(const std::vector<std::string>& parts) {
    std::string all;
    for (std::size_t k = 0; k < parts.size(); ++k)
        all += (k == 0 ? "" : k + 1 == parts.size() ? " and " : ", ") + parts[k];
    return all;
}

/// "'a'", "'a' and 'b'", "'a', 'b', 'c' and 5 others".
template <class Say> std::string listed(const std::vector<std::size_t>& actuators, const Say& say) {
    std::vector<std::string> parts;
    const std::size_t shown = actuators.size() > kMostNames + 1 ? kMostNames : actuators.size();
    for (std::size_t k = 0; k < shown; ++k) parts.push_back(say(actuators[k]));
    if (shown < actuators.size()) parts.push_back(std::to_string(actuators.size() - shown) + " others");
    return joined(parts);
}

std::string namesOf(const Rig& rig, const RigFinding& finding) {
    return listed(finding.actuators, [&](std::size_t a) { return inQuotes(rig.actuators()[a].name); });
}

/// "62.3 degrees" of one actuator with the level that stands there first, or where each of several stands.
std::string beginningOf(const Rig& rig, const RigFinding& finding) {
    const std::string where =
        listed(finding.actuators, [&](std::size_t a) { return standing(rig, a, finding.first[a]); });
    if (finding.actuators.size() != 1) return where;
    const std::size_t a = finding.actuators.front();
    const int levels = rig.actuators()[a].levels;
    const int level = std::min(levels - 1, static_cast<int>(std::ceil(finding.first[a] * (levels - 1) - 1e-9)));
    return where + " on (level " + std::to_string(level) + " of 0 to " + std::to_string(levels - 1) + ")";
}

std::string atRest(const RigFinding& finding) {
    switch (finding.kind) {
    case Kind::open:
        return "At rest the surface has a hole; its edges measure " + millimetres(finding.amount) + ".";
    case Kind::inverted:
        return "At rest " + number(finding.amount, "%.0f") + " triangles look inwards or have no area.";
    default:
        return "At rest the surface crosses itself, over " + millimetres(finding.amount) + ".";
    }
}

} // namespace

const char* nameOf(RigFinding::Kind kind) {
    constexpr const char* kNames[] = {"open", "inverted", "crossing", "collision", "stretch", "speed"};
    return kNames[static_cast<std::size_t>(kind)];
}

const char* unitOf(RigFinding::Kind kind) {
    constexpr const char* kUnits[] = {"m", "triangles", "m", "m", "1", "m/s"};
    return kUnits[static_cast<std::size_t>(kind)];
}

std::string sentenceOf(const Rig& rig, const RigFinding& finding) {
    if (finding.actuators.empty()) return atRest(finding);
    const bool alone = finding.actuators.size() == 1;
    const std::string names = namesOf(rig, finding);
    const std::string from = ", from " + beginningOf(rig, finding);
    const std::string over = "; at worst over " + millimetres(finding.amount) + ".";
    const std::string verb = alone ? "s" : " together";
    switch (finding.kind) {
    case Kind::open:
        return names + " open" + verb + " a seam of the surface" + from + "; at worst by " +
               millimetres(finding.amount) + ".";
    case Kind::inverted:
        return names + (alone ? " turns" : " together turn") + " a part inside out or squeeze" + (alone ? "s" : "") +
               " it flat" + from + "; " + number(finding.amount, "%.0f") + " triangles.";
    case Kind::crossing:
        return "What " + names + (alone ? " moves" : " move together") + " crosses itself" + from + over;
    case Kind::collision:
        return names + (alone ? " runs into a part that stands still" : " collide") + from + over;
    case Kind::stretch:
        return names + " stretch" + (alone ? "es" : " together") + " the surface by up to " + percent(finding.amount) +
               ", more than " + percent(finding.limit) + from + ".";
    case Kind::speed:
        return names + " moves a point at " + metresASecond(finding.amount) +
               ", which startles who is near: more than " + metresASecond(finding.limit) +
               (finding.first[finding.actuators.front()] > 0.0 ? from : "") + ".";
    }
    return {};
}

std::string remedyOf(const Rig& rig, const RigFinding& finding) {
    const std::string inModeller = " in a modeller";
    if (finding.actuators.empty())
        return (finding.kind == Kind::open       ? "Close the hole"
                : finding.kind == Kind::inverted ? "Turn these faces outwards, or remove them,"
                                                 : "Unite the parts that overlap") +
               inModeller + ", and open the rig again.";
    const bool alone = finding.actuators.size() == 1;
    const std::size_t a = finding.actuators.front();
    const std::string narrow = alone ? "Let the range of " + inQuotes(rig.actuators()[a].name) + " end at " +
                                           standing(rig, a, finding.first[a])
                                     : std::string("Narrow the range of one of them");
    switch (finding.kind) {
    case Kind::open:
        return "Let both sides of the seam follow the same actuators" + inModeller + ". Or: " + narrow + ".";
    case Kind::inverted:
    case Kind::crossing:
        return narrow + ", or spread its motion over more of the mesh.";
    case Kind::collision:
        return narrow + ", or make room there" + (alone ? "." : ": move them apart, or cut their corners.");
    case Kind::stretch:
        return narrow + ", spread the motion over more of the surface, or take a material that gives more.";
    case Kind::speed: {
        const double seconds = finding.amount / finding.limit / rig.actuators()[a].maxVelocity;
        return finding.limit > 0.0 ? "Let its full stroke take " +
                                         number(std::ceil(100.0 * seconds - 0.01) / 100.0, "%.2f") + " s or more."
                                   : "Let it stand still, or allow a speed above zero.";
    }
    }
    return {};
}

} // namespace lumorph
