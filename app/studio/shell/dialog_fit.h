#pragma once

#include <QDialog>

namespace lumorph::studio {

/// Gives a dialog the size its contents need at its width, and where the screen has less room than that, the room there
/// is with a scroll bar. Called as it is about to be shown.
void fitDialog(QDialog& dialog);

} // namespace lumorph::studio
