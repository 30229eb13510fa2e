#pragma once

#include "core/geometry/model.h"

namespace lumorph::support {

/// A small model with everything a Model can hold: two joints bending a quad with a morph target, an animation of every
/// path and interpolation, two materials that share a picture, custom attributes and extras everywhere.
inline Model fullModel() {
    Model model;
    model.name = "stage";
    model.extras = {{"units", "m"}, {"big", 9007199254740993LL}, {"list", {1, nullptr, "two"}}};

    Model::Primitive quad;
    quad.positions = {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0.1F}};
    quad.normals.assign(4, {0, 0, 1});
    quad.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    quad.joints = {{0, 0, 0, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}, {1, 0, 0, 0}};
    quad.weights = {{1, 0, 0, 0}, {0.75F, 0.25F, 0, 0}, {1, 0, 0, 0}, {1, 0, 0, 0}};
    quad.custom["_ACTUATORS"] = {2, {0, 1, 2, 3, 4, 5, 6, 7.5F}};
    quad.custom["_TENSION"] = {1, {0.1F, 0.2F, 0.3F, 0.4F}};
    quad.morphTargets = {{{0, 0, 1}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0.5F}}, {{1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}}};
    quad.triangles = {{0, 1, 2}, {0, 2, 3}};
    quad.material = 1;
    model.meshes.push_back({"skin of it", {quad}, {"bulge", "shift"}, {0.25F, 0.0F}, {{"rig", {{"levels", 3}}}}});
    Model::Primitive plain;
    plain.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    plain.triangles = {{0, 1, 2}};
    model.meshes.push_back({"plain", {plain}, {}, {}, nullptr});
    model.meshes.push_back({"nothing", {}, {}, {}, nullptr});

    model.nodes.resize(5);
    model.nodes[0].name = "root";
    model.nodes[0].children = {1, 3, 4};
    model.nodes[0].extras = {{"tag", "root"}};
    model.nodes[0].matrix = glm::mat4(1.0F);
    (*model.nodes[0].matrix)[3] = glm::vec4(0.5F, -0.25F, 1.0F / 3.0F, 1.0F);
    model.nodes[1].parent = 0;
    model.nodes[1].name = "lower joint";
    model.nodes[1].children = {2};
    model.nodes[1].rotation = glm::quat(0.8F, 0.0F, 0.6F, 0.0F);
    model.nodes[2].parent = 1;
    model.nodes[2].name = "upper joint";
    model.nodes[2].translation = {0, 1, 0};
    model.nodes[2].scale = {1, 2, 0.1F};
    model.nodes[3].parent = 0;
    model.nodes[3].mesh = 0;
    model.nodes[3].skin = 0;
    model.nodes[3].weights = {0.5F, 0.125F};
    model.nodes[4].parent = 0;
    model.nodes[4].mesh = 1;
    model.roots = {0};

    glm::mat4 fromUpper(1.0F);
    fromUpper[3] = glm::vec4(0, -1, 0, 1);
    model.skins.push_back({"bones", {1, 2}, {glm::mat4(1.0F), fromUpper}});

    using Path = Model::Path;
    using Interpolation = Model::Interpolation;
    model.animations.push_back({"wave",
                                {{1, Path::rotation, Interpolation::linear, {0, 1}, {0, 0, 0, 1, 0, 0.6F, 0, 0.8F}},
                                 {2,
                                  Path::translation,
                                  Interpolation::cubicSpline,
                                  {0.5F, 2},
                                  {0, 0, 0, 1, 2, 3, 0, 1, 0, 1, 0, 0, 4, 5, 6, 0, 0, 0}},
                                 {2, Path::scale, Interpolation::step, {0, 0.1F}, {1, 1, 1, 2, 2, 2}},
                                 {3, Path::weights, Interpolation::linear, {0, 3}, {0, 1, 1, 0}}}});
    model.animations.push_back({"still", {}});

    model.materials.resize(2);
    model.materials[0].name = "gold";
    model.materials[0].emissive = {0.1F, 0.2F, 0.3F};
    model.materials[0].metallic = 0.9F;
    model.materials[0].roughness = 0.05F;
    model.materials[0].emissiveImage = 1;
    model.materials[0].metallicRoughnessImage = 0;
    model.materials[1].baseColor = {0.5F, 0.25F, 0.125F, 0.7F};
    model.materials[1].normalScale = 0.7F;
    model.materials[1].alphaCutoff = 0.3F;
    model.materials[1].alphaMode = "MASK";
    model.materials[1].doubleSided = true;
    model.materials[1].baseColorImage = 0;
    model.materials[1].normalImage = 1;
    model.materials[1].extras = {{"paint", true}};

    const auto bytes = [](std::initializer_list<int> values) {
        std::vector<std::byte> out;
        for (const int value : values) out.push_back(static_cast<std::byte>(value));
        return out;
    };
    model.images = {{"wood", "image/png", bytes({0x89, 'P', 'N', 'G', 1, 2, 3})},
                    {"", "image/jpeg", bytes({0xFF, 0xD8, 0xFF})}};
    return model;
}

} // namespace lumorph::support
