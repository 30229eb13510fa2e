#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/mdf/placement.h"
#include "core/motion/pose_book.h"
#include "core/scene/driver.h"
#include "core/scene/installation.h"
#include "core/scene/project_assets.h"
#include "core/scene/scene.h"

namespace lumorph {

/// Schema version that this program writes; older ones are migrated step by step, newer ones are refused.
inline constexpr int kProjectSchema = 4;

/// A project as its file `name.lumorph` (JSON) holds it. Paths of assets are relative to the project's folder and may
/// not leave it, or name a bundled resource as `resource:models/tablet.glb`. Keys that this version does not know are
/// kept, but in the entries of lists.
struct Project {
    std::string rig;    ///< asset, always there: .glb, .gltf or a folder of one mesh per state
    std::string field;  ///< asset: .mdf; empty when it has not been built
    std::string target; ///< asset: a mesh or an animated glTF; empty without one
    int animation = 0;  ///< of the target
    Placement placement;
    std::vector<double> strokes; ///< the state set by hand, in [0, 1]; one an actuator, or none for rest
    struct Matching {
        Driver driver = Driver::target; ///< target, sceneItem or hand; others are of a moment, not of a project
        bool refined = true;
        double budgetMilliseconds = 8.0;
        bool operator==(const Matching&) const = default;
    } matching;
    struct Playback {
        bool playing = true;
        double spin = 0.0; ///< radians a second
        bool operator==(const Playback&) const = default;
    } playback;
    PoseBook poses;               ///< named by the user, and their sequence
    Scene scene = defaultScene(); ///< what is shown
    /// A copy of the room's when it was saved. Who opens the project in another room decides which to use.
    Installation installation = defaultInstallation();
    nlohmann::json view;    ///< what a window wants to remember about how it shows the project; an object or null
    nlohmann::json unknown; ///< the rest of the file, nested as it was, written back as it was
};

/// A project from the text of its file; `name` stands in errors. Older schemas are migrated, links are not looked at.
/// Throws DataError as `readProject` does.
[[nodiscard]] Project parseProject(std::string_view text, const std::string& name);

/// The text of its file. Equal projects give equal bytes, and `parseProject` gives back the same project (an angle of
/// the scene that no number of degrees gives changes in its last bit, once). Throws InvalidInput for a value that
/// `parseProject` would refuse.
[[nodiscard]] std::string projectText(const Project& project);

/// Reads a project. Its assets need not be there. Throws DataError naming the file, the JSON key and the remedy: not
/// readable, no JSON, too deep or too large, a newer schema, no rig, a value of the wrong kind or out of range, a path
/// that leaves the folder, also through links.
[[nodiscard]] Project readProject(const std::filesystem::path& file);

/// Writes it whole or not at all. Throws DeviceError when the disk refuses, and InvalidInput for a value that could not
/// be read back: no rig, a number out of range, a path that leaves the folder.
void writeProject(const Project& project, const std::filesystem::path& file);

} // namespace lumorph
