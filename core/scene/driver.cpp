#include "core/scene/driver.h"

#include <variant>

namespace lumorph {

const SceneItem* drivingItemShown(const Scene& scene) {
    const SceneItem* item = drivingItem(scene);
    return item && isShown(scene, *item) ? item : nullptr;
}

const SceneItem* followableItem(const Scene& scene) {
    const SceneItem* item = drivingItemShown(scene);
    if (!item) return nullptr;
    const bool isTarget = std::holds_alternative<TargetItem>(item->kind) && item->role == ItemRole::physical;
    return isTarget ? nullptr : item;
}

Driver driverOf(const Scene& scene) { return followableItem(scene) ? Driver::sceneItem : Driver::target; }

} // namespace lumorph
