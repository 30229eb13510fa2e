#pragma once

#include <functional>

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph {
struct Demo;
}

namespace lumorph::studio {

/// What a host may tell a demonstration that has options, kept in the settings: a map of one's own, a place, a
/// forecast. Opens without blocking (objectName "dialog.options"); `start` is called when it shall begin with what was
/// said.
void openDemoOptions(Studio& studio, QWidget& window, const Demo& demo, std::function<void()> start);

} // namespace lumorph::studio
