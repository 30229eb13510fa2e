#include "app/applications/navigation/inset.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "app/applications/demo_items.h"
#include "app/applications/navigation/shapes.h"

namespace lumorph::navigation {
namespace {

constexpr const char* kInsetAsset = "navigation inset";
constexpr int kInsetPixels = 256;         ///< of the longer side
constexpr double kInsetMargin = 0.04;     ///< of the longer side
constexpr double kFromRim = 0.0035;       ///< device metres
constexpr double kDeviceLower = 0.008;    ///< metres by which the device may lie lower than the land on it
constexpr double kNearer = 0.055;         ///< metres towards the eye, before all that stands
constexpr double kFrameLine = 0.0007;     ///< width of the frame's sides, device metres
constexpr double kSmallestFrame = 0.0026; ///< device metres

/// The land from above with light from the north-west, as on a printed map.
std::shared_ptr<const Image> pictureOf(const Map& map, const glm::ivec2& pixels) {
    auto image = std::make_shared<Image>(pixels);
    const double margin = kInsetMargin * kInsetPixels;
    const glm::dvec2 size = map.heights.size(), inner = glm::dvec2(pixels) - 2.0 * margin;
    const double detail = size.x / inner.x;
    for (int y = 0; y < pixels.y; ++y)
        for (int x = 0; x < pixels.x; ++x) {
            const glm::dvec2 share = (glm::dvec2(x, y) + 0.5 - margin) / inner;
            glm::vec3 color(0.97F, 0.95F, 0.89F);
            if (std::min(share.x, share.y) >= 0.0 && std::max(share.x, share.y) <= 1.0) {
                const glm::dvec2 place = share * size;
                const glm::dvec2 slope = map.heights.slopeAt(place, detail);
                const double light = std::clamp(1.0 + 0.55 * (slope.x + slope.y), 0.55, 1.3);
                const glm::ivec2 sample = map.sampleAt(place);
                color = map.isWater(sample) ? glm::vec3(0.22F, 0.47F, 0.60F)
                                            : static_cast<float>(light) * map.cover[map.index(sample)];
            }
            const glm::ivec3 bytes(255.0F * glm::clamp(color, 0.0F, 1.0F) + 0.5F);
            image->at(x, y) = {static_cast<std::uint8_t>(bytes.r), static_cast<std::uint8_t>(bytes.g),
                               static_cast<std::uint8_t>(bytes.b), 255};
        }
    return image;
}

/// A sheet around its middle that lies flat, north away from who looks along -z.
std::shared_ptr<const SceneModel> flatSheet(const glm::dvec2& half) {
    const auto x = static_cast<float>(half.x), z = static_cast<float>(half.y);
    Model::Primitive primitive;
    primitive.positions = {{-x, 0.0F, -z}, {-x, 0.0F, z}, {x, 0.0F, z}, {x, 0.0F, -z}};
    primitive.normals.assign(4, {0.0F, 1.0F, 0.0F});
    primitive.texcoords = {{0.0F, 0.0F}, {0.0F, 1.0F}, {1.0F, 1.0F}, {1.0F, 0.0F}};
    primitive.triangles = {{0, 1, 2}, {0, 2, 3}};
    auto sheet = std::make_shared<SceneModel>();
    Model::Mesh mesh;
    mesh.primitives.push_back(std::move(primitive));
    sheet->model.meshes.push_back(std::move(mesh));
    Model::Node node;
    node.mesh = 0;
    sheet->model.nodes.push_back(std::move(node));
    sheet->model.roots = {0};
    return sheet;
}

/// 1 for who looks from the device's near side, -1 from behind it.
double sideOf(const glm::dvec3& eye) { return eye.z >= 0.0 ? 1.0 : -1.0; }

} // namespace

Inset::Inset(const Map& map) : mapSize_(map.heights.size()) {
    const glm::dvec2 share = mapSize_ / std::max(mapSize_.x, mapSize_.y);
    half_ = 0.5 * kSide * ((1.0 - 2.0 * kInsetMargin) * share + 2.0 * kInsetMargin);
    picture_ = pictureOf(map, glm::ivec2(glm::round(half_ * (2.0 / kSide) * static_cast<double>(kInsetPixels))));
    sheet_ = flatSheet(half_);
}

void Inset::addTo(SceneAssets& assets) const {
    assets.models[kInsetAsset] = sheet_;
    assets.images[kInsetAsset] = picture_;
}

double Inset::opacity(const MapView& view) const noexcept {
    const double widest = widestView(mapSize_);
    return 1.0 - smoothStep(0.5 * widest, 0.72 * widest, view.width);
}

glm::dvec2 Inset::pointAt(const glm::dvec2& place, const glm::dvec3& eye) const noexcept {
    const glm::dvec2 inner = 2.0 * (half_ - kInsetMargin * kSide);
    return sideOf(eye) * (half_ - kHalf + kFromRim + inner * (place / mapSize_ - 0.5));
}

void Inset::show(Scene& scene, const ViewGround& ground, const glm::dvec3& eye) const {
    const MapView& view = ground.view();
    const auto opacity = static_cast<float>(this->opacity(view));
    if (opacity <= 0.0F) return;
    const glm::dvec2 corner = pointAt(0.5 * mapSize_, eye);
    const double height = std::max(ViewGround::kLowest, ground.surfaceAt(corner) - kDeviceLower);
    const glm::dvec3 middle(corner.x, height, corner.y);
    const double share = std::min(kNearer / std::max(glm::distance(eye, middle), 1e-9), 0.5);
    const auto place = [&](SceneItem& item, const glm::dvec3& at, double angle, const glm::dvec3& size) {
        item.position = glm::mix(at, eye, share); // all about the eye, so that it sees the same
        item.scale = (1.0 - share) * size;
        item.rotation = glm::angleAxis(static_cast<float>(angle), glm::vec3(0.0F, 1.0F, 0.0F));
        item.opacity = opacity;
    };
    SceneItem sheet =
        demoItem(kInsetItem, "Inset", MeshItem{.model = kInsetAsset, .animation = -1, .ownMaterials = false});
    place(sheet, middle, sideOf(eye) > 0.0 ? 0.0 : std::numbers::pi, glm::dvec3(1.0));
    sheet.material.name = "Inset";
    sheet.material.color = glm::vec3(1.0F);
    sheet.material.colorTexture.image = kInsetAsset;
    sheet.material.colorTexture.tile = glm::vec2(1.0F);
    sheet.material.alpha = Material::Alpha::blend;
    sheet.material.unlit = true;
    scene.items.push_back(std::move(sheet));
    const double metre = glm::length(pointAt({1.0, 0.0}, eye) - pointAt({0.0, 0.0}, eye));
    const double grown = std::max(1.0, kSmallestFrame / (view.width * metre));
    std::array<glm::dvec2, 4> corners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    for (glm::dvec2& at : corners) at = pointAt(view.centre + grown * (view.placeAt(at * kHalf) - view.centre), eye);
    for (std::size_t k = 0; k < 4; ++k) {
        const glm::dvec2 a = corners[k], b = corners[(k + 1) % 4], along = b - a;
        SceneItem side = demoItem(kInsetItem + 1 + static_cast<int>(k), "Inset frame",
                                  ShapeItem{ShapeItem::Form::box, glm::vec3(1.0F)});
        place(side, {0.5 * (a.x + b.x), height + 0.0004, 0.5 * (a.y + b.y)}, std::atan2(-along.y, along.x),
              {glm::length(along) + kFrameLine, 0.0003, kFrameLine});
        side.material.name = "Inset frame";
        side.material.color = {0.80F, 0.12F, 0.08F};
        side.material.alpha = Material::Alpha::blend;
        side.material.unlit = true;
        scene.items.push_back(std::move(side));
    }
}

} // namespace lumorph::navigation
