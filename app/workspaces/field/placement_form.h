#pragma once

#include <QWidget>

#include "app/studio/document/studio_document.h"

namespace lumorph::studio {

/// Place, heading and size of the target as numbers "target.x", "target.y", "target.z", "target.turn" and
/// "target.size"; a scrub is one step of undo.
[[nodiscard]] QWidget* makePlacementForm(StudioDocument& document, QWidget* parent = nullptr);

} // namespace lumorph::studio
