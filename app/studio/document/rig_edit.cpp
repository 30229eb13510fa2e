#include "app/studio/document/rig_edit.h"

#include <utility>

namespace lumorph::studio {

namespace {

std::function<void(StudioState&)> onParts(const RigEdit& edit) {
    return [&edit](StudioState& state) {
        if (!state.rig.parts) return;
        RigParts parts = *state.rig.parts;
        edit(parts);
        if (parts == *state.rig.parts) return;
        state.rig.parts = std::make_shared<const RigParts>(std::move(parts));
    };
}

} // namespace

void editRig(StudioDocument& document, const QString& what, const RigEdit& edit) {
    document.change(what, onParts(edit));
}

void previewRig(StudioDocument& document, const RigEdit& edit) { document.preview(onParts(edit)); }

} // namespace lumorph::studio
