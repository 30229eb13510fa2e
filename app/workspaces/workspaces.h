#pragma once

#include <memory>
#include <vector>

#include "app/studio/shell/studio.h"
#include "app/studio/shell/workspace.h"

namespace lumorph::studio {

/// The workspaces of the studio, in the order of the work. `studio` outlives them.
[[nodiscard]] std::vector<std::unique_ptr<Workspace>> makeWorkspaces(Studio& studio);

} // namespace lumorph::studio
