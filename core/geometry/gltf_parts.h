#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/gltf_accessors.h"

/// The parts a Model is made of, each read on its own. Private to core/geometry.
namespace lumorph::gltf {

/// One open file.
struct Source {
    const nlohmann::json& document;   ///< whole, for extras
    const tinygltf::Model& structure; ///< typed, everything else
    const Accessors& accessors;
    std::vector<std::string>& warnings; ///< plain sentences

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

/// What an extension says of an element of the file; null where it has none of this name.
[[nodiscard]] const nlohmann::json& extensionOf(const nlohmann::json& element, const char* name);

/// KHR_node_visibility: whether the node itself is hidden.
[[nodiscard]] bool isHidden(const Source& source, std::size_t node);

/// EXT_mesh_gpu_instancing: where the copies of a node's mesh stand in the node's frame; none where it is shown once.
[[nodiscard]] std::vector<Model::Node> instancesOf(const Source& source, std::size_t node);

/// KHR_animation_pointer: the target of a channel of the document as the specification without it writes it; nothing
/// where it moves something else than a node.
struct PointedNode {
    int node = -1;
    std::string path;
};
[[nodiscard]] std::optional<PointedNode> pointedNode(const nlohmann::json& channel);

/// The picture of a texture, also of one that only an extension names; -1 for none.
[[nodiscard]] int pictureOf(const Source& source, std::size_t texture, std::size_t images, const std::string& place);

/// Triangle meshes; primitives that are points or lines, or have no positions, are left out.
[[nodiscard]] std::vector<Model::Mesh> readMeshes(const Source& source);

/// Nodes with parents before children, default scene, skins and animations, into a model that has its meshes.
void readScene(const Source& source, Model& model);

} // namespace lumorph::gltf
