#include "app/applications/navigation/building_tags.h"

#include <algorithm>
#include <charconv>
#include <system_error>
#include <utility>

#include "core/base/text.h"

namespace lumorph::navigation {
namespace {

constexpr double kMetresAFoot = 0.3048, kMetresAnInch = 0.0254;
constexpr double kMetresAStorey = 3.0, kOverCeiling = 1.0; ///< metres
constexpr double kHighest = 1000.0, kMostStoreys = 300.0;

void replaceAll(std::string& text, std::string_view what, std::string_view by) {
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlank = " \t\r\n";
    const std::size_t from = text.find_first_not_of(kBlank);
    if (from == std::string_view::npos) return {};
    return text.substr(from, text.find_last_not_of(kBlank) + 1 - from);
}

/// Takes a number, with a decimal point, off the beginning.
std::optional<double> takeNumber(std::string_view& text) {
    text = trimmed(text);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
    if (error != std::errc()) return std::nullopt;
    text = trimmed(text.substr(static_cast<std::size_t>(end - text.data())));
    return value;
}

/// Of several ("3;4") the largest.
std::optional<double> storeysIn(std::string text) {
    std::ranges::replace(text, ',', '.');
    std::optional<double> most;
    for (std::string_view rest(text); !rest.empty();) {
        const std::size_t end = std::min(rest.find(';'), rest.size());
        std::string_view one = rest.substr(0, end);
        const std::optional<double> value = takeNumber(one);
        if (value && one.empty() && *value >= 0.0 && *value < kMostStoreys) most = std::max(most.value_or(0.0), *value);
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return most;
}

std::optional<double> firstLength(const TagValue& tag, std::initializer_list<const char*> names) {
    for (const char* name : names)
        if (const auto metres = metresIn(tag(name)); metres && *metres > 0.0 && *metres < kHighest) return metres;
    return std::nullopt;
}

std::optional<double> firstStoreys(const TagValue& tag, std::initializer_list<const char*> names) {
    for (const char* name : names)
        if (const auto storeys = storeysIn(tag(name))) return storeys;
    return std::nullopt;
}

Building::Roof roofOf(const std::string& shape) {
    if (shape == "pyramidal" || shape == "cone" || shape == "dome" || shape == "onion") return Building::Roof::pyramid;
    if (shape == "hipped" || shape == "half-hipped") return Building::Roof::hip;
    if (shape == "gabled" || shape == "gambrel" || shape == "mansard" || shape == "saltbox" || shape == "round")
        return Building::Roof::gable;
    return Building::Roof::flat;
}

} // namespace

std::optional<double> metresIn(std::string_view said) {
    std::string text = lowerCase(said);
    for (const char* prime : {"\u2032", "\u2019", "\u2018"}) replaceAll(text, prime, "'");
    for (const char* prime : {"\u2033", "\u201D", "\u201C", "''"}) replaceAll(text, prime, "\"");
    std::ranges::replace(text, ',', '.');
    std::string_view rest = trimmed(text);
    if (rest.starts_with('~')) rest.remove_prefix(1); // about
    const std::optional<double> value = takeNumber(rest);
    if (!value) return std::nullopt;
    static constexpr std::pair<std::string_view, double> kUnits[] = {{"", 1.0},
                                                                     {"m", 1.0},
                                                                     {"m.", 1.0},
                                                                     {"metre", 1.0},
                                                                     {"metres", 1.0},
                                                                     {"meter", 1.0},
                                                                     {"meters", 1.0},
                                                                     {"cm", 0.01},
                                                                     {"km", 1000.0},
                                                                     {"ft", kMetresAFoot},
                                                                     {"ft.", kMetresAFoot},
                                                                     {"foot", kMetresAFoot},
                                                                     {"feet", kMetresAFoot},
                                                                     {"'", kMetresAFoot},
                                                                     {"in", kMetresAnInch},
                                                                     {"inch", kMetresAnInch},
                                                                     {"\"", kMetresAnInch}};
    for (const auto& [unit, metres] : kUnits)
        if (rest == unit) return *value * metres;
    // Feet and inches.
    for (const std::string_view feet : {"'", "ft", "feet"}) {
        if (!rest.starts_with(feet)) continue;
        rest = rest.substr(feet.size());
        const std::optional<double> inches = takeNumber(rest);
        if (inches && (rest.empty() || rest == "\"" || rest == "in"))
            return *value * kMetresAFoot + *inches * kMetresAnInch;
        break;
    }
    return std::nullopt;
}

BuildingShape buildingShape(const TagValue& tag) {
    BuildingShape shape;
    const auto storeys = firstStoreys(tag, {"building:levels", "levels", "storeys", "storeysAboveGround"});
    const auto roofStoreys = firstStoreys(tag, {"roof:levels"});
    const auto roofHeight = firstLength(tag, {"roof:height"});
    shape.form = roofOf(tag("roof:shape"));
    if (roofHeight || roofStoreys.value_or(0.0) > 0.0) {
        shape.roof = roofHeight.value_or(kMetresAStorey * roofStoreys.value_or(0.0) + kOverCeiling);
        if (tag("roof:shape").empty()) shape.form = Building::Roof::gable;
    } else if (shape.form != Building::Roof::flat) {
        shape.roof = kMetresAStorey;
    }
    if (shape.form == Building::Roof::flat) shape.roof = 0.0;
    shape.height = firstLength(
        tag, {"height", "HEIGHT", "Height", "building:height", "measuredHeight", "measured_height", "hoehe"});
    if (!shape.height && storeys && *storeys + roofStoreys.value_or(0.0) > 0.0)
        shape.height = kMetresAStorey * *storeys +
                       (roofHeight ? *roofHeight : kMetresAStorey * roofStoreys.value_or(0.0) + kOverCeiling);
    if (const auto from = firstLength(tag, {"min_height"}))
        shape.from = *from;
    else if (const auto below = firstStoreys(tag, {"building:min_level", "min_level"}))
        shape.from = kMetresAStorey * *below;
    if (shape.height) {
        if (shape.from >= *shape.height) shape.from = 0.0;
        shape.roof = std::min(shape.roof, *shape.height - shape.from);
    }
    return shape;
}

} // namespace lumorph::navigation
