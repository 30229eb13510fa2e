#include "core/scene/material_library.h"

#include <algorithm>

#include "core/base/error.h"

namespace lumorph {
namespace {

SceneTexture picture(const std::string& name, float metres) {
    SceneTexture texture;
    texture.image = "resource:materials/" + name + ".png";
    texture.tile = glm::vec2(metres);
    return texture;
}

/// A material with the pictures `name`.png and `name`_normal.png.
Material pictured(const std::string& title, const std::string& name, float metres, float roughness) {
    Material material;
    material.name = title;
    material.color = glm::vec3(1.0F);
    material.colorTexture = picture(name, metres);
    material.normalMaps[0] = picture(name + "_normal", metres);
    material.roughness = roughness;
    return material;
}

/// Two layers of ripples that travel across each other over a clear depth.
Material water() {
    Material material;
    material.name = "Water";
    material.color = {0.11F, 0.50F, 0.65F};
    material.normalMaps[0] = picture("water_normal", 0.11F);
    material.normalMaps[0].velocity = {0.016F, 0.005F};
    material.normalMaps[1] = picture("water_normal", 0.064F);
    material.normalMaps[1].turn = Angle::degrees(65.0);
    material.normalMaps[1].velocity = {0.013F, -0.004F};
    material.normalStrength = 0.35F;
    material.roughness = 0.08F;
    material.reflection = 0.08F;
    material.refraction = 0.3F;
    return material;
}

Material ice() {
    Material material = pictured("Ice", "ice", 0.16F, 0.18F);
    material.reflection = 0.10F;
    material.refraction = 0.12F;
    material.refractiveIndex = 1.31F;
    return material;
}

Material metal() {
    Material material = pictured("Metal", "metal", 0.15F, 0.32F);
    material.metallic = 1.0F;
    material.reflection = 0.6F;
    return material;
}

/// The net of light on the floor of a pool: sixteen pictures of a loop.
Material caustics() {
    Material material;
    material.name = "Caustics";
    material.color = glm::vec3(1.0F);
    material.colorTexture = picture("caustics", 0.09F);
    material.colorTexture.columns = 4;
    material.colorTexture.rows = 4;
    material.colorTexture.framesPerSecond = 10.0;
    material.roughness = 0.6F;
    return material;
}

} // namespace

std::vector<Material> readyMaterials() {
    return {pictured("Paper", "paper", 0.10F, 0.95F),
            water(),
            pictured("Wood", "wood", 0.20F, 0.55F),
            pictured("Brick", "brick", 0.11F, 0.9F),
            pictured("Map", "map", 0.21F, 0.8F),
            ice(),
            pictured("Stone", "stone", 0.13F, 0.85F),
            metal(),
            caustics()};
}

Material readyMaterial(const std::string& name) {
    std::string names;
    for (Material& material : readyMaterials()) {
        if (material.name == name) return std::move(material);
        names += (names.empty() ? "" : ", ") + material.name;
    }
    throw InvalidInput("material \"" + name + "\"", "there is none of this name", "choose one of " + names);
}

} // namespace lumorph
