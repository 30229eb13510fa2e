#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/rig/parts/build_plan.h"

namespace lumorph {

/// What a plan is on the disk, by file name: NAME.stl and NAME.3mf of each part, `parts.csv`, `wiring.csv`, `sheet.svg`
/// where there is a sheet, and `assembly.html`, which shows all of it with pictures and needs no other file.
[[nodiscard]] std::map<std::string, std::vector<std::byte>> buildFiles(const BuildPlan& plan);

/// Makes the folder with these files, and with what `more` adds to it; whole or not at all, and nothing that is there
/// is replaced. `more` gets the folder while it has another name. Throws InvalidInput when there is something of that
/// name already, but for an empty folder; DeviceError where the disk refuses; Cancelled.
void writeBuildFolder(const std::map<std::string, std::vector<std::byte>>& files, const std::filesystem::path& folder,
                      const std::function<void(const std::filesystem::path&)>& more = {},
                      const Progress& progress = {});

} // namespace lumorph
