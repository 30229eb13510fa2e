#pragma once

#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <nlohmann/json.hpp>

#include "core/rig/rig.h"

namespace lumorph {

/// Where an entry of a rig file stands, for errors.
struct EntryPlace {
    std::string file;
    std::string entry; ///< for example: node "Flap"
    /// Throws DataError.
    [[noreturn]] void fail(const std::string& why, const std::string& remedy) const;
};

/// An actuator as the file states it. Its influences and displacements are not known yet.
struct ActuatorEntry {
    Actuator actuator;
    EntryPlace place;
    int node = -1;                    ///< the node whose meshes it moves; for morph targets the mesh's node
    int order = -1;                   ///< -1 when the file states none
    std::vector<std::string> targets; ///< morph: the names of the targets, one a key
    double weightMin = 0.0;           ///< morph: the range
    double weightMax = 1.0;
};

/// Reads one `lumorph` object. `worldFromNode` places axis and origin; `joint` is the node's index
/// among the skeleton's joints or -1.
[[nodiscard]] ActuatorEntry readActuatorEntry(const nlohmann::json& extras, const EntryPlace& place,
                                              const glm::mat4& worldFromNode, int joint);

/// The `lumorph` object that stands for this actuator. Origins are not part of it.
[[nodiscard]] nlohmann::json actuatorExtras(const Actuator& actuator, std::size_t order);

} // namespace lumorph
