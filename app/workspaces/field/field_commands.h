#pragma once

#include <functional>

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// Adds the commands of target, rig and match: target.open, remove, fit, autoPlace, spin, play and dunes; rig.rest,
/// random and dance; match.live, refined and voting. They are enabled while they can do something. `parent` gives the
/// window for dialogs, when one is asked for.
void addFieldCommands(Studio& studio, std::function<QWidget*()> parent);

} // namespace lumorph::studio
