#include <cmath>

#include "core/rig/rig_extras.h"

namespace lumorph {
namespace {

using nlohmann::json;

/// A list of at most `most` finite numbers. What they have to be is checked with the rig.
std::vector<float> sheetNumbers(const json& sheet, const char* key, std::size_t most, const EntryPlace& place) {
    const auto found = sheet.find(key);
    const std::string name = std::string("\"") + key + "\" of the sheet";
    if (found == sheet.end() || !found->is_array()) place.fail(name + " is not a list", "save the rig again");
    if (found->size() > most)
        place.fail(name + " has more than " + std::to_string(most) + " numbers", "keep fewer modes, or a coarser grid");
    std::vector<float> numbers;
    numbers.reserve(found->size());
    for (const json& number : *found) {
        numbers.push_back(number.is_number() ? number.get<float>() : NAN);
        if (!std::isfinite(numbers.back()))
            place.fail(name + " holds what is not a finite number", "save the rig again");
    }
    return numbers;
}

} // namespace

json sheetExtras(const SheetModes& modes) {
    std::vector<float> strokes;
    for (const std::vector<float>& nodes : modes.strokes) strokes.insert(strokes.end(), nodes.begin(), nodes.end());
    json extras{{"modes", modes.modeCount}, {"strokes", strokes}, {"coefficients", modes.coefficients}};
    if (modes.secondStates > 0) extras["seconds"] = {modes.secondStates, modes.secondDistance};
    return extras;
}

SheetModes readSheetExtras(const json& extras, const EntryPlace& place) {
    if (!extras.is_object()) place.fail("\"lumorphSheet\" is not an object", "save the rig again");
    SheetModes sheet;
    const auto count = extras.find("modes");
    if (count == extras.end() || !count->is_number_unsigned() || count->get<std::uint64_t>() < 1 ||
        count->get<std::uint64_t>() > SheetModes::kMostModes)
        place.fail("\"modes\" of the sheet is not a number from 1 to " + std::to_string(SheetModes::kMostModes),
                   "keep fewer modes");
    sheet.modeCount = count->get<std::size_t>();
    // A flat list, which modelling tools keep: each axis begins at 0.
    for (const float stroke :
         sheetNumbers(extras, "strokes", SheetModes::kMostActuators * SheetModes::kMostLevels, place)) {
        if (stroke == 0.0F || sheet.strokes.empty()) sheet.strokes.emplace_back();
        sheet.strokes.back().push_back(stroke);
    }
    sheet.coefficients = sheetNumbers(extras, "coefficients", SheetModes::kMostCoefficients, place);
    if (extras.contains("seconds")) {
        const std::vector<float> seconds = sheetNumbers(extras, "seconds", 2, place);
        if (seconds.size() != 2 || seconds[0] < 0.0F || seconds[0] > 1e6F || seconds[1] < 0.0F)
            place.fail("\"seconds\" of the sheet are not a number of states and a distance", "save the rig again");
        sheet.secondStates = static_cast<std::uint32_t>(seconds[0]);
        sheet.secondDistance = seconds[1];
    }
    return sheet;
}

std::string sheetModeName(std::size_t mode) { return "sheet mode " + std::to_string(mode + 1); }

} // namespace lumorph
