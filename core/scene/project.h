#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/progress.h"
#include "core/mdf/placement.h"

namespace lumorph {

/// Schema version that this program writes; older ones are migrated step by step, newer ones are refused.
inline constexpr int kProjectSchema = 1;

/// A project as its file `name.lumorph` (JSON) holds it. Paths of assets are relative to the project's folder and may
/// not leave it, or name a bundled resource as `resource:models/tablet.glb`. Keys that this version does not know are
/// kept.
struct Project {
    std::string rig;    ///< asset: .glb, .gltf or a folder of one mesh per state
    std::string field;  ///< asset: .mdf; empty when it has not been built
    std::string target; ///< asset: a mesh or an animated glTF; empty without one
    int animation = 0;  ///< of the target
    Placement placement;
    std::vector<double> strokes; ///< the state set by hand; one an actuator
    struct Matching {
        bool live = true;
        bool refined = true;
        double budgetMilliseconds = 8.0;
        bool operator==(const Matching&) const = default;
    } matching;
    struct Playback {
        bool playing = true;
        double spin = 0.0; ///< radians a second
        bool operator==(const Playback&) const = default;
    } playback;
    nlohmann::json view;    ///< what a window wants to remember about how it shows the project
    nlohmann::json unknown; ///< the rest of the file, written back as it was
};

/// Reads a project. Throws DataError naming the file, the JSON key and the remedy: not readable, no JSON, too deep or
/// too large, a newer schema, a value of the wrong kind or out of range, a path that leaves the folder.
[[nodiscard]] Project readProject(const std::filesystem::path& file);

/// Writes it whole or not at all. Throws DeviceError when the disk refuses, and InvalidInput for a path that leaves the
/// folder.
void writeProject(const Project& project, const std::filesystem::path& file);

/// Where an asset of a project lies. Throws DataError when it leaves the folder, also through links, or is not there.
[[nodiscard]] std::filesystem::path assetPath(const std::filesystem::path& projectFile, const std::string& asset);

/// Takes a file (or a folder) into the folder beside the project, `NAME files/`, unless it lies in the project's folder
/// or is a bundled resource, and gives the asset's name. A glTF takes its buffers and images with it. A file of the
/// same name with other contents is not replaced: the newcomer gets a number. Throws DeviceError when the disk refuses.
[[nodiscard]] std::string takeAsset(const std::filesystem::path& projectFile, const std::filesystem::path& source,
                                    const Progress& progress = {});

} // namespace lumorph
