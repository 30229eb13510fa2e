#pragma once

#include <functional>

#include "app/studio/base/operator_pin.h"
#include "app/studio/shell/overlay.h"

namespace lumorph::studio {

/// Asks for the operator's PIN over a window, by digits on the screen or keys. STOP stays in reach, and Esc is left to
/// it. Left alone for half a minute it goes away.
[[nodiscard]] Overlay* askPin(QWidget& window, OperatorPin& pin, const QString& why, std::function<void()> right);

/// Lets the operator choose a PIN, typed twice; where it `mayCancel`, without one too.
[[nodiscard]] Overlay* choosePin(QWidget& window, OperatorPin& pin, bool mayCancel, std::function<void()> chosen);

} // namespace lumorph::studio
