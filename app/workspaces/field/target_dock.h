#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// The content of the dock "dock.target": what the target is, where it stands, how it moves. Uses the commands
/// target.open, target.remove, target.fit, target.autoPlace, target.play and target.spin, which must be there.
[[nodiscard]] QWidget* makeTargetDock(Studio& studio);

} // namespace lumorph::studio
