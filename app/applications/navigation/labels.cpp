#include "app/applications/navigation/labels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/demo_items.h"
#include "core/base/resources.h"
#include "core/render/figure/text.h"

namespace lumorph::navigation {
namespace {

constexpr int kPixels = 96; ///< height of a plate's picture
constexpr float kEm = 56.0F, kPadding = 30.0F, kPlateRound = 40.0F;
constexpr double kShortestPole = 0.012, kPlateStep = 1.12 * Labels::kPlateHeight; ///< metres
constexpr int kPlateSteps = 4;                                                    ///< by which a plate may stand higher
constexpr double kFades = 0.22;                                                   ///< seconds
constexpr double kBefore = 0.055;                                                 ///< metres before all that stands
constexpr double kPoleWidth = 0.0005;                                             ///< metres
constexpr double kNamedTo = 9.0;        ///< times its own width a view may be and still name a place
constexpr double kInside = 0.003;       ///< metres from the rim within which a place has a name
constexpr double kInsideTop = 0.002;    ///< metres from the rim to which a plate may reach
constexpr double kFarthestShift = 0.62; ///< of a plate's width
constexpr double kLower = 0.006;        ///< metres by which the device may lie lower than the land on it

/// Dark letters on a light plate with round ends.
std::shared_ptr<const Image> written(const Font& font, const std::string& name) {
    const float text = font.width(name, kEm);
    auto image = std::make_shared<Image>(glm::ivec2(static_cast<int>(std::ceil(text + 2.0F * kPadding)), kPixels),
                                         Image::Pixel{252, 249, 240, 0});
    const glm::vec2 half = 0.5F * glm::vec2(image->size());
    for (int y = 0; y < image->size().y; ++y)
        for (int x = 0; x < image->size().x; ++x) {
            const glm::vec2 out = glm::max(glm::abs(glm::vec2(x, y) + 0.5F - half) - (half - kPlateRound - 3.0F), 0.0F);
            const float inside = kPlateRound - glm::length(out);
            image->at(x, y)[3] = static_cast<std::uint8_t>(255.0F * glm::clamp(inside + 0.5F, 0.0F, 1.0F));
        }
    font.write(*image, name, {kPadding, 0.5F * kPixels + 0.36F * kEm}, kEm, {0.10F, 0.13F, 0.20F});
    return image;
}

/// A sheet around its middle that faces +z.
std::shared_ptr<const SceneModel> sheetOf(double width) {
    const auto x = static_cast<float>(0.5 * width), y = static_cast<float>(0.5 * Labels::kPlateHeight);
    Model::Primitive primitive;
    primitive.positions = {{-x, -y, 0.0F}, {x, -y, 0.0F}, {x, y, 0.0F}, {-x, y, 0.0F}};
    primitive.normals.assign(4, {0.0F, 0.0F, 1.0F});
    primitive.texcoords = {{0.0F, 1.0F}, {1.0F, 1.0F}, {1.0F, 0.0F}, {0.0F, 0.0F}};
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

Material plateMaterial(const std::string& picture) {
    Material material;
    material.name = "Plate";
    material.color = glm::vec3(1.0F);
    material.colorTexture.image = picture;
    material.colorTexture.tile = glm::vec2(1.0F);
    material.alpha = Material::Alpha::blend;
    material.unlit = true;
    return material;
}

} // namespace

glm::dquat facing(const glm::dvec3& from, const glm::dvec3& eye) noexcept {
    const glm::dvec3 way = eye - from;
    const glm::dvec3 z = glm::length(way) > 1e-9 ? glm::normalize(way) : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 beside = glm::cross(glm::dvec3(0.0, 1.0, 0.0), z);
    const glm::dvec3 x = glm::length(beside) > 1e-6 ? glm::normalize(beside) : glm::dvec3(1.0, 0.0, 0.0);
    return glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)));
}

Labels::Labels(const Map& map) {
    const Font font(resourceFile("fonts/Inter-SemiBold.otf"));
    std::vector<std::size_t> order(map.places.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t k) { return map.places[k].rank; });
    order.resize(std::min(order.size(), kMost));
    for (const std::size_t place : order) {
        Plate plate;
        plate.place = place;
        const Words& name = map.places[place].name;
        const std::string model = "navigation label " + std::to_string(place);
        plate.writings.fill(write(font, name.english, model));
        if (name.in(Language::german) != name.english)
            plate.writings[static_cast<std::size_t>(Language::german)] = write(font, name.german, model + " german");
        plates_.push_back(std::move(plate));
    }
}

Labels::Writing Labels::write(const Font& font, const std::string& text, const std::string& model) {
    Writing writing;
    writing.model = model;
    writing.picture = written(font, text);
    writing.width = kPlateHeight * writing.picture->size().x / writing.picture->size().y;
    writing.material = plateMaterial(model);
    writing.shape = sheetOf(writing.width);
    return writing;
}

void Labels::addTo(SceneAssets& assets) const {
    for (const Plate& plate : plates_)
        for (const Writing& writing : plate.writings) {
            assets.models[writing.model] = writing.shape;
            assets.images[writing.model] = writing.picture;
        }
}

std::optional<glm::dvec2> shiftToTop(const glm::dvec3& middle, double width, const glm::dvec3& eye,
                                     double top) noexcept {
    const double enlarged = (eye.y - top) / std::max(eye.y - middle.y, 1e-9); // of the plate, seen down there
    if (eye.y <= middle.y || middle.y < top) return glm::dvec2(0.0);
    const glm::dmat3 axes = glm::mat3_cast(facing(middle, eye));
    glm::dvec2 least(std::numeric_limits<double>::infinity()), most = -least;
    for (const glm::dvec2& way : {glm::dvec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
        const glm::dvec3 corner = middle + 0.5 * width * way.x * axes[0] + 0.5 * Labels::kPlateHeight * way.y * axes[1];
        const glm::dvec3 seen = eye + (eye.y - top) / std::max(eye.y - corner.y, 1e-9) * (corner - eye);
        least = glm::min(least, glm::dvec2(seen.x, seen.z));
        most = glm::max(most, glm::dvec2(seen.x, seen.z));
    }
    const glm::dvec2 limit = kHalf - kInsideTop;
    const glm::dvec2 shift = (glm::max(-limit - least, 0.0) - glm::max(most - limit, 0.0)) / enlarged;
    if (glm::length(shift) > kFarthestShift * width) return std::nullopt;
    return shift;
}

/// The least lift by which a plate hides none of those before it from the eye; nothing where there is none.
std::optional<Labels::Room> Labels::findRoom(const Plate& plate, const std::vector<const Plate*>& before,
                                             const glm::dvec3& eye) const {
    const glm::dmat3 axes = glm::mat3_cast(facing(plate.foot, eye));
    const auto middleOf = [](const glm::dvec3& foot, double lift, const glm::dvec2& shift) {
        return foot + glm::dvec3(shift.x, kShortestPole + lift, shift.y);
    };
    for (int step = 0; step < kPlateSteps; ++step) {
        const double lift = step * kPlateStep;
        const auto shift =
            shiftToTop(middleOf(plate.foot, lift, {}), plate.writing().width, eye, plate.foot.y - kLower);
        if (!shift) continue;
        const glm::dvec3 middle = middleOf(plate.foot, lift, *shift);
        const bool free = std::ranges::none_of(before, [&](const Plate* other) {
            const glm::dvec3 off = middleOf(other->foot, other->lift, other->shift) - middle;
            return std::abs(glm::dot(off, axes[0])) < 0.52 * (plate.writing().width + other->writing().width) &&
                   std::abs(glm::dot(off, axes[1])) < 1.05 * kPlateHeight;
        });
        if (free) return Room{lift, *shift};
    }
    return std::nullopt;
}

void Labels::arrange(const Map& map, const ViewGround& ground, const glm::dvec3& eye, Language language,
                     double seconds) {
    std::vector<const Plate*> shown;
    for (Plate& plate : plates_) {
        plate.language = language;
        const glm::dvec2 point = ground.view().pointAt(map.places[plate.place].at);
        const glm::dvec2 inside = kHalf - glm::abs(point);
        const Place& place = map.places[plate.place];
        const bool near = place.rank == 0 || ground.view().width < kNamedTo * place.width;
        const bool over = near && std::min(inside.x, inside.y) > kInside;
        if (over) plate.foot = {point.x, ground.surfaceAt(point), point.y};
        plate.wanted = over && shown.size() < kMostShown;
        if (plate.wanted) {
            const std::optional<Room> room = findRoom(plate, shown, eye);
            plate.wanted = room.has_value();
            if (room) {
                const double stays = plate.opacity > 0.0 ? std::exp(-seconds / kFades) : 0.0;
                plate.lift = std::lerp(room->lift, plate.lift, stays);
                plate.shift = glm::mix(room->shift, plate.shift, stays);
                shown.push_back(&plate);
            }
        }
        const double goal = plate.wanted ? 1.0 : 0.0;
        plate.opacity = std::lerp(goal, plate.opacity, std::exp(-seconds / kFades));
        if (std::abs(plate.opacity - goal) < 0.02) plate.opacity = goal;
        plate.middle = plate.foot + glm::dvec3(plate.shift.x, kShortestPole + plate.lift, plate.shift.y);
        plate.rotation = glm::quat(facing(plate.middle, eye));
        const double far = glm::distance(eye, plate.middle);
        const double share = std::min(kBefore / std::max(far, 1e-9), 0.5);
        plate.before = glm::mix(plate.middle, eye, share);
        plate.size = 1.0 - share;
    }
}

void Labels::show(Scene& scene) const {
    for (const Plate& plate : plates_) {
        if (plate.opacity <= 0.0) continue;
        const int id = kFirstLabel + 2 * static_cast<int>(plate.place);
        SceneItem sheet =
            demoItem(id, "Label", MeshItem{.model = plate.writing().model, .animation = -1, .ownMaterials = false});
        sheet.position = plate.before;
        sheet.scale = glm::vec3(static_cast<float>(plate.size));
        sheet.rotation = plate.rotation;
        sheet.material = plate.writing().material;
        sheet.opacity = static_cast<float>(plate.opacity);
        scene.items.push_back(std::move(sheet));
        const double height = std::max(1e-4, plate.middle.y - 0.5 * kPlateHeight - plate.foot.y);
        SceneItem pole = demoItem(id + 1, "Pole", ShapeItem{ShapeItem::Form::box, glm::vec3(1.0F)});
        pole.position = plate.foot + glm::dvec3(0.0, 0.5 * height, 0.0);
        pole.scale = {glm::dvec3(kPoleWidth, height, kPoleWidth)};
        pole.material.name = "Pole";
        pole.material.color = {0.95F, 0.93F, 0.88F};
        pole.opacity = static_cast<float>(plate.opacity);
        scene.items.push_back(std::move(pole));
    }
}

} // namespace lumorph::navigation
