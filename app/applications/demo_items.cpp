#include "app/applications/demo_items.h"

#include <utility>

namespace lumorph {

SceneItem demoItem(int id, std::string name, ItemKind kind, int parent) {
    SceneItem item;
    item.id = id;
    item.parent = parent;
    item.name = std::move(name);
    item.kind = std::move(kind);
    return item;
}

void turnSun(Scene& scene, int group, double period) {
    SceneItem day = demoItem(group, "Day", GroupItem{});
    day.anchor = Anchor::world;
    // Whole degrees a second where they come out even, so that the file reads well.
    if (period > 0.0) day.motion.spin = Angle::degrees(360.0 / period).inRadians();
    scene.items.front().parent = group;
    scene.items.insert(scene.items.begin(), std::move(day));
}

} // namespace lumorph
