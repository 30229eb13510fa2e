#include "core/scene/posed_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "core/base/error.h"
#include "core/base/srgb.h"
#include "core/scene/item_surfaces.h"

namespace lumorph {
namespace {

bool finite(const glm::mat4& matrix) {
    for (int i = 0; i < 16; ++i)
        if (!std::isfinite(matrix[i / 4][i % 4])) return false;
    return true;
}

/// A matrix under which a surface stays a surface.
bool usable(const glm::mat4& matrix) { return finite(matrix) && glm::determinant(glm::dmat3(matrix)) != 0.0; }

/// What stands for a model that cannot be shown.
constexpr ShapeItem kBrokenBox{ShapeItem::Form::box, glm::vec3(0.05F)};

Material brokenMaterial() {
    Material material;
    material.name = "Broken";
    material.color = {1.0F, 0.0F, 1.0F};
    material.unlit = true;
    return material;
}

/// What an item has from its groups.
struct Inherited {
    bool visible = true;
    float opacity = 1.0F;
    Anchor anchor = Anchor::device;
    glm::mat4 anchorFromItem{1.0F};
};

/// What is kept of an item from frame to frame, by its kind.
struct KeptShape {
    ShapeItem shape;
    ItemSurface surface;
};
struct KeptHeights {
    HeightSurface heights;
    ItemSurface surface;
};
struct KeptTarget {
    std::shared_ptr<const TriangleMesh> mesh;
    ShadedSurface shaded;
    std::shared_ptr<const std::vector<glm::vec3>> positions;
    ItemSurface surface;
};
using Kept = std::variant<std::monostate, KeptShape, KeptHeights, KeptTarget, ModelSurfaces>;

const ItemSurface& shapeOf(Kept& kept, const ShapeItem& shape) {
    const auto* known = std::get_if<KeptShape>(&kept);
    if (!known || !(known->shape == shape)) kept = KeptShape{shape, shapeSurface(shape)};
    return std::get<KeptShape>(kept).surface;
}

bool sameButForWaves(const HeightItem& a, const HeightItem& b) {
    return a.size == b.size && a.image == b.image && a.imageHeight == b.imageHeight && a.floor == b.floor &&
           a.calmEdge == b.calmEdge;
}

/// The grid is kept where only the waves are others: a program may change them each frame.
const ItemSurface& heightsOf(Kept& kept, const HeightItem& item, const std::shared_ptr<const Image>& image,
                             double seconds) {
    auto* known = std::get_if<KeptHeights>(&kept);
    if (!known || known->heights.image() != image || !sameButForWaves(known->heights.item(), item))
        known = &kept.emplace<KeptHeights>(KeptHeights{HeightSurface(item, image), {}});
    const bool sameWaves = known->heights.item().waves == item.waves;
    if (sameWaves && known->heights.still() && known->surface.positions) return known->surface;
    if (!sameWaves) known->heights.setWaves(item.waves);
    known->surface = known->heights.at(seconds);
    return known->surface;
}

/// Mapped in metres from above.
KeptTarget keptTarget(const std::shared_ptr<const TriangleMesh>& mesh) {
    std::vector<glm::vec2> coordinates;
    coordinates.reserve(mesh->positions.size());
    for (const glm::vec3& p : mesh->positions) coordinates.emplace_back(p.x, p.z);
    return {mesh, ShadedSurface(*mesh, coordinates), nullptr, {}};
}

const ItemSurface* targetOf(Kept& kept, const PoseInput& input) {
    if (!input.targetMesh || input.targetMesh->triangles.empty()) return nullptr;
    auto* known = std::get_if<KeptTarget>(&kept);
    if (!known || known->mesh != input.targetMesh) known = &kept.emplace<KeptTarget>(keptTarget(input.targetMesh));
    const std::vector<glm::vec3>& points = input.targetPositions ? *input.targetPositions : input.targetMesh->positions;
    if (points.size() != input.targetMesh->positions.size()) return nullptr;
    if (!known->surface.positions || known->positions != input.targetPositions) {
        known->surface = known->shaded.at(points);
        known->positions = input.targetPositions;
    }
    return &known->surface;
}

ModelSurfaces& modelOf(Kept& kept, const MeshItem& item, const std::shared_ptr<const SceneModel>& model) {
    const int animation = item.animation < std::ssize(model->model.animations) ? item.animation : -1;
    auto* known = std::get_if<ModelSurfaces>(&kept);
    if (!known || known->model() != model || known->animation() != animation)
        known = &kept.emplace<ModelSurfaces>(model, animation);
    return *known;
}

} // namespace

struct ScenePoser::Data {
    std::map<int, Kept> kept;
};

namespace {

/// One pass over the items.
class Posing {
public:
    Posing(const Scene& scene, const SceneAssets& assets, const PoseInput& input, std::map<int, Kept>& kept)
        : scene_(scene), assets_(assets), input_(input), kept_(kept) {
        posed_.seconds = std::isfinite(input.seconds) ? input.seconds : 0.0;
    }

    PosedScene run() {
        for (const SceneItem& item : scene_.items) add(item);
        std::erase_if(kept_, [this](const auto& entry) { return !seen_.contains(entry.first); });
        return std::move(posed_);
    }

private:
    void add(const SceneItem& item) {
        seen_.insert(item.id);
        const Inherited state = inherited(item);
        if (std::holds_alternative<GroupItem>(item.kind)) groups_[item.id] = state;
        if (!state.visible) return;
        const glm::mat4 worldFromAnchor = state.anchor == Anchor::device ? input_.worldFromDevice : glm::mat4(1.0F);
        const glm::mat4 worldFromItem = worldFromAnchor * state.anchorFromItem;
        if (!usable(worldFromItem)) return;
        if (const auto* light = std::get_if<LightItem>(&item.kind))
            addLight(item, *light, worldFromItem, worldFromAnchor, state.opacity);
        else if (scene_.showing != Showing::physical)
            std::visit([&](const auto& kind) { addKind(item, kind, worldFromItem, state.opacity); }, item.kind);
    }

    Inherited inherited(const SceneItem& item) const {
        Inherited state;
        state.anchor = item.anchor;
        if (const auto group = groups_.find(item.parent); group != groups_.end()) state = group->second;
        state.visible = state.visible && item.visible;
        state.opacity *= item.opacity;
        state.anchorFromItem = state.anchorFromItem * parentFromItem(item, posed_.seconds);
        return state;
    }

    void addLight(const SceneItem& item, const LightItem& light, const glm::mat4& worldFromItem,
                  const glm::mat4& worldFromAnchor, float share) {
        const bool sun = light.kind == LightItem::Kind::sun;
        glm::vec3 position(worldFromItem[3]);
        if (sun) {
            const glm::vec3 towards = position - glm::vec3(worldFromAnchor[3]);
            // One that stands in the middle has no direction: it shines from above.
            position = glm::length(towards) > 1e-6F ? glm::normalize(towards) : glm::vec3(0.0F, 1.0F, 0.0F);
        }
        posed_.lights.push_back({item.id, sun, position,
                                 linearFromSrgb(light.color) * static_cast<float>(light.intensity) * share,
                                 static_cast<float>(light.softness), light.shadows});
    }

    void addSurface(const SceneItem& item, const ItemSurface& surface, const glm::mat4& worldFromSurface,
                    const Material& material, float opacity) {
        if (!usable(worldFromSurface)) return;
        // What is hardly there throws no shadow, nor does a sign that stands in the air to be read.
        const bool blended = material.alpha == Material::Alpha::blend;
        const float own = blended ? material.opacity : 1.0F;
        const bool casts = own * opacity >= 0.5F && !(blended && material.unlit);
        posed_.surfaces.push_back({item.id, surface.topology, surface.positions, surface.normals, worldFromSurface,
                                   material, opacity, casts});
    }

    void addKind(const SceneItem& item, const ShapeItem& shape, const glm::mat4& worldFromItem, float opacity) {
        addSurface(item, shapeOf(kept_[item.id], shape), worldFromItem, item.material, opacity);
    }

    void addKind(const SceneItem& item, const HeightItem& heights, const glm::mat4& worldFromItem, float opacity) {
        const auto image = assets_.images.find(heights.image);
        const auto picture = image == assets_.images.end() ? nullptr : image->second;
        addSurface(item, heightsOf(kept_[item.id], heights, picture, posed_.seconds), worldFromItem, item.material,
                   opacity);
    }

    /// It stands where the matcher has it, whatever the item's own place.
    void addKind(const SceneItem& item, const TargetItem& /*target*/, const glm::mat4& /*worldFromItem*/,
                 float opacity) {
        if (const ItemSurface* surface = targetOf(kept_[item.id], input_))
            addSurface(item, *surface, input_.worldFromDevice * input_.deviceFromTarget, item.material, opacity);
    }

    void addKind(const SceneItem& item, const MeshItem& mesh, const glm::mat4& worldFromItem, float opacity) {
        if (mesh.model.empty()) return;
        const auto model = assets_.models.find(mesh.model);
        if (model == assets_.models.end()) {
            addSurface(item, shapeOf(kept_[item.id], kBrokenBox), worldFromItem, brokenMaterial(), opacity);
            return;
        }
        const std::vector<Material>& materials = model->second->materials;
        ModelSurfaces& surfaces = modelOf(kept_[item.id], mesh, model->second);
        for (const ModelSurface& surface : surfaces.at(posed_.seconds * mesh.speed)) {
            const auto index = static_cast<std::size_t>(surface.material);
            const bool own = mesh.ownMaterials && surface.material >= 0 && index < materials.size();
            addSurface(item, surface.surface, worldFromItem * surface.itemFromSurface,
                       own ? materials[index] : item.material, opacity);
        }
    }

    void addKind(const SceneItem& item, const FogItem& fog, const glm::mat4& worldFromItem, float opacity) {
        posed_.fogs.push_back({item.id, glm::scale(worldFromItem, fog.size), linearFromSrgb(fog.color),
                               static_cast<float>(fog.density) * opacity, static_cast<float>(fog.grain),
                               fog.drift * static_cast<float>(posed_.seconds)});
    }

    void addKind(const SceneItem&, const LightItem&, const glm::mat4&, float) {}
    void addKind(const SceneItem&, const GroupItem&, const glm::mat4&, float) {}

    const Scene& scene_;
    const SceneAssets& assets_;
    const PoseInput& input_;
    std::map<int, Kept>& kept_;
    std::map<int, Inherited> groups_;
    std::set<int> seen_;
    PosedScene posed_;
};

} // namespace

ScenePoser::ScenePoser() : data_(std::make_unique<Data>()) {}
ScenePoser::~ScenePoser() = default;
ScenePoser::ScenePoser(ScenePoser&&) noexcept = default;
ScenePoser& ScenePoser::operator=(ScenePoser&&) noexcept = default;

PosedScene ScenePoser::pose(const Scene& scene, const SceneAssets& assets, const PoseInput& input) {
    return Posing(scene, assets, input, data_->kept).run();
}

} // namespace lumorph
