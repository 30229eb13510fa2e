#include "core/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

#include "core/scene/item_surfaces.h"

namespace lumorph {

glm::mat4 parentFromItem(const SceneItem& item, double seconds) {
    glm::vec3 position = item.position;
    if (item.motion.bob != 0.0 && item.motion.bobPeriod > 0.0)
        position.y += static_cast<float>(
            item.motion.bob * std::sin(2.0 * std::numbers::pi * std::fmod(seconds / item.motion.bobPeriod, 1.0)));
    // Whole turns are taken away while there are digits to spare: a show may run for weeks.
    const double turn = std::fmod(item.motion.spin * seconds, 2.0 * std::numbers::pi);
    const glm::mat4 spin = glm::rotate(glm::mat4(1.0F), static_cast<float>(turn), {0.0F, 1.0F, 0.0F});
    return glm::scale(glm::translate(glm::mat4(1.0F), position) * spin * glm::mat4_cast(item.rotation), item.scale);
}

const SceneItem* findItem(const Scene& scene, int id) {
    const auto found = std::ranges::find(scene.items, id, &SceneItem::id);
    return id == 0 || found == scene.items.end() ? nullptr : &*found;
}

bool isShown(const Scene& scene, const SceneItem& item) {
    const SceneItem* shown = &item;
    // As many steps as there are items: parents that nobody has checked may go round in a circle.
    for (std::size_t steps = 0; shown && shown->visible && steps < scene.items.size(); ++steps) {
        if (shown->parent == 0) return true;
        shown = findItem(scene, shown->parent);
    }
    return shown == nullptr;
}

const SceneItem* drivingItem(const Scene& scene) {
    const auto found =
        std::ranges::find_if(scene.items, [](const SceneItem& item) { return item.role != ItemRole::virtualOnly; });
    return found == scene.items.end() ? nullptr : &*found;
}

glm::mat4 anchorFromItem(const Scene& scene, const SceneItem& item, double seconds) {
    glm::mat4 matrix = parentFromItem(item, seconds);
    // As many steps as there are items: parents of a scene that nobody has checked may go round in a circle.
    const SceneItem* parent = findItem(scene, item.parent);
    for (std::size_t steps = 0; parent && steps < scene.items.size(); ++steps) {
        matrix = parentFromItem(*parent, seconds) * matrix;
        parent = findItem(scene, parent->parent);
    }
    return matrix;
}

} // namespace lumorph
