#pragma once

#include <QWidget>

#include "app/studio/base/commands.h"

namespace lumorph::studio {

/// Shows the command palette over a window: type to find a command or a thing, Enter runs or chooses it, Esc or a click
/// beside it closes it. One that is open is closed instead.
void toggleCommandPalette(QWidget& window, Commands& commands);

} // namespace lumorph::studio
