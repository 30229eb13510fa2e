#include "core/geometry/gltf_parts.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "core/base/error.h"
#include "core/base/json_check.h"

namespace lumorph::gltf {

using nlohmann::json;

void refuse(const std::string& file, const std::string& why, const std::string& remedy) {
    throw DataError(file, why, remedy);
}

MemoryBudget::MemoryBudget(std::string file, std::size_t sourceBytes) : file_(std::move(file)) {
    constexpr std::size_t mebibyte = std::size_t{1} << 20;
    left_ = std::min(128 * mebibyte + 64 * std::min(sourceBytes, 128 * mebibyte), 4096 * mebibyte);
}

void MemoryBudget::charge(std::size_t count, std::size_t bytesEach, const std::string& place) {
    if (count > left_ / bytesEach)
        refuse(file_, place + ": asks for more memory than a file of this size may", "split the model into parts");
    left_ -= count * bytesEach;
}

namespace {

std::uint32_t readU32(std::span<const std::byte> bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value |= std::to_integer<std::uint32_t>(bytes[offset + i]) << (8 * i);
    return value;
}

template <std::size_t size> bool contains(const std::array<std::string_view, size>& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

// tinygltf takes a member of the wrong type for a missing one, which would turn a typing error into another shape.
constexpr std::array<std::string_view, 19> kWholeNumbers = {
    "buffer",        "bufferView", "byteLength", "byteOffset", "byteStride",
    "componentType", "count",      "index",      "input",      "inverseBindMatrices",
    "material",      "mesh",       "mode",       "node",       "output",
    "sampler",       "scene",      "skin",       "source"};
constexpr std::array<std::string_view, 2> kWholeNumberLists = {"children", "joints"};
constexpr std::array<std::string_view, 5> kNumberLists = {"matrix", "translation", "rotation", "scale", "weights"};

bool isWhole(const json& value) {
    return value.is_number_unsigned() && value.get<std::uint64_t>() <= std::numeric_limits<std::uint32_t>::max();
}

bool isIndex(const json& value) {
    return isWhole(value) && value.get<std::uint64_t>() <= std::numeric_limits<int>::max();
}

bool isNumber(const json& value) { return value.is_number(); }

bool isListOf(const json& value, bool (*is)(const json&)) {
    return value.is_array() && std::all_of(value.begin(), value.end(), is);
}

void checkMember(const std::string& key, const json& value, const std::string& place, const std::string& file) {
    if (contains(kWholeNumbers, key) && !(key.starts_with("byte") ? isWhole(value) : isIndex(value)))
        refuse(file, place + ": \"" + key + "\" is not a whole number from 0 up");
    if (contains(kWholeNumberLists, key) && !isListOf(value, isIndex))
        refuse(file, place + ": \"" + key + "\" is not a list of whole numbers");
    const bool scalesNormals = key == "scale" && place.starts_with("material");
    if (contains(kNumberLists, key) && !scalesNormals && !isListOf(value, isNumber))
        refuse(file, place + ": \"" + key + "\" is not a list of numbers");
}

/// A copy without extras and extensions, the members with a fixed type checked. As deep as parseBounded lets it be.
json stripped(const json& value, const std::string& place, const std::string& file) {
    json copy = value.is_object() ? json::object() : json::array();
    if (value.is_array()) {
        for (const json& element : value) copy.push_back(stripped(element, place, file));
        return copy;
    }
    if (!value.is_object()) return value;
    for (const auto& [key, member] : value.items()) {
        if (key == "extras" || key == "extensions") continue;
        checkMember(key, member, place, file);
        copy[key] = stripped(member, place, file);
    }
    return copy;
}

/// What one element of a top-level list is called in a message.
struct Kind {
    const char* list;
    const char* element;
};
constexpr std::array<Kind, 9> kStructure = {{{"accessors", "accessor"},
                                             {"bufferViews", "buffer view"},
                                             {"meshes", "mesh"},
                                             {"nodes", "node"},
                                             {"scenes", "scene"},
                                             {"materials", "material"},
                                             {"textures", "texture"},
                                             {"animations", "animation"},
                                             {"skins", "skin"}}};

/// Channels that point at nodes become channels that name them.
void aimAtNodes(const json& animation, json& copy) {
    const auto channels = animation.find("channels");
    if (channels == animation.end() || !channels->is_array()) return;
    for (std::size_t k = 0; k < channels->size(); ++k)
        if (const auto pointed = pointedNode((*channels)[k]))
            copy["channels"][k]["target"] = {{"node", pointed->node}, {"path", pointed->path}};
}

json structureJson(const json& document, const std::string& file) {
    json structure = {{"asset", {{"version", "2.0"}}}};
    for (const Kind& kind : kStructure) {
        const auto list = document.find(kind.list);
        if (list == document.end()) continue;
        if (!list->is_array()) refuse(file, std::string("\"") + kind.list + "\" is not a list");
        if (list->size() > kMaxElements)
            refuse(file, "holds more than " + std::to_string(kMaxElements) + " " + kind.list,
                   "split the model into parts");
        json& copy = structure[kind.list] = json::array();
        for (std::size_t i = 0; i < list->size(); ++i) {
            const std::string place = std::string(kind.element) + " " + std::to_string(i);
            if (!(*list)[i].is_object()) refuse(file, place + ": is not an object");
            copy.push_back(stripped((*list)[i], place, file));
            if (kind.list == std::string_view("animations")) aimAtNodes((*list)[i], copy.back());
        }
    }
    if (const auto scene = document.find("scene"); scene != document.end()) {
        checkMember("scene", *scene, "default scene", file);
        structure["scene"] = *scene;
    }
    return structure;
}

void checkVersion(const json& document, const std::string& file) {
    const auto asset = document.find("asset");
    const bool named = asset != document.end() && asset->is_object() && asset->contains("version");
    const json version = named ? (*asset)["version"] : json();
    if (!version.is_string()) refuse(file, "names no glTF version");
    if (!version.get<std::string>().starts_with("2."))
        refuse(file, "is of glTF version " + version.get<std::string>(), "export it as glTF 2.0");
}

// Extensions that are read, or met by reading any component type, and such that change how a surface looks, where its
// texture lies, or say something about it; without these the shape is the same.
constexpr std::array<std::string_view, 20> kReadWithout = {"KHR_mesh_quantization",
                                                           "EXT_mesh_gpu_instancing",
                                                           "KHR_node_visibility",
                                                           "KHR_animation_pointer",
                                                           "FB_ngon_encoding",
                                                           "CESIUM_primitive_outline",
                                                           "EXT_mesh_features",
                                                           "EXT_instance_features",
                                                           "EXT_feature_metadata",
                                                           "EXT_structural_metadata",
                                                           "EXT_mesh_manifold",
                                                           "KHR_xmp",
                                                           "KHR_xmp_json_ld",
                                                           "KHR_node_hoverability",
                                                           "KHR_node_selectability",
                                                           "KHR_interactivity",
                                                           "MSFT_lod",
                                                           "VRM",
                                                           "VRMC_vrm",
                                                           "VRMC_springBone"};
constexpr std::array<std::string_view, 8> kLooks = {"KHR_materials_",   "KHR_texture_",   "EXT_texture_",
                                                    "MSFT_texture_",    "KHR_lights_",    "EXT_lights_",
                                                    "ADOBE_materials_", "VRMC_materials_"};

bool canRead(const std::string& extension) {
    return contains(kReadWithout, extension) ||
           std::ranges::any_of(kLooks, [&](std::string_view looks) { return extension.starts_with(looks); });
}

void checkExtensions(const json& document, const std::string& file) {
    const auto required = document.find("extensionsRequired");
    if (required == document.end()) return;
    if (!required->is_array()) refuse(file, "\"extensionsRequired\" is not a list");
    for (const json& extension : *required) {
        if (!extension.is_string()) refuse(file, "\"extensionsRequired\" holds something that is not a name");
        const auto name = extension.get<std::string>();
        if (!canRead(name))
            refuse(file, "needs the extension " + name.substr(0, 80) + ", which is not supported",
                   "export it without " + name.substr(0, 80));
    }
}

// tinygltf drops a primitive or a channel it cannot read; its elements must stay those of the document.
void checkNothingDropped(const json& structure, const tinygltf::Model& model, const std::string& file) {
    for (std::size_t i = 0; i < model.meshes.size(); ++i) {
        const json& mesh = structure["meshes"][i];
        const auto primitives = mesh.find("primitives");
        const std::size_t count = primitives == mesh.end() ? 0 : primitives->size();
        if (!(primitives == mesh.end() || primitives->is_array()) || model.meshes[i].primitives.size() != count)
            refuse(file, "mesh " + std::to_string(i) + ": a primitive names no attributes");
    }
}

} // namespace

Container splitGlb(std::span<const std::byte> bytes, const std::string& file) {
    constexpr std::uint32_t magic = 0x46546C67;
    constexpr std::uint32_t jsonChunk = 0x4E4F534A;
    constexpr std::uint32_t binaryChunk = 0x004E4942;
    if (bytes.size() < 4 || readU32(bytes, 0) != magic)
        refuse(file, "does not begin with \"glTF\"", "choose a binary glTF 2.0 file (.glb)");
    if (bytes.size() < 20) refuse(file, "ends within its header", "copy or download the file again");
    if (const std::uint32_t version = readU32(bytes, 4); version != 2)
        refuse(file, "is of GLB version " + std::to_string(version), "export it as glTF 2.0");
    const std::size_t length = readU32(bytes, 8);
    if (length > bytes.size() || length < 20)
        refuse(file,
               "is " + std::to_string(bytes.size()) + " bytes long, but its header says " + std::to_string(length),
               "copy or download the file again");

    Container container;
    std::size_t offset = 12;
    for (int chunk = 0; offset + 8 <= length && chunk < 2; ++chunk) {
        const std::size_t size = readU32(bytes, offset);
        const std::uint32_t type = readU32(bytes, offset + 4);
        offset += 8;
        if (size > length - offset)
            refuse(file, "chunk " + std::to_string(chunk) + ": is longer than the file",
                   "copy or download the file again");
        if (chunk == 0 && type != jsonChunk) refuse(file, "chunk 0: is not JSON");
        const std::span<const std::byte> content = bytes.subspan(offset, size);
        if (chunk == 0) container.json = {reinterpret_cast<const char*>(content.data()), content.size()};
        if (chunk == 1 && type == binaryChunk) container.binary = content;
        offset += size;
    }
    return container;
}

Container splitFile(std::span<const std::byte> bytes, std::string_view text, const std::filesystem::path& file) {
    const bool binary = text.starts_with("glTF") || file.extension() == ".glb" || file.extension() == ".GLB";
    return binary ? splitGlb(bytes, file.string()) : Container{text, std::nullopt};
}

json parseBounded(std::string_view text, const std::string& file) {
    const JsonLimits limits;
    if (const std::string problem = jsonProblem(text, limits); !problem.empty())
        refuse(file, problem,
               text.size() > limits.bytes ? "export it as .glb, with its data in the binary part" : kExportAgain);
    json document = json::parse(text);
    if (!document.is_object()) refuse(file, "its JSON is not an object");
    return document;
}

tinygltf::Model structureOf(const json& document, const std::string& file) {
    checkVersion(document, file);
    checkExtensions(document, file);
    const json structure = structureJson(document, file);
    const std::string text = structure.dump();
    tinygltf::TinyGLTF loader;
    tinygltf::Model model;
    std::string errors;
    std::string warnings;
    if (!loader.LoadASCIIFromString(&model, &errors, &warnings, text.data(), static_cast<unsigned int>(text.size()),
                                    "")) {
        const std::size_t end = std::min(errors.find('\n'), std::size_t{200});
        refuse(file,
               "is not valid glTF: " + (errors.empty() ? std::string("unknown structure") : errors.substr(0, end)));
    }
    checkNothingDropped(structure, model, file);
    return model;
}

} // namespace lumorph::gltf
