#include "app/applications/demo_items.h"

#include <utility>
#include <vector>

#include "core/scene/posed_scene.h"

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

HeightGrid gridOf(const SceneItem& item, double seconds) {
    constexpr int kColumns = 57, kRows = 41;
    const auto& field = std::get<HeightItem>(item.kind);
    const glm::vec2 half = 0.5F * field.size;
    HeightGrid grid;
    grid.min = -glm::dvec2(half);
    grid.max = glm::dvec2(half);
    grid.columns = kColumns;
    grid.rows = kRows;
    std::vector<glm::vec2> points;
    for (int j = 0; j < kRows; ++j)
        for (int i = 0; i < kColumns; ++i)
            points.push_back(half * glm::vec2(2.0F * static_cast<float>(i) / (kColumns - 1) - 1.0F,
                                              2.0F * static_cast<float>(j) / (kRows - 1) - 1.0F));
    grid.heights.resize(points.size());
    sampleHeights(field, nullptr, seconds, points, grid.heights);
    for (float& height : grid.heights) height += item.position.y;
    return grid;
}

} // namespace lumorph
