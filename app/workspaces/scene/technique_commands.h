#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// Adds a command for each technique of painting with light; while their demo is open the number keys show them.
void addTechniqueCommands(Studio& studio);

/// The techniques as a row of numbers, with what is to be seen; there only while their demo is open.
[[nodiscard]] QWidget* makeTechniqueBar(Studio& studio, QWidget* parent = nullptr);

} // namespace lumorph::studio
