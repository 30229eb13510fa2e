#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// The window that builds a field: how fine, how many levels, how many samples, which seed, and what that will take.
/// Refuses wrong numbers where they are typed. Accepting it starts the work (`ProjectService::buildField`), whose
/// progress the place "field" shows. One that is open already comes to the front.
void openBuildDialog(Studio& studio, QWidget* parent);

} // namespace lumorph::studio
