#include "core/geometry/gltf_parts.h"

#include <array>
#include <charconv>
#include <string_view>

namespace lumorph::gltf {

using nlohmann::json;

namespace {

/// An index under a key; -1 for none, refused where it is no index.
int indexAt(const Source& source, const json& object, const char* key, const std::string& place) {
    const auto found = object.find(key);
    if (found == object.end()) return -1;
    if (!found->is_number_unsigned() || found->get<std::uint64_t>() >= kMaxElements)
        source.refuse(place + ": \"" + key + "\" is not a whole number from 0 up");
    return found->get<int>();
}

glm::quat unitRotation(const Source& source, const glm::vec4& q, const std::string& place) {
    const double length = glm::length(glm::dvec4(q));
    if (length < 1e-6) source.refuse(place + " ROTATION: is zero");
    const glm::dvec4 unit = glm::dvec4(q) / length;
    return glm::quat(glm::dquat(unit.w, unit.x, unit.y, unit.z));
}

} // namespace

const json& extensionOf(const json& element, const char* name) {
    static const json none;
    const auto extensions = element.find("extensions");
    if (extensions == element.end() || !extensions->is_object()) return none;
    const auto found = extensions->find(name);
    return found == extensions->end() ? none : *found;
}

bool isHidden(const Source& source, std::size_t node) {
    const json& visibility = extensionOf(source.document["nodes"][node], "KHR_node_visibility");
    const auto visible = visibility.is_object() ? visibility.find("visible") : visibility.end();
    return visible != visibility.end() && visible->is_boolean() && !visible->get<bool>();
}

std::vector<Model::Node> instancesOf(const Source& source, std::size_t node) {
    const json& instancing = extensionOf(source.document["nodes"][node], "EXT_mesh_gpu_instancing");
    const auto attributes = instancing.is_object() ? instancing.find("attributes") : instancing.end();
    if (attributes == instancing.end() || !attributes->is_object()) return {};
    const std::string place = "node " + std::to_string(node) + " EXT_mesh_gpu_instancing";
    const int translation = indexAt(source, *attributes, "TRANSLATION", place);
    const int rotation = indexAt(source, *attributes, "ROTATION", place);
    const int scale = indexAt(source, *attributes, "SCALE", place);
    std::vector<Model::Node> copies;
    const auto each = [&](std::size_t count, const auto& set) {
        if (count > kMaxElements)
            source.refuse(place + ": has more than " + std::to_string(kMaxElements) + " copies", "show fewer");
        if (copies.empty()) copies.resize(count);
        if (copies.size() != count) source.refuse(place + ": its attributes differ in number");
        for (std::size_t i = 0; i < count; ++i) set(i);
    };
    if (translation >= 0) {
        const auto values = source.accessors.vectors<glm::vec3>(translation, place + " TRANSLATION");
        each(values.size(), [&](std::size_t i) { copies[i].translation = values[i]; });
    }
    if (rotation >= 0) {
        const auto values = source.accessors.vectors<glm::vec4>(rotation, place + " ROTATION");
        each(values.size(), [&](std::size_t i) { copies[i].rotation = unitRotation(source, values[i], place); });
    }
    if (scale >= 0) {
        const auto values = source.accessors.vectors<glm::vec3>(scale, place + " SCALE");
        each(values.size(), [&](std::size_t i) { copies[i].scale = values[i]; });
    }
    return copies;
}

std::optional<PointedNode> pointedNode(const json& channel) {
    const auto target = channel.is_object() ? channel.find("target") : channel.end();
    if (target == channel.end() || !target->is_object()) return std::nullopt;
    const json& pointing = extensionOf(*target, "KHR_animation_pointer");
    if (!pointing.is_object()) return std::nullopt;
    const std::string pointer = stringMember(pointing, "pointer");
    constexpr std::string_view kNodes = "/nodes/";
    if (!pointer.starts_with(kNodes)) return std::nullopt;
    PointedNode pointed;
    const char* const end = pointer.data() + pointer.size();
    const auto [stop, error] = std::from_chars(pointer.data() + kNodes.size(), end, pointed.node);
    if (error != std::errc() || stop == end || *stop != '/' || pointed.node < 0) return std::nullopt;
    pointed.path.assign(stop + 1, end);
    for (const char* path : {"translation", "rotation", "scale", "weights"})
        if (pointed.path == path) return pointed;
    return std::nullopt;
}

int pictureOf(const Source& source, std::size_t texture, std::size_t images, const std::string& place) {
    const int plain = source.structure.textures[texture].source;
    if (plain != -1) return source.checked(plain, images, place, "image");
    const json& element = source.document["textures"][texture];
    for (const char* name : {"KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif", "MSFT_texture_dds"}) {
        const json& named = extensionOf(element, name);
        if (!named.is_object() || !named.contains("source")) continue;
        const std::string warning = std::string("Its textures have pictures of a kind that is not read (") + name +
                                    "); a placeholder stands for each.";
        if (std::ranges::find(source.warnings, warning) == source.warnings.end()) source.warnings.push_back(warning);
        return source.checked(indexAt(source, named, "source", place + " " + name), images, place, "image");
    }
    return -1;
}

} // namespace lumorph::gltf
