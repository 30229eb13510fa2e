#include "core/rig/templates/sheet_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json_check.h"
#include "core/base/plain_text.h"
#include "core/base/text.h"
#include "core/rig/templates/sheet_outline.h"

namespace lumorph {
namespace {

constexpr std::size_t kMostBytes = std::size_t{16} << 20;
constexpr double kCentimetre = 0.01;
constexpr std::array<std::string_view, 6> kBendKeys{"name", "from", "to", "ends", "side", "angle"};
constexpr std::array<std::string_view, 9> kDrawingKeys{"bends",     "name",    "top", "material", "pad",
                                                       "thickness", "housing", "arc", "outline"};
constexpr std::span<const std::string_view> kBendsKeys = std::span(kDrawingKeys).first<8>();
constexpr std::array<std::string_view, 2> kEnds{"free", "joined"};
constexpr std::array<std::string_view, 2> kTops{"cut", "continuous"};
constexpr std::array<std::string_view, 3> kSides{"smaller", "left", "right"};

std::string contentOf(const std::filesystem::path& file) {
    const std::vector<std::byte> bytes = readFile(file, kMostBytes);
    return std::string(PlainText(bytes).view());
}

/// An object of the bends file; says where it stands.
class BendsEntry {
public:
    BendsEntry(const nlohmann::json& json, std::string subject, std::span<const std::string_view> known)
        : json_(json), subject_(std::move(subject)) {
        if (!json.is_object()) fail("it is no object", "write {...}");
        for (const auto& [key, value] : json.items())
            if (std::ranges::find(known, key) == known.end()) {
                std::string names;
                for (const std::string_view name : known) names += (names.empty() ? "" : ", ") + std::string(name);
                fail("it holds " + inQuotes(key) + ", which means nothing here", "use " + names);
            }
    }

    [[noreturn]] void fail(const std::string& why, const std::string& remedy) const {
        throw DataError(subject_, why, remedy);
    }
    [[nodiscard]] const nlohmann::json* find(const char* key) const {
        const auto found = json_.find(key);
        return found == json_.end() ? nullptr : &*found;
    }
    [[nodiscard]] double number(const char* key, double missing) const {
        const nlohmann::json* value = find(key);
        if (value == nullptr) return missing;
        if (!value->is_number()) fail(std::string(key) + " is no number", "give a number");
        return value->get<double>();
    }
    [[nodiscard]] std::string text(const char* key, const std::string& missing) const {
        const nlohmann::json* value = find(key);
        if (value == nullptr) return missing;
        if (!value->is_string()) fail(std::string(key) + " is no text", "write it in quotes");
        return value->get<std::string>();
    }
    [[nodiscard]] glm::dvec2 point(const char* key) const {
        const nlohmann::json* value = find(key);
        return pointOf(value == nullptr ? nlohmann::json() : *value, key);
    }
    [[nodiscard]] std::vector<glm::dvec2> points(const char* key) const {
        const nlohmann::json* value = find(key);
        if (value == nullptr || !value->is_array()) fail(std::string(key) + " is no list", "write [[x, y], ...]");
        std::vector<glm::dvec2> points;
        for (const nlohmann::json& one : *value) points.push_back(pointOf(one, key));
        return points;
    }
    /// The place of a word among those that are known.
    [[nodiscard]] int choice(const char* key, std::span<const std::string_view> words, int missing) const {
        const std::string word = text(key, std::string(words[static_cast<std::size_t>(missing)]));
        const auto found = std::ranges::find(words, word);
        if (found == words.end()) {
            std::string names;
            for (const std::string_view name : words) names += (names.empty() ? "" : ", ") + std::string(name);
            fail(std::string(key) + " is " + inQuotes(word), "use one of " + names);
        }
        return static_cast<int>(found - words.begin());
    }

private:
    [[nodiscard]] glm::dvec2 pointOf(const nlohmann::json& value, const char* key) const {
        if (!value.is_array() || value.size() != 2 || !value[0].is_number() || !value[1].is_number())
            fail(std::string(key) + " is no point", "write two numbers in centimetres: [x, y]");
        return kCentimetre * glm::dvec2(value[0].get<double>(), value[1].get<double>());
    }

    const nlohmann::json& json_;
    std::string subject_;
};

BendLine bendOf(const nlohmann::json& json, const std::string& file, std::size_t number) {
    const BendsEntry entry(json, file + ", bend " + std::to_string(number), kBendKeys);
    BendLine bend;
    bend.name = entry.text("name", "bend " + std::to_string(number));
    bend.from = entry.point("from");
    bend.to = entry.point("to");
    bend.ends = static_cast<BendLine::Ends>(entry.choice("ends", kEnds, 1));
    bend.side = static_cast<BendLine::Side>(entry.choice("side", kSides, 0));
    bend.angle = Angle::degrees(entry.number("angle", 90.0));
    return bend;
}

nlohmann::json parsed(std::string_view text, const std::string& subject) {
    const char* const remedy = "write {\"bends\": [...]} with finite numbers";
    if (const std::string problem = jsonProblem(text); !problem.empty())
        throw DataError(subject, "it " + problem, remedy);
    nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
    if (json.is_discarded()) throw DataError(subject, "it is no JSON", remedy);
    return json;
}

/// All that such an object says but the outline, over what `device` holds already.
void readBends(const BendsEntry& entry, const std::string& subject, SheetDevice& device) {
    device.name = entry.text("name", device.name);
    device.top = static_cast<SheetTop>(entry.choice("top", kTops, 0));
    device.material = entry.text("material", device.material);
    if (entry.find("pad") != nullptr) device.pad = entry.points("pad");
    device.thickness = kCentimetre * entry.number("thickness", device.thickness / kCentimetre);
    device.housing = kCentimetre * entry.number("housing", device.housing / kCentimetre);
    device.arc = kCentimetre * entry.number("arc", device.arc / kCentimetre);
    const nlohmann::json* list = entry.find("bends");
    if (list == nullptr || !list->is_array()) entry.fail("it holds no list of bend lines", "write {\"bends\": [...]}");
    for (const nlohmann::json& bend : *list) device.bends.push_back(bendOf(bend, subject, device.bends.size() + 1));
}

/// A number as it is written: with nine decimals, so that reading it and writing it again changes nothing.
double rounded(double number) {
    constexpr double kDecimals = 1e9;
    return std::round(number * kDecimals) / kDecimals;
}

double inCentimetres(double metres) { return rounded(metres / kCentimetre); }

nlohmann::json pointJson(const glm::dvec2& point) { return {inCentimetres(point.x), inCentimetres(point.y)}; }

} // namespace

SheetDevice readSheetDevice(const std::filesystem::path& outline, const std::filesystem::path& bends) {
    SheetDevice device;
    device.name = outline.stem().string();
    device.outline = svgOutline(contentOf(outline), outline.string());
    const nlohmann::json json = parsed(contentOf(bends), bends.string());
    readBends(BendsEntry(json, bends.string(), kBendsKeys), bends.string(), device);
    const glm::dvec2 middle = boxOf(device.outline).middle();
    for (glm::dvec2& p : device.outline) p -= middle;
    for (glm::dvec2& p : device.pad) p -= middle;
    for (BendLine& bend : device.bends) {
        bend.from -= middle;
        bend.to -= middle;
    }
    return device;
}

std::vector<glm::dvec2> readOutline(const std::filesystem::path& file) {
    std::vector<glm::dvec2> outline = svgOutline(contentOf(file), file.string());
    const glm::dvec2 middle = boxOf(outline).middle();
    for (glm::dvec2& p : outline) p -= middle;
    return outline;
}

std::string writeSheetDevice(const SheetDevice& device) {
    nlohmann::json json{{"name", device.name},
                        {"thickness", inCentimetres(device.thickness)},
                        {"housing", inCentimetres(device.housing)},
                        {"arc", inCentimetres(device.arc)},
                        {"outline", nlohmann::json::array()},
                        {"bends", nlohmann::json::array()}};
    for (const glm::dvec2& p : device.outline) json["outline"].push_back(pointJson(p));
    if (device.top == SheetTop::continuous) {
        json["top"] = kTops[1];
        json["material"] = device.material;
        for (const glm::dvec2& p : device.pad) json["pad"].push_back(pointJson(p));
    }
    for (const BendLine& bend : device.bends)
        json["bends"].push_back({{"name", bend.name},
                                 {"from", pointJson(bend.from)},
                                 {"to", pointJson(bend.to)},
                                 {"ends", kEnds[static_cast<std::size_t>(bend.ends)]},
                                 {"side", kSides[static_cast<std::size_t>(bend.side)]},
                                 {"angle", rounded(bend.angle.inDegrees())}});
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

SheetDevice parseSheetDevice(std::string_view text, const std::string& subject) {
    if (text.size() > kMostBytes) throw DataError(subject, "it is larger than 16 MB", "simplify the drawing");
    const nlohmann::json json = parsed(text, subject);
    const BendsEntry entry(json, subject, kDrawingKeys);
    SheetDevice device;
    device.outline = entry.points("outline");
    readBends(entry, subject, device);
    return device;
}

} // namespace lumorph
