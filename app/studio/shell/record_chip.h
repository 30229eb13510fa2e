#pragma once

#include <QWidget>

#include "app/studio/base/commands.h"

namespace lumorph::studio {

class RecordingService;

/// The button of the top bar: a click records; while it records it is red, says for how long, and a click stops it. The
/// commands record.start and record.stop must be there.
[[nodiscard]] QWidget* makeRecordButton(RecordingService& record, Commands& commands, QWidget* parent);

/// For the status line: a red dot, how long, the file and its size while it records, with what can be done about it in
/// a menu; else nothing.
[[nodiscard]] QWidget* makeRecordChip(RecordingService& record, Commands& commands, QWidget* parent);

} // namespace lumorph::studio
