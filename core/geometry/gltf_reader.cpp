#include "core/geometry/gltf_reader.h"

#include <cmath>
#include <limits>

#include <glm/gtc/type_ptr.hpp>

#include "core/base/error.h"
#include "core/base/plain_text.h"
#include "core/geometry/gltf_parts.h"
#include "core/geometry/mesh_file.h"

namespace lumorph {

using nlohmann::json;

namespace gltf {

int Source::checked(int index, std::size_t size, const std::string& place, const char* what) const {
    if (index < -1 || (index >= 0 && static_cast<std::size_t>(index) >= size))
        refuse(place + ": there is no " + what + " " + std::to_string(index));
    return index;
}

float Source::number(double value, const std::string& place) const {
    if (!(std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max())))
        refuse(place + ": a number is beyond the range of float");
    return static_cast<float>(value);
}

std::vector<float> Source::numbers(const std::vector<double>& values, const std::string& place) const {
    std::vector<float> floats;
    floats.reserve(values.size());
    for (const double value : values) floats.push_back(number(value, place));
    return floats;
}

json Source::extras(const char* list, std::size_t index) const {
    const json& element = document[list][index];
    const auto extras = element.find("extras");
    return extras == element.end() ? json() : *extras;
}

namespace {

/// Image of a texture, -1 for none.
int imageOf(const Source& source, int texture, std::size_t images, const std::string& place) {
    const int index = source.checked(texture, source.structure.textures.size(), place, "texture");
    return index < 0 ? -1 : pictureOf(source, static_cast<std::size_t>(index), images, place);
}

Model::Material readMaterial(const Source& source, std::size_t index, std::size_t images) {
    const tinygltf::Material& from = source.structure.materials[index];
    const auto& surface = from.pbrMetallicRoughness;
    const std::string place = "material " + std::to_string(index);
    const auto list = [&](const std::vector<double>& values, std::size_t count) {
        if (values.size() != count) source.refuse(place + ": a factor has the wrong number of values");
        return source.numbers(values, place);
    };
    Model::Material material;
    material.name = from.name;
    material.baseColor = glm::make_vec4(list(surface.baseColorFactor, 4).data());
    material.emissive = glm::make_vec3(list(from.emissiveFactor, 3).data());
    material.metallic = source.number(surface.metallicFactor, place);
    material.roughness = source.number(surface.roughnessFactor, place);
    material.normalScale = source.number(from.normalTexture.scale, place);
    material.alphaCutoff = source.number(from.alphaCutoff, place);
    material.alphaMode = from.alphaMode;
    material.doubleSided = from.doubleSided;
    material.baseColorImage = imageOf(source, surface.baseColorTexture.index, images, place);
    material.metallicRoughnessImage = imageOf(source, surface.metallicRoughnessTexture.index, images, place);
    material.normalImage = imageOf(source, from.normalTexture.index, images, place);
    material.emissiveImage = imageOf(source, from.emissiveTexture.index, images, place);
    if (material.normalImage < 0) material.normalScale = 1.0F;
    material.extras = source.extras("materials", index);
    return material;
}

/// Extras of the asset, and of the default scene under the names the asset leaves free.
json documentExtras(const Source& source) {
    const json& asset = source.document["asset"];
    json extras = asset.contains("extras") ? asset["extras"] : json();
    if (source.structure.scenes.empty()) return extras;
    json scene = source.extras("scenes", static_cast<std::size_t>(std::max(source.structure.defaultScene, 0)));
    if (extras.is_null()) return scene;
    if (!extras.is_object() || !scene.is_object()) return extras;
    scene.update(extras);
    return scene;
}

/// What it needs and is read without, where that shows.
std::vector<std::string> extensionWarnings(const json& document) {
    std::vector<std::string> warnings;
    const auto required = document.find("extensionsRequired");
    if (required == document.end()) return warnings;
    for (const json& extension : *required) {
        const auto name = extension.get<std::string>();
        const bool picture = name.starts_with("EXT_texture_") || name.starts_with("MSFT_texture_") ||
                             (name.starts_with("KHR_texture_") && name != "KHR_texture_transform");
        if (picture)
            warnings.push_back("It asks for " + name.substr(0, 80) +
                               ", which only changes how it looks; its geometry is read, without such pictures.");
    }
    return warnings;
}

ReadModel readDocument(const Container& container, const Folder& folder, std::size_t sourceBytes,
                       const std::string& file) {
    const json document = parseBounded(container.json, file);
    const tinygltf::Model structure = structureOf(document, file);
    const Buffers buffers = readBuffers(document, container, folder, file);
    for (const std::vector<std::byte>& owned : buffers.owned) sourceBytes += owned.size();
    MemoryBudget budget(file, sourceBytes);
    const Accessors accessors(structure, buffers, budget, file);
    ReadModel read{{}, extensionWarnings(document), {}};
    const Source source{document, structure, accessors, read.warnings};

    Model& model = read.model;
    model.images = readImages(document, structure, buffers, folder, budget, file, read.unread);
    read.warnings.insert(read.warnings.end(), read.unread.begin(), read.unread.end());
    for (std::size_t i = 0; i < structure.materials.size(); ++i)
        model.materials.push_back(readMaterial(source, i, model.images.size()));
    model.meshes = readMeshes(source);
    readScene(source, model);
    model.extras = documentExtras(source);
    return read;
}

} // namespace
} // namespace gltf

ReadModel readModelFile(const std::filesystem::path& file) {
    const std::string name = file.string();
    const std::vector<std::byte> bytes = gltf::readFile(file, kMaxFileBytes, name);
    const PlainText text(bytes);
    const gltf::Container container = gltf::splitFile(bytes, text.view(), file);
    ReadModel read = gltf::readDocument(container, gltf::Folder(file.parent_path()), bytes.size(), name);
    if (read.model.name.empty()) read.model.name = file.stem().string();
    return read;
}

Model readModel(const std::filesystem::path& file) { return readModelFile(file).model; }

ReadModel readGlbBytes(std::span<const std::byte> bytes, const std::string& name) {
    if (bytes.size() > kMaxFileBytes)
        gltf::refuse(name, "is larger than " + std::to_string(kMaxFileBytes >> 20) + " MiB",
                     "split the model into parts");
    return gltf::readDocument(gltf::splitGlb(bytes, name), gltf::Folder(), bytes.size(), name);
}

Model readGlb(std::span<const std::byte> bytes, const std::string& name) { return readGlbBytes(bytes, name).model; }

} // namespace lumorph
