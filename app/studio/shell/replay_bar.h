#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// Over the status line while a recording is shown: that it is one, play and pause, its time with the marks, speed,
/// what else can be done with it, and the way back to the live show. What there is to tell about recording and replay
/// stands above it. The commands of addRecordCommands must be there.
[[nodiscard]] QWidget* makeReplayBar(Studio& studio, QWidget* parent);

} // namespace lumorph::studio
