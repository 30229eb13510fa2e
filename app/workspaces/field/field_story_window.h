#pragma once

#include <functional>

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// Adds the command field.story, "How the field works": a window that tells it in six steps on the device that is open,
/// with its own field and target; a field that is missing is built first. `parent` gives the main window, or null.
void addFieldStory(Studio& studio, const std::function<QWidget*()>& parent);

} // namespace lumorph::studio
