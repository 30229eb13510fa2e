#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// Commands about recording and replay: record.start, .startAs, .mark, .folder, .stop; replay.open, .play, .verify,
/// .export, .project, .close. Recordings that are opened as any file are replayed.
void addRecordCommands(Studio& studio, QWidget& window);

} // namespace lumorph::studio
