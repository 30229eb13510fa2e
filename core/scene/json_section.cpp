#include "core/scene/json_section.h"

#include <limits>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/project_assets.h"

namespace lumorph {
namespace {

using nlohmann::json;

constexpr const char* kCorrect = "correct it, or remove it";

std::string shortestText(double value) { return json(value).dump(); }

} // namespace

void JsonSection::text(const std::string& key, std::string& value) {
    const json* found = find(key);
    if (!found) return;
    if (!found->is_string()) refuse(key, "is not a text", "put it in quotes, or remove it");
    value = found->get<std::string>();
    object_->erase(key);
}

void JsonSection::asset(const std::string& key, std::string& value) {
    text(key, value);
    if (value.empty() || isAssetName(value)) return;
    refuse(key, inQuotes(value) + " leads out of the project's folder",
           "put the file beside the project and name it relative to it");
}

void JsonSection::flag(const std::string& key, bool& value) {
    const json* found = find(key);
    if (!found) return;
    if (!found->is_boolean()) refuse(key, "is neither true nor false", "write true or false, or remove it");
    value = found->get<bool>();
    object_->erase(key);
}

void JsonSection::number(const std::string& key, double& value, double min, double max) {
    const json* found = find(key);
    if (!found) return;
    value = numberIn(*found, key, min, max);
    object_->erase(key);
}

void JsonSection::wholeNumber(const std::string& key, int& value, int min, int max) {
    const json* found = find(key);
    if (!found) return;
    if (!found->is_number_integer() || !(found->get<double>() >= min && found->get<double>() <= max))
        refuse(key, "is not a whole number from " + std::to_string(min) + " to " + std::to_string(max), kCorrect);
    value = found->get<int>();
    object_->erase(key);
}

void JsonSection::numbers(const std::string& key, std::vector<double>& values, double min, double max, std::size_t most,
                          bool exactly) {
    const json* found = find(key);
    if (!found) return;
    if (!found->is_array() || found->size() > most || (exactly && found->size() != most))
        refuse(key, "is not a list of " + std::string(exactly ? "" : "at most ") + std::to_string(most) + " numbers",
               kCorrect);
    values.clear();
    for (const json& value : *found)
        values.push_back(numberIn(value, key + "[" + std::to_string(values.size()) + "]", min, max));
    object_->erase(key);
}

void JsonSection::texts(const std::string& key, std::vector<std::string>& values, std::size_t most) {
    const json* found = find(key);
    if (!found) return;
    refuseNoList(key, *found, most);
    values.clear();
    for (const json& value : *found) {
        if (!value.is_string())
            refuse(key + "[" + std::to_string(values.size()) + "]", "is not a text", "put it in quotes, or remove it");
        values.push_back(value.get<std::string>());
    }
    object_->erase(key);
}

void JsonSection::refuse(const std::string& key, const std::string& why, const std::string& remedy) const {
    throw DataError(*file_, prefix_ + key + ": " + why, remedy);
}

const json* JsonSection::find(const std::string& key) const {
    const auto found = object_->find(key);
    return found == object_->end() ? nullptr : &*found;
}

double JsonSection::numberIn(const json& value, const std::string& key, double min, double max) const {
    const double number = value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
    if (!(number >= min && number <= max))
        refuse(key, "is not a number from " + shortestText(min) + " to " + shortestText(max), kCorrect);
    return number;
}

void JsonSection::refuseNoList(const std::string& key, const json& value, std::size_t most) const {
    if (!value.is_array()) refuse(key, "is not a list", "write it in [ ], or remove it");
    if (value.size() > most)
        refuse(key, "has " + std::to_string(value.size()) + " entries, and " + std::to_string(most) + " is the most",
               "remove some");
}

} // namespace lumorph
