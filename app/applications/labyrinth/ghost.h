#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

namespace lumorph::labyrinth {

/// A whole run through a level, to be shown again beside the next ones: where the ball was, at even times.
struct Ghost {
    static constexpr double kInterval = 1.0 / 30.0; ///< seconds between positions
    static constexpr double kMostSeconds = 3600.0;  ///< no longer run is kept

    std::string level;    ///< its name
    double seconds = 0.0; ///< from the start to the goal
    int score = 0;
    std::vector<glm::vec3> positions; ///< of the ball's middle, the first at the start; metres, height 0 at the sheet
    bool operator==(const Ghost&) const = default;
};

/// Where the ghost is `seconds` after its start, between its positions; at its end from there on. Needs a position.
[[nodiscard]] glm::vec3 positionAt(const Ghost& ghost, double seconds) noexcept;

/// Best runs as JSON, and back. Reading throws DataError naming the file, the key and the remedy.
[[nodiscard]] std::string ghostsText(const std::vector<Ghost>& ghosts);
[[nodiscard]] std::vector<Ghost> readGhosts(std::string_view text, const std::string& name);

} // namespace lumorph::labyrinth
