#include "app/applications/ambient/coming.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>

#include "app/applications/ambient/forms.h"
#include "app/applications/ambient/parts.h"
#include "app/applications/demo_items.h"
#include "core/base/resources.h"

namespace lumorph::ambient {
namespace {

constexpr const char* kCardModel = "ambient card";
constexpr double kCardHeight = Coming::kCardWidth * kCardPixels.y / kCardPixels.x;
/// Middles of the cards that are due now and at the end, metres: where the sea is free of land, and so far from the far
/// rim that a viewer in front sees them on the device.
constexpr glm::dvec3 kRowFrom{0.0100, 0.0450, -0.0400}, kRowTo{0.0940, 0.0450, -0.0400};
constexpr double kShown = 12.0;             ///< hours ahead
constexpr double kComes = 1.5, kGoes = 1.2; ///< hours in which a card comes and goes

std::string cardPicture(int slot) { return "ambient card " + std::to_string(slot); }

std::shared_ptr<const SceneModel> sheet() {
    const auto x = static_cast<float>(0.5 * Coming::kCardWidth), y = static_cast<float>(0.5 * kCardHeight);
    Primitive face;
    face.positions = {{-x, -y, 0.0F}, {x, -y, 0.0F}, {x, y, 0.0F}, {-x, y, 0.0F}};
    face.normals.assign(4, {0.0F, 0.0F, 1.0F});
    face.texcoords = {{0.0F, 1.0F}, {1.0F, 1.0F}, {1.0F, 0.0F}, {0.0F, 0.0F}};
    face.triangles = {{0, 1, 2}, {0, 2, 3}};
    return modelOf("card", {face});
}

/// Upright, its picture towards an eye.
glm::quat facing(const glm::dvec3& from, const glm::dvec3& eye) {
    const glm::dvec3 way = eye - from;
    const glm::dvec3 z = glm::length(way) > 1e-9 ? glm::normalize(way) : glm::dvec3(0.0, 0.0, 1.0);
    const glm::dvec3 beside = glm::cross(glm::dvec3(0.0, 1.0, 0.0), z);
    const glm::dvec3 x = glm::length(beside) > 1e-6 ? glm::normalize(beside) : glm::dvec3(1.0, 0.0, 0.0);
    return glm::quat(glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z))));
}

} // namespace

ForecastCard cardOf(const View& view, const View::Card& card) noexcept {
    const double utc = view.utc + 3600.0 * card.ahead;
    const double local = utc + offsetAt(view.place, utc);
    const auto hours = static_cast<long long>(std::lround(local / 3600.0));
    return {signOf(card.weather, card.day), static_cast<int>(((hours % 24) + 24) % 24),
            static_cast<int>(std::lround(card.weather.temperature))};
}

Coming::Coming() : font_(resourceFile("fonts/Inter-SemiBold.otf")) {}

void Coming::addTo(Scene& scene, SceneAssets& assets) {
    assets.models.emplace(kCardModel, sheet());
    for (int slot = 0; slot < kCards; ++slot) {
        SceneItem card =
            demoItem(kFirstCard + slot, "Hours to come", MeshItem{.model = kCardModel, .ownMaterials = false});
        card.material = plain("Card", glm::vec3(1.0F));
        card.material.colorTexture.image = cardPicture(slot);
        card.material.colorTexture.tile = glm::vec2(1.0F);
        card.material.alpha = Material::Alpha::blend;
        card.material.unlit = true;
        card.visible = false;
        scene.items.push_back(std::move(card));
    }
}

bool Coming::update(const View& view) {
    bool changed = false;
    for (const View::Card& card : view.cards) {
        Painted& painted = painted_[static_cast<std::size_t>(card.slot)];
        const ForecastCard says = cardOf(view, card);
        if (painted.says == says) continue;
        painted.says = says;
        painted.picture = std::make_shared<const Image>(pictureOf(says, font_));
        changed = true;
    }
    return changed;
}

void Coming::pictures(SceneAssets& assets) const {
    for (int slot = 0; slot < kCards; ++slot)
        if (const auto& picture = painted_[static_cast<std::size_t>(slot)].picture)
            assets.images[cardPicture(slot)] = picture;
}

void Coming::show(Scene& scene, const View& view) const {
    for (const View::Card& card : view.cards) {
        SceneItem& item = itemOf(scene, kFirstCard + card.slot);
        const glm::dvec3 place = glm::mix(kRowFrom, kRowTo, card.ahead / kShown);
        const double seen = rise(0.0, kGoes, card.ahead) * (1.0 - rise(kShown, kShown + kComes, card.ahead));
        item.visible = seen > 0.01;
        item.position = place;
        item.rotation = facing(place, view.eye);
        item.opacity = static_cast<float>(seen);
    }
}

} // namespace lumorph::ambient
