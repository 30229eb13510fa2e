#include "core/geometry/gltf_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/geometry/mesh_file.h"

namespace lumorph::gltf {

using nlohmann::json;

namespace {

constexpr std::uint32_t kMaxJointIndex = 0xFFFF;

bool isTriangles(int mode) {
    return mode == TINYGLTF_MODE_TRIANGLES || mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
           mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

/// Triangle `i` of `corners` read in `mode`, in the order of the specification.
glm::uvec3 triangleOf(const std::vector<std::uint32_t>& corners, int mode, std::size_t i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return {corners[i + 1], corners[i + 2], corners[0]};
    if (mode == TINYGLTF_MODE_TRIANGLES) return {corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]};
    return {corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]};
}

class PrimitiveReader {
public:
    /// `crowded`: its vertices stand among those of others, so that only its own are taken.
    PrimitiveReader(const Source& source, const tinygltf::Primitive& primitive, std::string place, bool crowded)
        : source_(source), accessors_(source.accessors), primitive_(primitive), place_(std::move(place)),
          crowded_(crowded) {}

    Model::Primitive read() {
        stored_ = accessors_.count(attribute("POSITION"), place_ + " POSITION");
        std::vector<std::uint32_t> corner = corners();
        checkCorners(corner);
        if (crowded_ && primitive_.indices >= 0) takeOwnVertices(corner);
        out_.positions = accessors_.vectors<glm::vec3>(attribute("POSITION"), place_ + " POSITION", own_);
        makeTriangles(corner);
        if (has("NORMAL")) out_.normals = perVertex<glm::vec3>("NORMAL");
        if (has("TEXCOORD_0")) out_.texcoords = perVertex<glm::vec2>("TEXCOORD_0");
        readSkinWeights();
        readCustom();
        readMorphTargets();
        out_.material = source_.checked(primitive_.material, source_.structure.materials.size(), place_, "material");
        return std::move(out_);
    }

private:
    bool has(const std::string& name) const { return primitive_.attributes.contains(name); }
    int attribute(const std::string& name) const { return primitive_.attributes.at(name); }
    std::size_t vertices() const { return out_.positions.size(); }

    void checkCount(int accessor, const std::string& place) const {
        const std::size_t count = accessors_.count(accessor, place);
        if (count != stored_)
            source_.refuse(place + ": is for " + std::to_string(count) + " vertices, not " + std::to_string(stored_));
    }

    template <typename Vector> std::vector<Vector> perVertex(const std::string& name) const {
        checkCount(attribute(name), place_ + " " + name);
        return accessors_.vectors<Vector>(attribute(name), place_ + " " + name, own_);
    }

    std::vector<std::uint32_t> corners() const {
        if (primitive_.indices >= 0) return accessors_.integers(primitive_.indices, 1, place_ + " indices");
        accessors_.budget().charge(stored_, sizeof(std::uint32_t), place_);
        std::vector<std::uint32_t> all(stored_);
        std::iota(all.begin(), all.end(), 0U);
        return all;
    }

    void checkCorners(const std::vector<std::uint32_t>& corner) const {
        const auto bad = std::find_if(corner.begin(), corner.end(), [&](std::uint32_t i) { return i >= stored_; });
        if (bad != corner.end())
            source_.refuse(place_ + " indices: index " + std::to_string(*bad) + " at " +
                           std::to_string(bad - corner.begin()) + " is out of range, there are " +
                           std::to_string(stored_) + " vertices");
    }

    void takeOwnVertices(std::vector<std::uint32_t>& corner) {
        accessors_.budget().charge(corner.size(), sizeof(std::uint32_t), place_);
        own_ = corner;
        std::ranges::sort(own_);
        own_.erase(std::unique(own_.begin(), own_.end()), own_.end());
        if (own_.size() == stored_) return own_.clear();
        for (std::uint32_t& c : corner)
            c = static_cast<std::uint32_t>(std::ranges::lower_bound(own_, c) - own_.begin());
    }

    void makeTriangles(const std::vector<std::uint32_t>& corner) {
        const bool list = primitive_.mode == TINYGLTF_MODE_TRIANGLES;
        if (list && corner.size() % 3 != 0)
            source_.refuse(place_ + ": " + std::to_string(corner.size()) + " corners are not whole triangles");
        const std::size_t count = list ? corner.size() / 3 : std::max(corner.size(), std::size_t{2}) - 2;
        accessors_.budget().charge(count, sizeof(glm::uvec3), place_);
        out_.triangles.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            const glm::uvec3 t = triangleOf(corner, primitive_.mode, i);
            // Strips are stitched together with triangles that have no area.
            const bool stitch = !list && (t.x == t.y || t.y == t.z || t.z == t.x);
            if (!stitch) out_.triangles.push_back(t);
        }
    }

    void readSkinWeights() {
        if (!has("JOINTS_0") && !has("WEIGHTS_0")) return;
        if (!has("JOINTS_0") || !has("WEIGHTS_0")) source_.refuse(place_ + ": has joints or weights, but not both");
        out_.weights = perVertex<glm::vec4>("WEIGHTS_0");
        checkCount(attribute("JOINTS_0"), place_ + " JOINTS_0");
        const auto joints = accessors_.integers(attribute("JOINTS_0"), 4, place_ + " JOINTS_0", own_);
        out_.joints.resize(vertices());
        for (std::size_t i = 0; i < vertices(); ++i) {
            normalise(out_.weights[i]);
            for (int c = 0; c < 4; ++c) {
                const std::uint32_t joint = joints[4 * i + static_cast<std::size_t>(c)];
                // Exporters leave any number where the weight is nothing.
                const bool used = out_.weights[i][c] > 0.0F;
                if (used && joint > kMaxJointIndex) source_.refuse(place_ + " JOINTS_0: joint out of range");
                out_.joints[i][c] = used ? static_cast<std::uint16_t>(joint) : std::uint16_t{0};
            }
        }
    }

    void normalise(glm::vec4& weights) const {
        double sum = 0.0;
        for (int c = 0; c < 4; ++c) {
            if (weights[c] < 0.0F) source_.refuse(place_ + " WEIGHTS_0: a weight is negative");
            sum += static_cast<double>(weights[c]);
        }
        // A vertex without weights follows the first joint, as it does elsewhere.
        if (sum <= 0.0) weights = glm::vec4(1.0F, 0.0F, 0.0F, 0.0F);
        // What is normalised already must not change, or writing and reading would not give the same model.
        else if (std::abs(sum - 1.0) > 1e-5)
            for (int c = 0; c < 4; ++c) weights[c] = static_cast<float>(static_cast<double>(weights[c]) / sum);
    }

    void readCustom() {
        for (const auto& [name, accessor] : primitive_.attributes) {
            if (!name.starts_with('_')) continue;
            const std::string place = place_ + " " + name;
            Model::CustomAttribute custom;
            custom.components = accessors_.components(accessor, place);
            if (custom.components > 4)
                source_.refuse(place + ": matrices are not supported as attributes", "store it as vectors");
            checkCount(accessor, place);
            custom.values = accessors_.floats(accessor, custom.components, place, own_);
            out_.custom.emplace(name, std::move(custom));
        }
    }

    void readMorphTargets() {
        for (std::size_t i = 0; i < primitive_.targets.size(); ++i) {
            const std::string place = place_ + " morph target " + std::to_string(i);
            const auto position = primitive_.targets[i].find("POSITION");
            if (position == primitive_.targets[i].end()) {
                accessors_.budget().charge(vertices(), sizeof(glm::vec3), place);
                out_.morphTargets.emplace_back(vertices(), glm::vec3(0.0F));
                continue;
            }
            checkCount(position->second, place);
            out_.morphTargets.push_back(accessors_.vectors<glm::vec3>(position->second, place, own_));
        }
    }

    const Source& source_;
    const Accessors& accessors_;
    const tinygltf::Primitive& primitive_;
    std::string place_;
    bool crowded_;
    std::size_t stored_ = 0;         ///< vertices that its accessor holds
    std::vector<std::uint32_t> own_; ///< the vertices that it takes, ascending; none: all
    Model::Primitive out_;
};

bool isRead(const tinygltf::Primitive& primitive) {
    return isTriangles(primitive.mode) && primitive.attributes.contains("POSITION");
}

/// Buffer views of which primitives ask for more positions than they hold: several meshes lie in one list of vertices.
/// If each took the whole list, a small file would ask for the memory of many.
class CrowdedViews {
public:
    explicit CrowdedViews(const tinygltf::Model& structure)
        : structure_(structure), asked_(structure.bufferViews.size()) {
        for (const tinygltf::Mesh& mesh : structure.meshes)
            for (const tinygltf::Primitive& primitive : mesh.primitives)
                if (const std::optional<std::size_t> view = viewOf(primitive)) {
                    asked_[*view].bytes += bytesOf(primitive, *view);
                    ++asked_[*view].primitives;
                }
    }
    [[nodiscard]] bool hold(const tinygltf::Primitive& primitive) const {
        const std::optional<std::size_t> view = viewOf(primitive);
        return view && asked_[*view].primitives > 1 &&
               asked_[*view].bytes > static_cast<double>(structure_.bufferViews[*view].byteLength);
    }

private:
    struct Asked {
        double bytes = 0.0;
        std::size_t primitives = 0;
    };
    [[nodiscard]] const tinygltf::Accessor* positionsOf(const tinygltf::Primitive& primitive) const {
        if (!isRead(primitive)) return nullptr;
        const int accessor = primitive.attributes.at("POSITION");
        const bool there = accessor >= 0 && static_cast<std::size_t>(accessor) < structure_.accessors.size();
        return there ? &structure_.accessors[static_cast<std::size_t>(accessor)] : nullptr;
    }
    [[nodiscard]] std::optional<std::size_t> viewOf(const tinygltf::Primitive& primitive) const {
        const tinygltf::Accessor* const positions = positionsOf(primitive);
        if (positions == nullptr || positions->bufferView < 0) return std::nullopt;
        const auto view = static_cast<std::size_t>(positions->bufferView);
        return view < asked_.size() ? std::optional(view) : std::nullopt;
    }
    [[nodiscard]] double bytesOf(const tinygltf::Primitive& primitive, std::size_t view) const {
        const tinygltf::Accessor& positions = *positionsOf(primitive);
        const double each =
            3.0 * std::max(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(positions.componentType)), 1);
        const double stride = std::max(static_cast<double>(structure_.bufferViews[view].byteStride), each);
        return positions.count == 0 ? 0.0 : static_cast<double>(positions.count - 1) * stride + each;
    }

    const tinygltf::Model& structure_;
    std::vector<Asked> asked_; ///< of each buffer view
};

/// A mesh that is stored compressed only would be read as if all its vertices were at the origin.
void checkUncompressed(const Source& source, std::size_t mesh, std::size_t index, const std::string& place) {
    const json& primitive = source.document["meshes"][mesh]["primitives"][index];
    constexpr const char* kDraco = "KHR_draco_mesh_compression";
    if (extensionOf(primitive, kDraco).is_null()) return;
    const int accessor = source.structure.meshes[mesh].primitives[index].attributes.at("POSITION");
    if (accessor < 0 || static_cast<std::size_t>(accessor) >= source.structure.accessors.size()) return;
    const tinygltf::Accessor& positions = source.structure.accessors[static_cast<std::size_t>(accessor)];
    if (positions.bufferView < 0 && !positions.sparse.isSparse)
        source.refuse(place + ": is compressed (" + kDraco + ") and holds no other copy",
                      "export the model without compression");
}

/// Takes `targetNames` out of the extras when they name every morph target, as exporters agree to write them.
std::vector<std::string> takeTargetNames(json& extras, std::size_t targets) {
    const auto found = extras.is_object() ? extras.find("targetNames") : extras.end();
    if (found == extras.end() || !found->is_array() || found->size() != targets || targets == 0) return {};
    const bool strings = std::all_of(found->begin(), found->end(), [](const json& name) { return name.is_string(); });
    if (!strings) return {};
    auto names = found->get<std::vector<std::string>>();
    extras.erase(found);
    if (extras.empty()) extras = nullptr;
    return names;
}

Model::Mesh readMesh(const Source& source, std::size_t index, const CrowdedViews& crowded) {
    const tinygltf::Mesh& from = source.structure.meshes[index];
    const std::string place = "mesh " + std::to_string(index);
    Model::Mesh mesh;
    mesh.name = from.name;
    for (std::size_t i = 0; i < from.primitives.size(); ++i) {
        const tinygltf::Primitive& primitive = from.primitives[i];
        if (!isRead(primitive)) continue;
        const std::string placed = place + " primitive " + std::to_string(i);
        checkUncompressed(source, index, i, placed);
        PrimitiveReader reader(source, primitive, placed, crowded.hold(primitive));
        Model::Primitive read = reader.read();
        if (!read.triangles.empty()) mesh.primitives.push_back(std::move(read));
    }
    const std::size_t targets = mesh.primitives.empty() ? 0 : mesh.primitives.front().morphTargets.size();
    for (const Model::Primitive& primitive : mesh.primitives)
        if (primitive.morphTargets.size() != targets) source.refuse(place + ": its primitives differ in morph targets");
    mesh.weights = source.numbers(from.weights, place + " weights");
    if (mesh.primitives.empty()) mesh.weights.clear();
    if (!mesh.weights.empty() && mesh.weights.size() != targets)
        source.refuse(place + ": has " + std::to_string(mesh.weights.size()) + " weights for " +
                      std::to_string(targets) + " morph targets");
    mesh.extras = source.extras("meshes", index);
    mesh.targetNames = takeTargetNames(mesh.extras, targets);
    return mesh;
}

} // namespace

std::vector<Model::Mesh> readMeshes(const Source& source) {
    std::vector<Model::Mesh> meshes;
    const CrowdedViews crowded(source.structure);
    std::size_t triangles = 0;
    for (std::size_t i = 0; i < source.structure.meshes.size(); ++i) {
        meshes.push_back(readMesh(source, i, crowded));
        for (const Model::Primitive& primitive : meshes.back().primitives) triangles += primitive.triangles.size();
        if (triangles > kMaxTriangles)
            source.refuse("has more than " + std::to_string(kMaxTriangles) + " triangles",
                          "reduce the mesh and export it again");
    }
    return meshes;
}

} // namespace lumorph::gltf
