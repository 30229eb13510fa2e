#pragma once

#include "core/scene/scene.h"

namespace lumorph {

/// Who moves the servos. View dependence joins in by the larger stroke, whoever it is, and a scene that shows light
/// alone (Showing::virtualOnly) holds them at rest; a recording knows neither.
enum class Driver {
    target,    ///< the target is matched by the field; without one of them the strokes set by hand are held
    sceneItem, ///< heights of the scene's visible driving item, or of its slow part where its role is split; without
               ///< such an item, or where it stands for a target that is not there, the strokes are held
    hand,      ///< the strokes are held
    dance,     ///< random moves that begin at the strokes
    recording, ///< frames of a recording are shown, with servos as they say
    program,   ///< what the show program asks of them; where it asks nothing, has ended, or wants to be matched without
               ///< a field, the strokes are held
};

/// The scene's driving item, if it and all groups around it are visible.
[[nodiscard]] const SceneItem* drivingItemShown(const Scene& scene);

/// The scene's driving item where the servos can follow its heights: it is visible, and does not stand for the match
/// target as a whole. Null without one.
[[nodiscard]] const SceneItem* followableItem(const Scene& scene);

/// Whom a scene lets the servos follow by itself: its followable item, else the target.
[[nodiscard]] Driver driverOf(const Scene& scene);

} // namespace lumorph
