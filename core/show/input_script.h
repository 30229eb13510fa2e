#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/loop/show_inputs.h"

namespace lumorph {

/// An input of a show program, and when it comes.
struct TimedInput {
    double seconds = 0.0; ///< since the program's first frame
    ShowInput input;
    bool operator==(const TimedInput&) const = default;
};

/// What visitors do to a show program, for one that is played without them.
using InputScript = std::vector<TimedInput>; ///< in order of time

/// Reads `{"inputs": [{"seconds": 1.5, "name": "key.left", "value": 1}, ...]}`; inputs of one moment keep their order.
/// Throws DataError naming the file, the key and the remedy.
[[nodiscard]] InputScript readInputScript(std::string_view text, const std::string& name);
[[nodiscard]] InputScript readInputScriptFile(const std::filesystem::path& file);

} // namespace lumorph
