#include "app/applications/labyrinth/ghost.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/json_check.h"
#include "core/scene/json_section.h"

namespace lumorph::labyrinth {
namespace {

constexpr std::size_t kMostGhosts = 1000;
constexpr std::size_t kMostPositions = 3U * 3600U * 30U + 3U; ///< numbers of an hour

Ghost ghostOf(JsonSection section) {
    Ghost ghost;
    section.text("level", ghost.level);
    section.number("seconds", ghost.seconds, 0.0, Ghost::kMostSeconds);
    section.wholeNumber("score", ghost.score, 0, 1'000'000);
    std::vector<double> numbers;
    section.numbers("positions", numbers, -1.0, 1.0, kMostPositions);
    if (numbers.empty() || numbers.size() % 3 != 0)
        section.refuse("positions", "are not three numbers each", "remove this run");
    for (std::size_t k = 0; k < numbers.size(); k += 3)
        ghost.positions.emplace_back(numbers[k], numbers[k + 1], numbers[k + 2]);
    return ghost;
}

} // namespace

glm::vec3 positionAt(const Ghost& ghost, double seconds) noexcept {
    const double last = static_cast<double>(ghost.positions.size() - 1);
    const double at = std::clamp(seconds / Ghost::kInterval, 0.0, last);
    const auto before = static_cast<std::size_t>(at);
    const std::size_t after = std::min(before + 1, ghost.positions.size() - 1);
    return glm::mix(ghost.positions[before], ghost.positions[after], static_cast<float>(at - std::floor(at)));
}

std::string ghostsText(const std::vector<Ghost>& ghosts) {
    nlohmann::json runs = nlohmann::json::array();
    for (const Ghost& ghost : ghosts) {
        nlohmann::json positions = nlohmann::json::array();
        for (const glm::vec3& p : ghost.positions)
            for (const float number : {p.x, p.y, p.z}) positions.push_back(number);
        runs.push_back({{"level", ghost.level},
                        {"seconds", ghost.seconds},
                        {"score", ghost.score},
                        {"positions", std::move(positions)}});
    }
    return nlohmann::json{{"labyrinthRuns", std::move(runs)}}.dump();
}

std::vector<Ghost> readGhosts(std::string_view text, const std::string& name) {
    if (const std::string problem = jsonProblem(text); !problem.empty())
        throw DataError(name, problem, "remove the file; best runs begin anew");
    nlohmann::json root = nlohmann::json::parse(text, nullptr, false);
    if (!root.is_object() || !root.contains("labyrinthRuns"))
        throw DataError(name, "holds no runs of the labyrinth", "remove the file; best runs begin anew");
    std::vector<Ghost> ghosts;
    JsonSection(root, "", name).sections("labyrinthRuns", kMostGhosts, [&](const JsonSection& section) {
        ghosts.push_back(ghostOf(section));
    });
    return ghosts;
}

} // namespace lumorph::labyrinth
