#include "core/show/input_script.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json_check.h"
#include "core/base/plain_text.h"
#include "core/scene/json_section.h"

namespace lumorph {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{64} << 20;
constexpr std::size_t kMostInputs = 200'000;
constexpr double kMostSeconds = 86'400.0;
constexpr double kMostValue = 1e9;
constexpr const char* kRemedy = R"(write {"inputs": [{"seconds": 1.5, "name": "key.left", "value": 1}]})";

TimedInput inputOf(JsonSection section) {
    if (!section.has("seconds")) section.refuse("seconds", "is missing", "say when it comes");
    TimedInput timed;
    section.number("seconds", timed.seconds, 0.0, kMostSeconds);
    section.text("name", timed.input.name);
    if (timed.input.name.empty()) section.refuse("name", "is missing", "name the input, such as key.left");
    section.number("value", timed.input.value, -kMostValue, kMostValue);
    return timed;
}

} // namespace

InputScript readInputScript(std::string_view text, const std::string& name) {
    if (const std::string problem = jsonProblem(text); !problem.empty()) throw DataError(name, problem, kRemedy);
    nlohmann::json root = nlohmann::json::parse(text, nullptr, false);
    if (!root.is_object() || !root.contains("inputs")) throw DataError(name, "holds no inputs", kRemedy);
    InputScript script;
    JsonSection(root, "", name).sections("inputs", kMostInputs, [&](JsonSection section) {
        script.push_back(inputOf(section));
    });
    std::ranges::stable_sort(script, {}, &TimedInput::seconds);
    return script;
}

InputScript readInputScriptFile(const std::filesystem::path& file) {
    const std::vector<std::byte> bytes = readFile(file, kMaxBytes);
    const PlainText text(bytes);
    return readInputScript(text.view(), file.string());
}

} // namespace lumorph
