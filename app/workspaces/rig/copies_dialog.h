#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// Asks where copies of an actuator are to stand, around the middle or along a line, and makes them as one step of
/// undo; why that cannot be stands in the dialog.
void openCopiesDialog(Studio& studio, std::size_t actuator, QWidget* parent);

} // namespace lumorph::studio
