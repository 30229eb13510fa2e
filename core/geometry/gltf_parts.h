#pragma once

#include "core/geometry/gltf_accessors.h"

/// The parts a Model is made of, each read on its own. Private to core/geometry.
namespace lumorph::gltf {

/// One open file.
struct Source {
    const nlohmann::json& document;   ///< whole, for extras
    const tinygltf::Model& structure; ///< typed, everything else
    const Accessors& accessors;

    [[noreturn]] void refuse(const std::string& why, const std::string& remedy = kExportAgain) const {
        gltf::refuse(accessors.file(), why, remedy);
    }
    /// `index` when it is -1 (none) or below `size`; refused otherwise.
    [[nodiscard]] int checked(int index, std::size_t size, const std::string& place, const char* what) const;
    /// A finite float.
    [[nodiscard]] float number(double value, const std::string& place) const;
    [[nodiscard]] std::vector<float> numbers(const std::vector<double>& values, const std::string& place) const;
    /// Extras of one element of a top-level list; null where it has none.
    [[nodiscard]] nlohmann::json extras(const char* list, std::size_t index) const;
};

/// Triangle meshes; primitives that are points or lines, or have no positions, are left out.
[[nodiscard]] std::vector<Model::Mesh> readMeshes(const Source& source);

/// Nodes with parents before children, default scene, skins and animations, into a model that has its meshes.
void readScene(const Source& source, Model& model);

} // namespace lumorph::gltf
