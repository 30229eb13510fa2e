#include "app/applications/water/harbour.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "app/applications/water/sea_pictures.h"

namespace lumorph::sea {
namespace {

using Part = Model::Primitive;

constexpr int kAround = 20, kGlowAround = 56;
constexpr float kGlowOver = 0.0008F; ///< metres over the water

/// A flat face with corners counter-clockwise from outside.
void addFlat(Part& part, std::span<const glm::vec3> corners) {
    const auto first = static_cast<std::uint32_t>(part.positions.size());
    const glm::vec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    for (const glm::vec3& corner : corners) {
        part.positions.push_back(corner);
        part.normals.push_back(normal);
        part.texcoords.emplace_back(corner.x, corner.z);
    }
    for (std::uint32_t k = 1; k + 1 < corners.size(); ++k) part.triangles.emplace_back(first, first + k, first + k + 1);
}

/// A profile of radius and height, from below, turned about the vertical.
void addTurnedProfile(Part& part, std::span<const glm::vec2> profile) {
    for (std::size_t k = 0; k + 1 < profile.size(); ++k)
        for (int n = 0; n < kAround; ++n) {
            const auto at = [&](const glm::vec2& p, int turn) {
                const float angle = 2.0F * std::numbers::pi_v<float> * static_cast<float>(turn) / kAround;
                return glm::vec3(p.x * std::cos(angle), p.y, -p.x * std::sin(angle));
            };
            const std::array corners{at(profile[k], n), at(profile[k], n + 1), at(profile[k + 1], n + 1),
                                     at(profile[k + 1], n)};
            // Where a profile meets the axis there are triangles.
            if (profile[k].x > 1e-7F) addFlat(part, std::array{corners[0], corners[1], corners[2]});
            if (profile[k + 1].x > 1e-7F) addFlat(part, std::array{corners[0], corners[2], corners[3]});
        }
}

Material painted(const std::string& name, const glm::vec3& color, float roughness = 0.45F) {
    Material material;
    material.name = name;
    material.color = color;
    material.roughness = roughness;
    return material;
}

SceneModel modelWith(std::vector<Part> parts, std::vector<Material> materials) {
    for (std::size_t k = 0; k < parts.size(); ++k) parts[k].material = static_cast<int>(k);
    SceneModel made = seaModel(std::move(parts));
    made.materials = std::move(materials);
    return made;
}

void addHull(Part& hull, Part& deck) {
    const glm::vec3 bow(0.0165F, 0.0058F, 0.0F), keelBow(0.0105F, -0.0040F, 0.0F), keelStern(-0.0120F, -0.0040F, 0.0F);
    const glm::vec3 left(-0.0140F, 0.0048F, -0.0046F), right(-0.0140F, 0.0048F, 0.0046F);
    for (const float side : {-1.0F, 1.0F}) {
        const glm::vec3 middle(0.0020F, 0.0042F, 0.0064F * side), stern = side < 0.0F ? left : right;
        const auto add = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
            side > 0.0F ? addFlat(hull, std::array{a, b, c}) : addFlat(hull, std::array{a, c, b});
        };
        add(keelBow, bow, middle);
        add(keelBow, middle, keelStern);
        add(keelStern, middle, stern);
    }
    addFlat(hull, std::array{keelStern, right, left});
    addFlat(deck,
            std::array{left, right, glm::vec3(0.0020F, 0.0042F, 0.0064F), bow, glm::vec3(0.0020F, 0.0042F, -0.0064F)});
}

SceneModel boat() {
    std::vector<Part> parts(3); // hull, deck and mast, sails
    addHull(parts[0], parts[1]);
    addTurnedProfile(parts[1], std::array{glm::vec2(0.0006F, 0.0036F), glm::vec2(0.0005F, 0.031F)});
    addFlat(parts[2], std::array<glm::vec3, 3>{
                          {{0.0002F, 0.0072F, 0.0F}, {0.0002F, 0.0305F, 0.0F}, {-0.0140F, 0.0080F, 0.0034F}}});
    addFlat(parts[2], std::array<glm::vec3, 3>{
                          {{0.0012F, 0.0280F, 0.0F}, {0.0012F, 0.0072F, 0.0F}, {0.0155F, 0.0066F, 0.0016F}}});
    Material sail = painted("Sail", {0.98F, 0.96F, 0.90F}, 0.9F);
    sail.emission = {0.95F, 0.93F, 0.85F}; // light comes through the cloth
    sail.emissionStrength = 0.50F;
    return modelWith(std::move(parts), {painted("Hull", {0.80F, 0.16F, 0.12F}, 0.3F),
                                        painted("Deck", {0.78F, 0.58F, 0.36F}, 0.6F), sail});
}

SceneModel beacon() {
    std::vector<Part> parts(2); // white and red
    addTurnedProfile(parts[1], std::array{glm::vec2(0.0070F, -0.006F), glm::vec2(0.0074F, 0.0030F),
                                          glm::vec2(0.0060F, 0.0046F), glm::vec2(0.0F, 0.0046F)});
    addTurnedProfile(parts[0], std::array{glm::vec2(0.0040F, 0.0046F), glm::vec2(0.0035F, 0.0100F)});
    addTurnedProfile(parts[1], std::array{glm::vec2(0.0035F, 0.0100F), glm::vec2(0.0030F, 0.0155F)});
    addTurnedProfile(parts[0], std::array{glm::vec2(0.0030F, 0.0155F), glm::vec2(0.0026F, 0.0205F),
                                          glm::vec2(0.0042F, 0.0212F), glm::vec2(0.0F, 0.0212F)});
    return modelWith(std::move(parts),
                     {painted("White", {0.95F, 0.95F, 0.93F}), painted("Red", {0.80F, 0.12F, 0.10F})});
}

SceneModel lamp() {
    std::vector<Part> parts(1);
    std::vector<glm::vec2> profile;
    for (int k = 0; k <= 10; ++k) {
        const float angle = std::numbers::pi_v<float> * (static_cast<float>(k) / 10.0F - 0.5F);
        profile.emplace_back(k == 0 || k == 10 ? 0.0F : std::cos(angle), std::sin(angle));
    }
    addTurnedProfile(parts[0], profile);
    return modelWith(std::move(parts), {painted("Lamp", glm::vec3(1.0F))});
}

} // namespace

bool Harbour::advance(double seconds, const glm::dvec2& boat) noexcept {
    age_ += seconds;
    if (reached_ && age_ > kShines) {
        reached_ = false;
        age_ = 0.0;
        ++number_;
    }
    if (reached_ || age_ < kRises || glm::distance(boat, place()) > kReach) return false;
    reached_ = true;
    age_ = 0.0;
    ++visits_;
    return true;
}

double Harbour::shone() const noexcept { return reached_ ? std::clamp(age_ / kShines, 0.0, 1.0) : 0.0; }

double Harbour::up() const noexcept {
    const double share = std::clamp((reached_ ? kShines - age_ : age_) / kRises, 0.0, 1.0);
    return share * share * (3.0 - 2.0 * share);
}

void addHarbourModels(SceneAssets& assets) {
    assets.models[kBoatModel] = std::make_shared<const SceneModel>(boat());
    assets.models[kBeaconModel] = std::make_shared<const SceneModel>(beacon());
    assets.models[kLampModel] = std::make_shared<const SceneModel>(lamp());
}

std::shared_ptr<const SceneModel> glowModel(const glm::dvec2& place, double radius, double wide,
                                            const std::function<double(const glm::dvec2&)>& height) {
    Part strip;
    strip.material = 0;
    for (int n = 0; n <= kGlowAround; ++n) {
        const double turn = 2.0 * std::numbers::pi * n / kGlowAround;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec2 at = place + (radius + 0.5 * wide * (k - 1)) * glm::dvec2(std::cos(turn), std::sin(turn));
            strip.positions.emplace_back(at.x, static_cast<float>(height(at)) + kGlowOver, at.y);
            strip.normals.emplace_back(0.0F, 1.0F, 0.0F);
            strip.texcoords.emplace_back(0.5F, 0.02F + 0.48F * static_cast<float>(k));
        }
        if (n == kGlowAround) break;
        const auto first = static_cast<std::uint32_t>(3 * n);
        for (const std::uint32_t k : {0U, 1U}) {
            strip.triangles.emplace_back(first + k, first + k + 3, first + k + 4);
            strip.triangles.emplace_back(first + k, first + k + 4, first + k + 1);
        }
    }
    SceneModel made = seaModel({std::move(strip)});
    made.materials = {glowMaterial()};
    return std::make_shared<const SceneModel>(std::move(made));
}

} // namespace lumorph::sea
