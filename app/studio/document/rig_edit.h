#pragma once

#include <functional>

#include "app/studio/document/studio_document.h"

namespace lumorph::studio {

using RigEdit = std::function<void(RigParts&)>;

/// An edit of the document's rig as one step of undo; one that leaves it as it was is no step. What it looks like then
/// is compiled beside the window (`RigCompiler`).
void editRig(StudioDocument& document, const QString& what, const RigEdit& edit);
/// An edit while something is dragged; `StudioDocument::commitPreview` makes a step of undo of it.
void previewRig(StudioDocument& document, const RigEdit& edit);

} // namespace lumorph::studio
