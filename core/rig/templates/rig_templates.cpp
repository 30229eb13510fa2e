#include "core/rig/templates/rig_templates.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rig/templates/bundled_rigs.h"
#include "core/rig/templates/sheet_device.h"
#include "core/rig/templates/sheet_outline.h"
#include "core/rig/templates/sound_rig.h"

namespace lumorph {
namespace {

using Unit = TemplateParameter::Unit;
using Values = std::map<std::string_view, double>; ///< in the parameters' units, all of them

/// How the top is made: its words in the order of SheetTop.
TemplateParameter topParameter(SheetTop without) {
    return {"top",
            "one elastic sheet, or cut into flaps",
            Unit::word,
            static_cast<double>(without),
            0.0,
            1.0,
            {"cut", "continuous"}};
}

SheetTop topOf(const Values& values) { return static_cast<SheetTop>(static_cast<int>(values.at("top"))); }

/// What means something with one kind of top only.
TemplateParameter onlyWith(SheetTop top, TemplateParameter parameter) {
    parameter.onlyWith = static_cast<int>(top);
    return parameter;
}

/// What all sheet devices have.
std::vector<TemplateParameter> withSheet(std::vector<TemplateParameter> parameters, double thickness, double housing,
                                         double arc) {
    parameters.insert(parameters.begin(), topParameter(SheetTop::cut));
    parameters.push_back({"thickness", "thickness of the sheet", Unit::centimetres, thickness, 0.02, 2.0});
    parameters.push_back({"housing", "height of the housing", Unit::centimetres, housing, 0.1, 50.0});
    if (arc > 0.0) {
        parameters.push_back(
            onlyWith(SheetTop::cut, {"arc", "length of sheet that a bend curves", Unit::centimetres, arc, 0.2, 20.0}));
        parameters.push_back({"angle", "how far a flap bends up", Unit::degrees, 90.0, 1.0, 90.0});
    }
    return parameters;
}

const std::vector<RigTemplate>& templates() {
    static const TabletSize tablet;
    static const PinDisplaySize pins;
    static const CushionSize cushion;
    static const std::vector<RigTemplate> kinds{
        {"tablet",
         "a sheet with four corners and two long edges that bend up",
         {topParameter(SheetTop::continuous),
          {"width", "width", Unit::centimetres, tablet.width, 5.0, 100.0},
          {"depth", "depth", Unit::centimetres, tablet.depth, 5.0, 100.0},
          onlyWith(SheetTop::continuous, {"thickness", "thickness of the sheet", Unit::centimetres, 0.2, 0.02, 0.5}),
          onlyWith(SheetTop::cut,
                   {"reach", "height that the edges reach, upright", Unit::centimetres, tablet.reach, 2.0, 100.0}),
          onlyWith(SheetTop::cut, {"cornerX", "where a corner's bend line ends, along the width", Unit::centimetres,
                                   tablet.cornerAlongWidth, 1.0, 50.0}),
          onlyWith(SheetTop::cut, {"cornerZ", "where a corner's bend line ends, along the depth", Unit::centimetres,
                                   tablet.cornerAlongDepth, 1.0, 50.0})}},
        {"phone", "a small rounded sheet with four corners that bend up",
         withSheet({{"width", "width of the sheet", Unit::centimetres, 7.5, 3.0, 50.0},
                    {"depth", "depth of the sheet", Unit::centimetres, 15.0, 3.0, 50.0},
                    {"corner", "where a corner's bend line ends, along both edges", Unit::centimetres, 3.2, 1.0, 25.0},
                    {"rounding", "radius of the corners", Unit::centimetres, 0.8, 0.0, 10.0}},
                   0.1, 0.8, 1.0)},
        {"pins",
         "a display of pins that slide up",
         {{"columns", "pins side by side", Unit::count, static_cast<double>(pins.columns), 1.0, 200.0},
          {"rows", "pins from back to front", Unit::count, static_cast<double>(pins.rows), 1.0, 200.0},
          {"pitch", "from pin to pin", Unit::centimetres, pins.pitch, 0.06, 20.0},
          {"pin", "side of a pin", Unit::centimetres, pins.pin, 0.05, 20.0},
          {"stroke", "way of a pin", Unit::centimetres, pins.stroke, 0.1, 100.0},
          {"plate", "height of the plate", Unit::centimetres, pins.plate, 0.1, 50.0}}},
        {"flower", "petals around a middle, that close upwards",
         withSheet({{"petals", "number of petals", Unit::count, 5.0, 3.0, 12.0},
                    {"diameter", "from tip to opposite tip", Unit::centimetres, 24.0, 5.0, 150.0},
                    {"middle", "width of the middle, which stays", Unit::centimetres, 9.0, 2.0, 100.0}},
                   0.2, 1.6, 2.0)},
        {"book", "two leaves that stand up on both sides of a spine",
         withSheet({{"width", "width of the sheet, open", Unit::centimetres, 30.0, 6.0, 150.0},
                    {"depth", "depth of the sheet", Unit::centimetres, 20.0, 3.0, 150.0},
                    {"spine", "width of the spine, which stays", Unit::centimetres, 2.0, 0.2, 50.0}},
                   0.2, 1.6, 2.0)},
        {"cushion",
         "chambers that swell",
         {{"width", "width", Unit::centimetres, cushion.width, 1.0, 200.0},
          {"depth", "depth", Unit::centimetres, cushion.depth, 1.0, 200.0},
          {"height", "height at rest", Unit::centimetres, cushion.height, 0.1, 100.0},
          {"swell", "height that a chamber gains", Unit::centimetres, cushion.swell, 0.1, 100.0},
          {"columns", "chambers side by side", Unit::count, static_cast<double>(cushion.columns), 1.0, 20.0},
          {"rows", "chambers from back to front", Unit::count, static_cast<double>(cushion.rows), 1.0, 20.0}}},
        {"sheet", "a blank sheet on a housing, to draw bend lines on",
         withSheet({{"width", "width of the sheet", Unit::centimetres, 21.0, 2.0, 200.0},
                    {"depth", "depth of the sheet", Unit::centimetres, 15.0, 2.0, 200.0},
                    {"rounding", "radius of the corners", Unit::centimetres, 0.0, 0.0, 100.0}},
                   0.2, 1.6, 0.0)},
    };
    return kinds;
}

SheetDevice sheetOf(const RigTemplate& kind, const Values& values) {
    SheetDevice device;
    device.name = kind.name;
    device.top = topOf(values);
    device.thickness = 0.01 * values.at("thickness");
    device.housing = 0.01 * values.at("housing");
    if (values.contains("arc")) device.arc = 0.01 * values.at("arc");
    return device;
}

void requireTemplate(bool good, const RigTemplate& kind, const char* parameter, const char* why, const char* remedy) {
    if (!good) throw InvalidInput(std::string(kind.name) + ": " + parameter, why, remedy);
}

SheetDevice phone(const RigTemplate& kind, const Values& values) {
    SheetDevice device = sheetOf(kind, values);
    const double width = 0.01 * values.at("width");
    const double depth = 0.01 * values.at("depth");
    const double corner = 0.01 * values.at("corner");
    const double rounding = 0.01 * values.at("rounding");
    requireTemplate(2.0 * corner < std::min(width, depth) - 0.01, kind, "corner", "nothing would be left between two",
                    "choose a smaller one, or a larger sheet");
    requireTemplate(corner - (2.0 - std::numbers::sqrt2) * rounding >= 0.01, kind, "corner", "the corners would vanish",
                    "choose a larger one, or less rounding");
    device.outline = rectangleOutline(width, depth, rounding);
    for (const auto& [name, x, z] : {std::tuple("corner front left", -1, 1), std::tuple("corner front right", 1, 1),
                                     std::tuple("corner back left", -1, -1), std::tuple("corner back right", 1, -1)}) {
        BendLine bend;
        bend.name = name;
        bend.from = {x * (0.5 * width - corner), z * 0.5 * depth};
        bend.to = {x * 0.5 * width, z * (0.5 * depth - corner)};
        device.bends.push_back(bend);
    }
    return device;
}

/// The middle is a regular polygon with a petal on each side: straight at its foot, then half an ellipse.
SheetDevice flower(const RigTemplate& kind, const Values& values) {
    SheetDevice device = sheetOf(kind, values);
    const int petals = static_cast<int>(values.at("petals"));
    const double apothem = 0.005 * values.at("middle");
    const double tip = 0.005 * values.at("diameter");
    const double half = apothem * std::tan(std::numbers::pi / petals) - 0.006; // of a petal's foot
    constexpr double kFoot = 0.008; // so far from the middle's edge is the bend line
    requireTemplate(half >= 0.006, kind, "middle", "the petals would be too narrow",
                    "choose a larger one, or fewer petals");
    requireTemplate(tip - apothem - 2.0 * kFoot >= 0.01, kind, "diameter", "the petals would vanish",
                    "choose a larger one, or a smaller middle");
    const double length = tip - apothem - kFoot;
    constexpr int kSteps = 12;
    for (int petal = 0; petal < petals; ++petal) {
        const double angle = 2.0 * std::numbers::pi * petal / petals;
        const glm::dvec2 out(std::sin(angle), std::cos(angle)); // the first one points to the viewer
        const glm::dvec2 side(out.y, -out.x);
        const auto at = [&](double w, double u) { return w * side + (apothem + u) * out; };
        device.outline.push_back(at(-half, 0.0));
        for (int k = 0; k <= kSteps; ++k) {
            const double turn = std::numbers::pi * k / kSteps;
            device.outline.push_back(at(-half * std::cos(turn), kFoot + length * std::sin(turn)));
        }
        device.outline.push_back(at(half, 0.0));
        BendLine bend;
        bend.name = "petal " + std::to_string(petal + 1);
        bend.from = at(-half, kFoot);
        bend.to = at(half, kFoot);
        device.bends.push_back(bend);
    }
    return device;
}

SheetDevice book(const RigTemplate& kind, const Values& values) {
    SheetDevice device = sheetOf(kind, values);
    const double width = 0.01 * values.at("width");
    const double depth = 0.01 * values.at("depth");
    const double spine = 0.01 * values.at("spine");
    requireTemplate(width - spine >= 0.04, kind, "spine", "the leaves would vanish",
                    "choose a smaller one, or a larger width");
    requireTemplate(spine >= 0.012, kind, "spine", "the leaves would touch", "choose 1.2 cm or more");
    device.outline = rectangleOutline(width, depth);
    for (const auto& [name, x] : {std::pair("left leaf", -1), std::pair("right leaf", 1)}) {
        BendLine bend;
        bend.name = name;
        bend.from = {0.5 * x * spine, -0.5 * depth};
        bend.to = {0.5 * x * spine, 0.5 * depth};
        device.bends.push_back(bend);
    }
    return device;
}

SheetDevice blank(const RigTemplate& kind, const Values& values) {
    SheetDevice device = sheetOf(kind, values);
    device.outline =
        rectangleOutline(0.01 * values.at("width"), 0.01 * values.at("depth"), 0.01 * values.at("rounding"));
    return device;
}

Values valuesOf(const RigTemplate& kind, std::span<const TemplateChoice> choices) {
    Values values;
    for (const TemplateParameter& parameter : kind.parameters) values[parameter.name] = parameter.value;
    for (const auto& [name, value] : choices) {
        const auto parameter = std::ranges::find(kind.parameters, name, &TemplateParameter::name);
        if (parameter == kind.parameters.end()) {
            std::string names;
            for (const TemplateParameter& known : kind.parameters)
                names += (names.empty() ? "" : ", ") + std::string(known.name);
            throw InvalidInput(std::string(kind.name) + ": " + inQuotes(name), "there is no such parameter",
                               "choose of " + names);
        }
        const auto tell = [](double number) {
            std::string text = std::to_string(number);
            text.erase(text.find_last_not_of('0') + 1);
            if (text.back() == '.') text.pop_back();
            return text;
        };
        const bool counts = parameter->unit == Unit::count || parameter->unit == Unit::word;
        const bool whole = !counts || value == std::floor(value);
        if (!std::isfinite(value) || value < parameter->min || value > parameter->max || !whole)
            throw InvalidInput(std::string(kind.name) + ": " + name,
                               std::isfinite(value) ? tell(value) + " cannot be" : "it is no finite number",
                               "choose a " + std::string(counts ? "whole " : "") + "number from " +
                                   tell(parameter->min) + " to " + tell(parameter->max));
        values[parameter->name] = value;
    }
    for (const auto& [name, value] : choices) {
        const auto parameter = std::ranges::find(kind.parameters, name, &TemplateParameter::name);
        if (!applies(kind, *parameter, choices))
            throw InvalidInput(std::string(kind.name) + ": " + name, "a top that is not so has no such measure",
                               "leave it out, or choose top=" +
                                   std::string(topParameter(SheetTop::cut).words[parameter->onlyWith]));
    }
    return values;
}

Rig tabletOf(const Values& values, const Progress& progress, SheetQuality quality) {
    const auto at = [&](std::string_view name) { return values.at(name); };
    if (topOf(values) == SheetTop::cut) {
        Rig rig = cutTabletRig({at("width"), at("depth"), at("reach"), at("cornerX"), at("cornerZ")});
        requireSound(rig, progress);
        return rig;
    }
    const SheetDevice drawing = tabletDrawing(0.01 * at("width"), 0.01 * at("depth"), 0.01 * at("thickness"));
    return drawing == tabletDrawing() ? bakedTablet() : sheetRig(drawing, progress, quality);
}

} // namespace

std::span<const RigTemplate> rigTemplates() { return templates(); }

const RigTemplate& rigTemplate(std::string_view name) {
    const auto found = std::ranges::find(templates(), name, &RigTemplate::name);
    if (found != templates().end()) return *found;
    std::string names;
    for (const RigTemplate& kind : templates()) names += (names.empty() ? "" : ", ") + std::string(kind.name);
    throw InvalidInput(inQuotes(name), "there is no such template", "choose one of " + names);
}

TemplateChoice parseChoice(const RigTemplate& kind, std::string_view text) {
    const auto wrong = [&](const char* remedy) {
        throw InvalidInput(std::string(kind.name) + ": " + inQuotes(text), "it is no parameter with a value", remedy);
    };
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos || equals == 0) wrong("write it as width=21cm");
    const std::string_view number = text.substr(equals + 1);
    const std::string name(text.substr(0, equals));
    const auto parameter = std::ranges::find(kind.parameters, name, &TemplateParameter::name);
    if (parameter != kind.parameters.end() && parameter->unit == Unit::word) {
        const auto word = std::ranges::find(parameter->words, number);
        if (word != parameter->words.end()) return {name, static_cast<double>(word - parameter->words.begin())};
        std::string words;
        for (const std::string_view one : parameter->words) words += (words.empty() ? "" : " or ") + std::string(one);
        throw InvalidInput(std::string(kind.name) + ": " + name, inQuotes(number) + " is none of its choices",
                           "choose " + words);
    }
    double value = 0.0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (error != std::errc()) wrong("write it as width=21cm");
    const std::string_view unit(end, static_cast<std::size_t>(number.data() + number.size() - end));
    const Unit known = parameter == kind.parameters.end() ? Unit::centimetres : parameter->unit;
    if (unit.empty()) return {name, value};
    if (known == Unit::degrees && unit == "deg") return {name, value};
    if (known == Unit::centimetres && unit == "cm") return {name, value};
    if (known == Unit::centimetres && unit == "mm") return {name, value / 10.0};
    if (known == Unit::centimetres && unit == "m") return {name, value * 100.0};
    if (known == Unit::centimetres) wrong("lengths are in mm, cm or m");
    if (known == Unit::degrees) wrong("angles are in deg");
    wrong("a number of parts has no unit");
    return {};
}

bool applies(const RigTemplate& kind, const TemplateParameter& parameter, std::span<const TemplateChoice> choices) {
    if (parameter.onlyWith < 0) return true;
    double word = 0.0;
    for (const TemplateParameter& one : kind.parameters) {
        if (one.unit != Unit::word) continue;
        word = one.value;
        for (const auto& [name, value] : choices)
            if (name == one.name) word = value;
    }
    return word == parameter.onlyWith;
}

Rig rigOf(const RigTemplate& kind, std::span<const TemplateChoice> choices, const Progress& progress,
          SheetQuality quality) {
    const Values values = valuesOf(kind, choices);
    const auto at = [&](std::string_view name) { return values.at(name); };
    const auto count = [&](std::string_view name) { return static_cast<int>(values.at(name)); };
    const auto looked = [&](Rig rig) {
        requireSound(rig, progress);
        return rig;
    };
    if (kind.name == "tablet") return tabletOf(values, progress, quality);
    if (kind.name == "pins")
        return looked(
            pinDisplayRig({count("columns"), count("rows"), at("pitch"), at("pin"), at("stroke"), at("plate")}));
    if (kind.name == "cushion")
        return looked(
            cushionRig({at("width"), at("depth"), at("height"), at("swell"), count("columns"), count("rows")}));
    SheetDevice device = kind.name == "phone"    ? phone(kind, values)
                         : kind.name == "flower" ? flower(kind, values)
                         : kind.name == "book"   ? book(kind, values)
                                                 : blank(kind, values);
    for (BendLine& bend : device.bends) bend.angle = Angle::degrees(at("angle"));
    return sheetRig(device, progress, quality);
}

} // namespace lumorph
