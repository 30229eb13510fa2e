#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace lumorph::support {

/// Packs JSON text and a binary chunk as a GLB; nothing is checked, so that broken files can be made too.
inline std::vector<std::byte> packGlb(std::string text, std::vector<std::byte> binary) {
    text.resize((text.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4);
    std::vector<std::byte> glb;
    const auto word = [&](std::size_t value) {
        for (int shift = 0; shift < 32; shift += 8) glb.push_back(static_cast<std::byte>((value >> shift) & 0xFFU));
    };
    const std::size_t binaryBytes = binary.empty() ? 0 : 8 + binary.size();
    for (const std::size_t value : {std::size_t{0x46546C67}, std::size_t{2}, 20 + text.size() + binaryBytes,
                                    text.size(), std::size_t{0x4E4F534A}})
        word(value);
    for (const char c : text) glb.push_back(static_cast<std::byte>(c));
    if (binary.empty()) return glb;
    word(binary.size());
    word(0x004E4942);
    glb.insert(glb.end(), binary.begin(), binary.end());
    return glb;
}

/// A glTF document under construction: JSON to edit freely, and a buffer that grows with every accessor.
class GltfBuilder {
public:
    nlohmann::json document = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
    std::vector<std::byte> binary;

    int view(const void* data, std::size_t bytes) {
        document["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes}});
        const auto* first = static_cast<const std::byte*>(data);
        binary.insert(binary.end(), first, first + bytes);
        binary.resize((binary.size() + 3) / 4 * 4);
        return static_cast<int>(document["bufferViews"].size()) - 1;
    }

    template <typename Component>
    int accessor(const std::vector<Component>& values, const std::string& type, int componentType) {
        const std::size_t components = type == "SCALAR" ? 1
                                       : type == "MAT4" ? 16
                                                        : static_cast<std::size_t>(type[3] - '0');
        document["accessors"].push_back({{"bufferView", view(values.data(), values.size() * sizeof(Component))},
                                         {"componentType", componentType},
                                         {"count", values.size() / components},
                                         {"type", type}});
        return static_cast<int>(document["accessors"].size()) - 1;
    }
    int floats(const std::vector<float>& values, const std::string& type) { return accessor(values, type, 5126); }

    /// One node that shows one mesh: a triangle with corners (0 0 0), (1 0 0), (0 1 0), indexed.
    static GltfBuilder triangle() {
        GltfBuilder builder;
        const int positions = builder.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
        const int indices = builder.accessor(std::vector<std::uint16_t>{0, 1, 2}, "SCALAR", 5123);
        builder.document["meshes"] = {
            {{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}}}}};
        builder.document["nodes"] = {{{"mesh", 0}}};
        return builder;
    }

    nlohmann::json& primitive() { return document["meshes"][0]["primitives"][0]; }

    std::vector<std::byte> glb() const {
        nlohmann::json whole = document;
        if (!whole.contains("buffers")) whole["buffers"] = {{{"byteLength", binary.size()}}};
        return packGlb(whole.dump(), binary);
    }
};

/// A folder of its own for one test, removed afterwards.
class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "lumorph-test-XXXXXX").string();
        path_ = mkdtemp(pattern.data());
    }
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

    std::filesystem::path write(const std::filesystem::path& name, std::span<const std::byte> bytes) const {
        std::ofstream(path_ / name, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        return path_ / name;
    }
    std::filesystem::path write(const std::filesystem::path& name, const std::string& text) const {
        return write(name, std::as_bytes(std::span(text)));
    }

private:
    std::filesystem::path path_;
};

} // namespace lumorph::support
