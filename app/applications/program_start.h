#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/applications/demo.h"

namespace lumorph {

/// A demonstration's program, begun with what it is told and what it wanted kept the last time.
struct BegunProgram {
    std::unique_ptr<ShowProgram> program;
    std::vector<std::string> notes;                           ///< what there is to say of the start
    std::vector<std::pair<std::string, std::string>> figures; ///< the same for programs: names and JSON values
    std::string problem;         ///< why what was kept is not used; empty: it is, or there is none
    std::filesystem::path aside; ///< where that lies now
};

/// How a program begins, beside what Demo knows of it.
struct ProgramWish {
    std::uint64_t seed = 0;
    DemoTold told = {};
    std::filesystem::path kept = {}; ///< file of its keepsake, which need not exist; empty: it remembers nothing
    DemoFeed feed = {};              ///< as ProgramStart
};

/// Begins the program of a demonstration; null for one that goes by time alone. What was kept and is damaged is moved
/// aside, never lost, and the program begins anew. Throws InvalidInput where it is told something that it has no option
/// for, and as Demo::program does.
[[nodiscard]] BegunProgram beginProgram(const Demo& demo, const ProgramWish& wish, const Progress& progress = {});

/// Writes a keepsake whole or not at all, with the folder where it lies. Throws DeviceError.
void writeKeepsake(const std::filesystem::path& file, const std::string& keepsake);

} // namespace lumorph
