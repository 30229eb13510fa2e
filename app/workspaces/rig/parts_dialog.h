#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// The window that says what is to be printed, bought and wired to build the open rig, for a servo and a printer of the
/// user's choice, and why it cannot be built. What is accepted is written into a new folder in one that is then asked
/// for, as a job; a notice at "rig" says where it is. Only one is open at a time.
void openPartsDialog(Studio& studio, QWidget* parent);

} // namespace lumorph::studio
