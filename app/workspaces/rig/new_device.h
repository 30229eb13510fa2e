#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// The window in which a device is begun: a kind, its measures, and what comes of them, drawn at once. What is accepted
/// becomes the document's rig by one step of undo. Only one is open at a time.
void openNewDevice(Studio& studio, QWidget* parent);

} // namespace lumorph::studio
