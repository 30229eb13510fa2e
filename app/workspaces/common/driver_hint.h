#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// Says why the open target is not what the servos follow, with a button that lets them; nothing while they follow it
/// or there is none. The text is `name`.text, the button `name`.remedy.
[[nodiscard]] QWidget* makeDriverHint(Studio& studio, const QString& name, QWidget* parent);

/// Whether what the loop says of the match is about servos that follow something else than the open target. By hand it
/// is still about the target: how well the user's own pose fits it.
[[nodiscard]] bool isTargetLeft(const Studio& studio);

} // namespace lumorph::studio
