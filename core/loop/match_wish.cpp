#include "core/loop/match_wish.h"

#include <variant>

#include "core/loop/scene_clock.h"

namespace lumorph {

Driver driverOf(bool live, const Scene* scene) {
    if (!live) return Driver::hand;
    const SceneItem* item = scene ? drivingItem(*scene) : nullptr;
    if (!item || !isShown(*scene, *item)) return Driver::target;
    const bool isTarget = std::holds_alternative<TargetItem>(item->kind) && item->role == ItemRole::physical;
    return isTarget ? Driver::target : Driver::sceneItem;
}

} // namespace lumorph
