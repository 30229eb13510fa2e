#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <nlohmann/json.hpp>

#include "core/base/progress.h"
#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// A glTF document as plain data: the node tree, meshes with morph targets and skin weights, skins,
/// animations, materials, images and every `extras`. Indices are checked when it is read: an index
/// in a Model is either -1 ("none") or valid.
struct Model {
    /// A vertex attribute glTF does not know (its name starts with an underscore), as floats.
    struct CustomAttribute {
        int components = 1; ///< 1 to 4 floats a vertex
        std::vector<float> values;
        bool operator==(const CustomAttribute&) const = default;
    };
    struct Primitive {
        std::vector<glm::vec3> positions;
        std::vector<glm::vec3> normals;   ///< empty or one a vertex
        std::vector<glm::vec2> texcoords; ///< empty or one a vertex (TEXCOORD_0)
        std::vector<glm::u16vec4> joints; ///< empty or one a vertex (JOINTS_0)
        std::vector<glm::vec4> weights;   ///< empty or one a vertex (WEIGHTS_0), normalised
        std::map<std::string, CustomAttribute> custom;
        std::vector<std::vector<glm::vec3>> morphTargets; ///< position deltas, one vector a target
        std::vector<glm::uvec3> triangles;
        int material = -1;
        bool operator==(const Primitive&) const = default;
    };
    struct Mesh {
        std::string name;
        std::vector<Primitive> primitives;
        std::vector<std::string> targetNames; ///< from extras.targetNames; empty or one a morph target
        std::vector<float> weights;           ///< default morph weights
        nlohmann::json extras;
        bool operator==(const Mesh&) const = default;
    };
    struct Node {
        std::string name;
        int parent = -1;
        std::vector<int> children;
        glm::vec3 translation{0.0F};
        glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};
        glm::vec3 scale{1.0F};
        std::optional<glm::mat4> matrix; ///< replaces translation, rotation and scale where present
        int mesh = -1;
        int skin = -1;
        std::vector<float> weights; ///< overrides the mesh's where present
        nlohmann::json extras;
        bool operator==(const Node&) const = default;
    };
    struct Skin {
        std::string name;
        std::vector<int> joints;                    ///< nodes
        std::vector<glm::mat4> inverseBindMatrices; ///< one a joint
        bool operator==(const Skin&) const = default;
    };
    enum class Path { translation, rotation, scale, weights };
    enum class Interpolation { linear, step, cubicSpline };
    struct Channel {
        int node = -1;
        Path path = Path::translation;
        Interpolation interpolation = Interpolation::linear;
        std::vector<float> times;  ///< seconds, ascending
        std::vector<float> values; ///< glTF's layout: components x keys (x3 for cubic splines)
        bool operator==(const Channel&) const = default;
    };
    struct Animation {
        std::string name;
        std::vector<Channel> channels;
        [[nodiscard]] double duration() const noexcept; ///< seconds
        bool operator==(const Animation&) const = default;
    };
    /// A picture still in its file form (PNG or JPEG), not decoded.
    struct Image {
        std::string name;
        std::string mimeType;
        std::vector<std::byte> bytes;
        bool operator==(const Image&) const = default;
    };
    struct Material {
        std::string name;
        glm::vec4 baseColor{1.0F};
        glm::vec3 emissive{0.0F};
        float metallic = 1.0F;
        float roughness = 1.0F;
        float normalScale = 1.0F;
        float alphaCutoff = 0.5F;
        std::string alphaMode = "OPAQUE";
        bool doubleSided = false;
        int baseColorImage = -1;
        int metallicRoughnessImage = -1;
        int normalImage = -1;
        int emissiveImage = -1;
        nlohmann::json extras;
        bool operator==(const Material&) const = default;
    };

    std::string name;        ///< of the default scene, or of the file where the scene has none
    std::vector<Node> nodes; ///< a parent stands before its children
    std::vector<int> roots;  ///< of the default scene
    std::vector<Mesh> meshes;
    std::vector<Skin> skins;
    std::vector<Animation> animations;
    std::vector<Material> materials;
    std::vector<Image> images;
    nlohmann::json extras; ///< of the asset; of the default scene too, where the asset has no such key

    bool operator==(const Model&) const = default;
};

/// Reads `.gltf` or `.glb`. Buffers and images beside the file are read, but only inside its folder.
/// Of what glTF can hold, cameras, lights, further texture coordinates and joint sets, texture transforms, points and
/// lines are left out. Throws DataError naming the file, the place in it and the remedy.
[[nodiscard]] Model readModel(const std::filesystem::path& file);

/// Reads a GLB held in memory; nothing outside it is opened. `name` stands in errors.
[[nodiscard]] Model readGlb(std::span<const std::byte> bytes, const std::string& name);

/// The model as one binary glTF 2.0 file. Lossless for everything a Model holds. Throws InvalidInput where the model
/// contradicts itself: no nodes, an attribute whose length is not the number of vertices, an index out of range.
[[nodiscard]] std::vector<std::byte> writeGlb(const Model& model);

/// A model holding just this mesh on one node.
[[nodiscard]] Model modelOf(const TriangleMesh& mesh, const std::string& name);

/// `worldFromNode` for every node, at the rest pose or posed by `animation` at `seconds`
/// (held beyond its ends).
[[nodiscard]] std::vector<glm::mat4> nodeTransforms(const Model& model);
[[nodiscard]] std::vector<glm::mat4> nodeTransforms(const Model& model, const Model::Animation& animation,
                                                    double seconds);

/// All triangles of the default scene in world space with skins and morph targets applied, at the
/// rest pose or posed by `animation` at `seconds`. The triangles are the same at every time; where the rest pose
/// mirrors a mesh its triangles are turned, so that outside stays outside. Throws InvalidInput when a transform carries
/// a vertex beyond the range of float.
[[nodiscard]] TriangleMesh flatten(const Model& model);
[[nodiscard]] TriangleMesh flatten(const Model& model, const Model::Animation& animation, double seconds);

/// The box of the flattened model over `frames` + 1 times of an animation, k / framesPerSecond each. Throws
/// InvalidInput as `flatten` does, Cancelled.
[[nodiscard]] Box boxOverAnimation(const Model& model, const Model::Animation& animation, int frames,
                                   double framesPerSecond, const Progress& progress = {});

} // namespace lumorph
