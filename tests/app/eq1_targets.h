#pragma once

#include <string>
#include <vector>

#include "tests/app/literal_eq1.h"
#include "tests/app/workspace.h"

namespace lumorph::test {

struct MatchTarget {
    std::string name;
    std::string path;
    bool fit = false; ///< to be fitted into the frame; else it stands in device coordinates
};

/// Targets for the tablet, written into its workspace: the bundled dunes, the shared meshes where they
/// are, three reliefs as OBJ, three waves as NRRD in the frame of `body`, and ten hidden joint states.
[[nodiscard]] std::vector<MatchTarget> tabletTargets(const TabletWorkspace& w, const LiteralGrid& body);

} // namespace lumorph::test
