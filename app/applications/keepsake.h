#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/applications/demo.h"

namespace lumorph {

/// A demonstration's program, begun with what it wanted kept the last time.
struct BegunProgram {
    std::unique_ptr<ShowProgram> program;
    std::string problem;         ///< why what was kept is not used; empty: it is, or there is none
    std::filesystem::path aside; ///< where that lies now
};

/// Begins the program of a demonstration that has one. `kept` is the file of its keepsake (ShowContent::keepsake),
/// which need not exist; empty: it remembers nothing. A damaged one is moved aside, never lost, and the program begins
/// anew. Throws as Demo::program does.
[[nodiscard]] BegunProgram beginProgram(const Demo& demo, std::uint64_t seed, const std::filesystem::path& kept);

/// Writes a keepsake whole or not at all, with the folder where it lies. Throws DeviceError.
void writeKeepsake(const std::filesystem::path& file, const std::string& keepsake);

} // namespace lumorph
