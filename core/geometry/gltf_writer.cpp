#include <algorithm>
#include <cstring>
#include <limits>
#include <map>

#include <glm/gtc/type_ptr.hpp>

#include "core/base/error.h"
#include "core/geometry/model.h"

namespace lumorph {

using nlohmann::json;

namespace {

constexpr int kFloat = 5126;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kVertexData = 34962;
constexpr int kIndexData = 34963;

json listOf(const float* values, std::size_t count) {
    json list = json::array();
    for (std::size_t i = 0; i < count; ++i) list.push_back(values[i]);
    return list;
}

template <typename Vector> json listOf(const Vector& vector) {
    return listOf(glm::value_ptr(vector), sizeof(Vector) / sizeof(float));
}

const char* typeName(int components) {
    switch (components) {
    case 1:
        return "SCALAR";
    case 2:
        return "VEC2";
    case 3:
        return "VEC3";
    case 4:
        return "VEC4";
    default:
        return "MAT4";
    }
}

void setName(json& object, const std::string& name) {
    if (!name.empty()) object["name"] = name;
}

void setExtras(json& object, const json& extras) {
    if (!extras.is_null()) object["extras"] = extras;
}

class GlbWriter {
public:
    explicit GlbWriter(const Model& model) : model_(model) {}

    std::vector<std::byte> write() {
        if (model_.roots.empty()) refuse("has no nodes to show", "add an object to the scene before saving it");
        document_["asset"] = {{"version", "2.0"}, {"generator", "Lumorph"}};
        setExtras(document_["asset"], model_.extras);
        document_["scene"] = 0;
        document_["scenes"] = json::array({{{"nodes", model_.roots}}});
        setName(document_["scenes"][0], model_.name);
        for (std::size_t i = 0; i < model_.nodes.size(); ++i) document_["nodes"].push_back(node(i));
        for (std::size_t i = 0; i < model_.meshes.size(); ++i) document_["meshes"].push_back(mesh(i));
        for (std::size_t i = 0; i < model_.skins.size(); ++i) document_["skins"].push_back(skin(i));
        for (std::size_t i = 0; i < model_.animations.size(); ++i) writeAnimation(i);
        for (const Model::Material& from : model_.materials) document_["materials"].push_back(material(from));
        for (const Model::Image& from : model_.images) writeImage(from);
        if (!binary_.empty()) document_["buffers"] = json::array({{{"byteLength", binary_.size()}}});
        return packed();
    }

private:
    [[noreturn]] void refuse(const std::string& why,
                             const std::string& remedy = "mend the model before saving it") const {
        throw InvalidInput(model_.name.empty() ? "model" : model_.name, why, remedy);
    }

    void check(bool holds, const std::string& place, const char* why) const {
        if (!holds) refuse(place + ": " + why);
    }

    void checkIndex(int index, std::size_t size, const std::string& place, const char* what) const {
        if (index < -1 || (index >= 0 && static_cast<std::size_t>(index) >= size))
            refuse(place + ": there is no " + what + " " + std::to_string(index));
    }

    int addView(const void* data, std::size_t bytes, int target = 0) {
        json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes}};
        if (target != 0) view["target"] = target;
        const auto* first = static_cast<const std::byte*>(data);
        binary_.insert(binary_.end(), first, first + bytes);
        binary_.resize((binary_.size() + 3) / 4 * 4);
        json& views = document_["bufferViews"];
        views.push_back(std::move(view));
        return static_cast<int>(views.size()) - 1;
    }

    int addAccessor(const void* data, std::size_t bytes, std::size_t count, int componentType, int components,
                    int target = 0) {
        json& accessors = document_["accessors"];
        accessors.push_back({{"bufferView", addView(data, bytes, target)},
                             {"componentType", componentType},
                             {"count", count},
                             {"type", typeName(components)}});
        return static_cast<int>(accessors.size()) - 1;
    }

    int addFloats(const float* values, std::size_t count, int components, int target = 0) {
        const std::size_t bytes = count * static_cast<std::size_t>(components) * sizeof(float);
        return addAccessor(values, bytes, count, kFloat, components, target);
    }

    template <typename Vector> int addVectors(const std::vector<Vector>& vectors, int target = 0) {
        constexpr int components = sizeof(Vector) / sizeof(float);
        return addFloats(glm::value_ptr(vectors.front()), vectors.size(), components, target);
    }

    // The specification wants the box of positions and the range of key times.
    int addPositions(const std::vector<glm::vec3>& positions) {
        const int index = addVectors(positions, kVertexData);
        glm::vec3 low = positions.front();
        glm::vec3 high = low;
        for (const glm::vec3& p : positions) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        json& accessor = document_["accessors"].back();
        accessor["min"] = listOf(low);
        accessor["max"] = listOf(high);
        return index;
    }

    json node(std::size_t index) {
        const Model::Node& from = model_.nodes[index];
        const std::string place = "node " + std::to_string(index);
        checkIndex(from.mesh, model_.meshes.size(), place, "mesh");
        checkIndex(from.skin, model_.skins.size(), place, "skin");
        json to = json::object();
        setName(to, from.name);
        if (!from.children.empty()) to["children"] = from.children;
        if (from.matrix) {
            to["matrix"] = listOf(*from.matrix);
        } else {
            const Model::Node plain;
            const glm::vec4 rotation(from.rotation.x, from.rotation.y, from.rotation.z, from.rotation.w);
            if (from.translation != plain.translation) to["translation"] = listOf(from.translation);
            if (from.rotation != plain.rotation) to["rotation"] = listOf(rotation);
            if (from.scale != plain.scale) to["scale"] = listOf(from.scale);
        }
        if (from.mesh >= 0) to["mesh"] = from.mesh;
        if (from.skin >= 0) to["skin"] = from.skin;
        if (!from.weights.empty()) to["weights"] = listOf(from.weights.data(), from.weights.size());
        setExtras(to, from.extras);
        return to;
    }

    json mesh(std::size_t index) {
        const Model::Mesh& from = model_.meshes[index];
        const std::string place = "mesh " + std::to_string(index);
        json to = {{"primitives", json::array()}};
        setName(to, from.name);
        for (const Model::Primitive& primitive : from.primitives)
            to["primitives"].push_back(triangles(primitive, place));
        if (from.primitives.empty()) to["primitives"].push_back(placeholder());
        if (!from.weights.empty()) to["weights"] = listOf(from.weights.data(), from.weights.size());
        json extras = from.extras;
        if (!from.targetNames.empty()) {
            check(extras.is_null() || extras.is_object(), place,
                  "has names for its morph targets, but extras that hold no names");
            extras["targetNames"] = from.targetNames;
        }
        setExtras(to, extras);
        return to;
    }

    // A glTF mesh needs a primitive; an empty one is written as a single point, which reading leaves out.
    json placeholder() { return {{"mode", 0}, {"attributes", {{"POSITION", addPositions({glm::vec3(0.0F)})}}}}; }

    void checkPrimitive(const Model::Primitive& from, const std::string& place) const {
        const std::size_t count = from.positions.size();
        const auto fits = [&](std::size_t size) { return size == 0 || size == count; };
        check(count > 0 && !from.triangles.empty(), place, "has no triangles");
        check(fits(from.normals.size()), place, "normals and vertices differ in number");
        check(fits(from.texcoords.size()), place, "texture coordinates and vertices differ in number");
        check(fits(from.joints.size()) && from.joints.size() == from.weights.size(), place,
              "joints, weights and vertices differ in number");
        for (const std::vector<glm::vec3>& target : from.morphTargets)
            check(target.size() == count, place, "a morph target and the vertices differ in number");
        for (const auto& [name, custom] : from.custom) {
            check(name.starts_with('_'), place, "a custom attribute has a name that does not begin with an underscore");
            check(custom.components >= 1 && custom.components <= 4 &&
                      custom.values.size() == count * static_cast<std::size_t>(custom.components),
                  place, "a custom attribute and the vertices differ in number");
        }
        for (const glm::uvec3& t : from.triangles)
            check(std::max({t.x, t.y, t.z}) < count, place, "a triangle names a vertex that does not exist");
        checkIndex(from.material, model_.materials.size(), place, "material");
    }

    json triangles(const Model::Primitive& from, const std::string& place) {
        checkPrimitive(from, place);
        json attributes = {{"POSITION", addPositions(from.positions)}};
        if (!from.normals.empty()) attributes["NORMAL"] = addVectors(from.normals, kVertexData);
        if (!from.texcoords.empty()) attributes["TEXCOORD_0"] = addVectors(from.texcoords, kVertexData);
        if (!from.joints.empty()) {
            attributes["JOINTS_0"] = addAccessor(from.joints.data(), from.joints.size() * sizeof(glm::u16vec4),
                                                 from.joints.size(), kUnsignedShort, 4, kVertexData);
            attributes["WEIGHTS_0"] = addVectors(from.weights, kVertexData);
        }
        for (const auto& [name, custom] : from.custom)
            attributes[name] = addFloats(custom.values.data(), from.positions.size(), custom.components, kVertexData);
        const std::size_t corners = from.triangles.size() * 3;
        json to = {{"attributes", std::move(attributes)},
                   {"indices", addAccessor(from.triangles.data(), corners * sizeof(std::uint32_t), corners,
                                           kUnsignedInt, 1, kIndexData)}};
        for (const std::vector<glm::vec3>& target : from.morphTargets)
            to["targets"].push_back({{"POSITION", addPositions(target)}});
        if (from.material >= 0) to["material"] = from.material;
        return to;
    }

    json skin(std::size_t index) {
        const Model::Skin& from = model_.skins[index];
        check(!from.joints.empty() && from.joints.size() == from.inverseBindMatrices.size(),
              "skin " + std::to_string(index), "joints and matrices differ in number, or are none");
        json to = {{"joints", from.joints}, {"inverseBindMatrices", addVectors(from.inverseBindMatrices)}};
        setName(to, from.name);
        return to;
    }

    int addTimes(const std::vector<float>& times) {
        const int index = addFloats(times.data(), times.size(), 1);
        json& accessor = document_["accessors"].back();
        accessor["min"] = listOf(&times.front(), 1);
        accessor["max"] = listOf(&times.back(), 1);
        return index;
    }

    void writeAnimation(std::size_t index) {
        const Model::Animation& from = model_.animations[index];
        const std::string place = "animation " + std::to_string(index);
        json to = {{"channels", json::array()}, {"samplers", json::array()}};
        setName(to, from.name);
        for (const Model::Channel& channel : from.channels) {
            check(!channel.times.empty() && !channel.values.empty(), place, "a channel has no keys");
            check(channel.node >= 0, place, "a channel moves no node");
            checkIndex(channel.node, model_.nodes.size(), place, "node");
            const auto [path, components] = pathOf(channel.path);
            to["samplers"].push_back(
                {{"input", addTimes(channel.times)},
                 {"interpolation", interpolationOf(channel.interpolation)},
                 {"output", addFloats(channel.values.data(),
                                      channel.values.size() / static_cast<std::size_t>(components), components)}});
            to["channels"].push_back(
                {{"sampler", to["samplers"].size() - 1}, {"target", {{"node", channel.node}, {"path", path}}}});
        }
        document_["animations"].push_back(std::move(to));
    }

    static std::pair<const char*, int> pathOf(Model::Path path) {
        switch (path) {
        case Model::Path::translation:
            return {"translation", 3};
        case Model::Path::rotation:
            return {"rotation", 4};
        case Model::Path::scale:
            return {"scale", 3};
        case Model::Path::weights:
            break;
        }
        return {"weights", 1};
    }

    static const char* interpolationOf(Model::Interpolation interpolation) {
        switch (interpolation) {
        case Model::Interpolation::step:
            return "STEP";
        case Model::Interpolation::cubicSpline:
            return "CUBICSPLINE";
        case Model::Interpolation::linear:
            break;
        }
        return "LINEAR";
    }

    json textureOf(int image) {
        checkIndex(image, model_.images.size(), "materials", "image");
        json& textures = document_["textures"];
        const auto [found, isNew] = textures_.emplace(image, static_cast<int>(textures.size()));
        if (isNew) textures.push_back({{"source", image}});
        return {{"index", found->second}};
    }

    json material(const Model::Material& from) {
        json surface = {{"baseColorFactor", listOf(from.baseColor)},
                        {"metallicFactor", from.metallic},
                        {"roughnessFactor", from.roughness}};
        if (from.baseColorImage >= 0) surface["baseColorTexture"] = textureOf(from.baseColorImage);
        if (from.metallicRoughnessImage >= 0)
            surface["metallicRoughnessTexture"] = textureOf(from.metallicRoughnessImage);
        json to = {{"pbrMetallicRoughness", std::move(surface)},
                   {"emissiveFactor", listOf(from.emissive)},
                   {"alphaMode", from.alphaMode},
                   {"doubleSided", from.doubleSided}};
        setName(to, from.name);
        if (from.alphaCutoff != Model::Material().alphaCutoff) to["alphaCutoff"] = from.alphaCutoff;
        if (from.normalImage >= 0) {
            to["normalTexture"] = textureOf(from.normalImage);
            to["normalTexture"]["scale"] = from.normalScale;
        }
        if (from.emissiveImage >= 0) to["emissiveTexture"] = textureOf(from.emissiveImage);
        setExtras(to, from.extras);
        return to;
    }

    void writeImage(const Model::Image& from) {
        json to = json::object();
        if (from.bytes.empty())
            to["uri"] = "data:;base64,"; // one that could not be read stays that
        else
            to["bufferView"] = addView(from.bytes.data(), from.bytes.size());
        setName(to, from.name);
        if (!from.mimeType.empty()) to["mimeType"] = from.mimeType;
        document_["images"].push_back(std::move(to));
    }

    std::vector<std::byte> packed() const {
        // A name that is not UTF-8 is written with replacement characters rather than not at all.
        std::string text = document_.dump(-1, ' ', false, json::error_handler_t::replace);
        text.resize((text.size() + 3) / 4 * 4, ' ');
        const std::size_t binaryBytes = binary_.empty() ? 0 : 8 + binary_.size();
        const std::size_t length = 20 + text.size() + binaryBytes;
        if (length > std::numeric_limits<std::uint32_t>::max())
            refuse("needs more than 4 GiB, which a GLB cannot hold", "split it into several models");
        std::vector<std::byte> glb;
        glb.reserve(length);
        const auto word = [&](std::size_t value) {
            for (int shift = 0; shift < 32; shift += 8) glb.push_back(static_cast<std::byte>((value >> shift) & 0xFFU));
        };
        for (const std::size_t value :
             {std::size_t{0x46546C67}, std::size_t{2}, length, text.size(), std::size_t{0x4E4F534A}})
            word(value);
        const auto* characters = reinterpret_cast<const std::byte*>(text.data());
        glb.insert(glb.end(), characters, characters + text.size());
        if (binary_.empty()) return glb;
        word(binary_.size());
        word(0x004E4942);
        glb.insert(glb.end(), binary_.begin(), binary_.end());
        return glb;
    }

    const Model& model_;
    json document_ = json::object();
    std::vector<std::byte> binary_;
    std::map<int, int> textures_; ///< texture of an image
};

} // namespace

std::vector<std::byte> writeGlb(const Model& model) { return GlbWriter(model).write(); }

} // namespace lumorph
