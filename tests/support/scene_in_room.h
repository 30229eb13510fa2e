#pragma once

#include <memory>

#include "core/scene/installation.h"
#include "core/scene/scene.h"

namespace lumorph {

/// A scene and the room in which it is shown, as one value that a test edits.
struct SceneInRoom : Scene, Installation {};

inline SceneInRoom defaultSceneInRoom() { return {defaultScene(), defaultInstallation()}; }

/// Gives both to what has a place for each: a frame, a wish for the loop, a state.
template <typename Holder> void setSceneInRoom(Holder& holder, const SceneInRoom& shown) {
    holder.scene = std::make_shared<const Scene>(shown);
    holder.installation = std::make_shared<const Installation>(shown);
}

} // namespace lumorph
