#include "calibration/registration/pose_columns.h"

#include <algorithm>
#include <array>
#include <string>

#include "core/base/text.h"

namespace lumorph {

namespace {

/// Small letters and digits of a name, apart where anything else stands between: "p_RS_R_x [m]" is p, rs, r, x, m.
std::vector<std::string> wordsOf(std::string_view name) {
    std::vector<std::string> words(1);
    for (const char c : lowerCase(name)) {
        const bool isPart = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
        if (isPart)
            words.back() += c;
        else if (!words.back().empty())
            words.emplace_back();
    }
    if (words.back().empty()) words.pop_back();
    return words;
}

bool isAnyOf(const std::string& word, std::initializer_list<std::string_view> of) {
    return std::ranges::find(of, std::string_view(word)) != of.end();
}

struct UnitName {
    std::string_view name;
    double size;
};
constexpr std::array kTimes{UnitName{"ms", 1e-3},           UnitName{"us", 1e-6},
                            UnitName{"ns", 1e-9},           UnitName{"milliseconds", 1e-3},
                            UnitName{"microseconds", 1e-6}, UnitName{"nanoseconds", 1e-9}};
constexpr std::array kLengths{UnitName{"mm", 1e-3},          UnitName{"cm", 1e-2},     UnitName{"millimetres", 1e-3},
                              UnitName{"millimeters", 1e-3}, UnitName{"feet", 0.3048}, UnitName{"ft", 0.3048},
                              UnitName{"inches", 0.0254}};

double unitOf(const std::vector<std::string>& words, std::span<const UnitName> units) {
    for (const UnitName& unit : units)
        if (std::ranges::find(words, unit.name) != words.end()) return unit.size;
    return 1.0;
}

bool isTime(const std::vector<std::string>& words) {
    return std::ranges::any_of(words, [](const std::string& word) {
        return word.starts_with("time") || isAnyOf(word, {"t", "stamp", "secs", "seconds"});
    });
}
bool isFrame(const std::vector<std::string>& words) {
    return std::ranges::any_of(words, [](const std::string& word) { return isAnyOf(word, {"frame", "frames"}); });
}

/// 'x', 'y' or 'z' of a place; 'X', 'Y', 'Z' or 'W' of a quaternion; 0 of neither.
char partOf(std::vector<std::string> words) {
    std::erase_if(words, [](const std::string& word) { return unitOf({word}, kLengths) != 1.0 || word == "m"; });
    if (words.empty()) return 0;
    const std::string& last = words.back();
    const char axis = last.back();
    if (axis < 'w' || axis > 'z') return 0;
    const bool alone = last.size() == 1;
    const auto anyIs = [&](std::initializer_list<std::string_view> of) {
        return std::ranges::any_of(words, [&](const std::string& word) { return isAnyOf(word, of); });
    };
    const bool turns = alone && anyIs({"q", "quat", "quaternion", "orientation", "rotation", "rot", "r", "attitude"}) &&
                       !anyIs({"p", "pos", "position", "translation"});
    if (turns || (last.size() > 1 && isAnyOf(last.substr(0, last.size() - 1), {"q", "quat", "rot", "o"})))
        return static_cast<char>(axis - 'a' + 'A');
    if (axis == 'w') return alone && words.size() == 1 ? 'W' : static_cast<char>(0);
    const bool moves = anyIs({"v", "vel", "velocity", "a", "acc", "acceleration", "b", "omega", "gyro", "angular",
                              "linear", "twist", "euler", "angle"});
    const bool isPlace = alone || isAnyOf(last.substr(0, last.size() - 1), {"t", "p", "pos", "position", "trans"});
    return isPlace && !moves ? axis : static_cast<char>(0);
}

} // namespace

std::optional<PoseColumns> columnsByName(std::span<const std::string_view> names) {
    constexpr std::string_view kParts = "xyzXYZW";
    std::optional<std::size_t> time, frame;
    std::array<std::optional<std::size_t>, kParts.size()> parts;
    PoseColumns found;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::vector<std::string> words = wordsOf(names[i]);
        const std::size_t part = kParts.find(partOf(words));
        if (part != std::string_view::npos && !parts[part]) {
            parts[part] = i;
            if (part == 0) found.lengthUnit = unitOf(words, kLengths);
        } else if (part == std::string_view::npos && !time && isTime(words)) {
            time = i;
            found.timeUnit = unitOf(words, kTimes);
        } else if (part == std::string_view::npos && !frame && isFrame(words)) {
            frame = i;
        }
    }
    // In another language, or a name of a station.
    const bool firstIsFree = std::ranges::find(parts, std::optional<std::size_t>(0)) == parts.end();
    if (!time && !frame && firstIsFree) time = 0;
    if (time || frame) found.columns.push_back(time ? *time : *frame);
    for (const auto& part : parts) {
        if (!part) return std::nullopt;
        found.columns.push_back(*part);
    }
    return found;
}

} // namespace lumorph
