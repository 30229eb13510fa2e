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

/// Where a mesh of a rig file holds its sheet: a member of the extras, and vertex attributes of one float.
inline constexpr const char* kSheetMember = "lumorphSheet";
inline constexpr const char* kSheetRow = "_SHEET_ROW"; ///< -1 for none
inline constexpr const char* kSheetShare = "_SHEET_SHARE";

/// Strokes and coefficients of a sheet.
[[nodiscard]] nlohmann::json sheetExtras(const SheetModes& modes);
/// Reads them. The modes themselves are the mesh' morph targets and are not known yet. Throws DataError.
[[nodiscard]] SheetModes readSheetExtras(const nlohmann::json& extras, const EntryPlace& place);
/// The name of the morph target that is a mode of the sheet.
[[nodiscard]] std::string sheetModeName(std::size_t mode);

} // namespace lumorph
