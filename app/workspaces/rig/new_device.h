#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// The setting that holds the folder where rigs were last looked for.
inline constexpr const char* kRigFolder = "folders/rig";

/// The window in which a device is begun: a kind and its measures, or files that hold one, of whose joints and morph
/// targets one ticks those that are actuators; and what comes of it, drawn at once. What is accepted becomes the
/// document's rig by one step of undo. Only one is open at a time.
void openNewDevice(Studio& studio, QWidget* parent);

} // namespace lumorph::studio
