#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "core/scene/item_surfaces.h"
#include "core/scene/posed_scene.h"

namespace lumorph {
namespace {

/// sRGB to linear light.
glm::vec3 linear(const glm::vec3& color) {
    const auto one = [](float value) {
        return value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F);
    };
    return {one(color.r), one(color.g), one(color.b)};
}

bool finite(const glm::mat4& matrix) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(matrix[column][row])) return false;
    return true;
}

/// What is kept of an item from frame to frame.
struct Kept {
    ShapeItem shape;
    std::optional<ItemSurface> surface;
    std::optional<HeightSurface> height;
};

/// What an item takes from its groups.
struct Inherited {
    bool visible = true;
    float opacity = 1.0F;
    Anchor anchor = Anchor::device;
    glm::mat4 anchorFromItem{1.0F};
};

} // namespace

struct ScenePoser::Data {
    std::map<int, Kept> items;

    const ItemSurface& shape(int id, const ShapeItem& form) {
        Kept& kept = items[id];
        if (!kept.surface || !(kept.shape == form)) kept = Kept{form, shapeSurface(form), {}};
        return *kept.surface;
    }
    const ItemSurface& height(int id, const HeightItem& item, std::shared_ptr<const Image> image, double seconds) {
        Kept& kept = items[id];
        if (!kept.height || !(kept.height->item() == item) || kept.height->image() != image) {
            kept = Kept{};
            kept.height.emplace(item, std::move(image));
        }
        if (!kept.surface || !kept.height->still()) kept.surface = kept.height->at(seconds);
        return *kept.surface;
    }
};

ScenePoser::ScenePoser() : data_(std::make_unique<Data>()) {}
ScenePoser::~ScenePoser() = default;
ScenePoser::ScenePoser(ScenePoser&&) noexcept = default;
ScenePoser& ScenePoser::operator=(ScenePoser&&) noexcept = default;

PosedScene ScenePoser::pose(const Scene& scene, const SceneAssets& assets, const PoseInput& input) {
    PosedScene posed;
    posed.seconds = input.seconds;
    std::map<int, Inherited> groups;
    for (const SceneItem& item : scene.items) {
        Inherited state;
        if (const auto group = groups.find(item.parent); group != groups.end()) state = group->second;
        if (item.parent == 0) state.anchor = item.anchor;
        state.visible = state.visible && item.visible;
        state.opacity *= item.opacity;
        state.anchorFromItem = anchorFromItem(scene, item, input.seconds);
        if (std::holds_alternative<GroupItem>(item.kind)) groups[item.id] = state;
        const glm::mat4 worldFromAnchor = state.anchor == Anchor::device ? input.worldFromDevice : glm::mat4(1.0F);
        const glm::mat4 worldFromItem = worldFromAnchor * state.anchorFromItem;
        if (!state.visible || !finite(worldFromItem)) continue;
        const auto add = [&](const ItemSurface& surface) {
            posed.surfaces.push_back({item.id, surface.topology, surface.positions, surface.normals, worldFromItem,
                                      item.material, state.opacity, true});
        };
        if (const auto* light = std::get_if<LightItem>(&item.kind)) {
            const bool sun = light->kind == LightItem::Kind::sun;
            const glm::vec3 at(worldFromItem[3]);
            glm::vec3 direction = at - glm::vec3(worldFromAnchor[3]);
            if (!(glm::length(direction) > 1e-6F)) direction = {0.0F, 1.0F, 0.0F};
            posed.lights.push_back({item.id, sun, sun ? glm::normalize(direction) : at,
                                    linear(light->color) * static_cast<float>(light->intensity) * state.opacity,
                                    static_cast<float>(light->softness), light->shadows});
        }
        if (scene.showing == Showing::physical) continue;
        if (const auto* shape = std::get_if<ShapeItem>(&item.kind)) add(data_->shape(item.id, *shape));
        if (const auto* height = std::get_if<HeightItem>(&item.kind)) {
            const auto image = assets.images.find(height->image);
            add(data_->height(item.id, *height, image == assets.images.end() ? nullptr : image->second, input.seconds));
        }
        if (const auto* fog = std::get_if<FogItem>(&item.kind)) {
            posed.fogs.push_back({item.id, glm::scale(worldFromItem, fog->size), linear(fog->color),
                                  static_cast<float>(fog->density) * state.opacity, static_cast<float>(fog->grain),
                                  fog->drift * static_cast<float>(input.seconds)});
        }
    }
    return posed;
}

} // namespace lumorph
