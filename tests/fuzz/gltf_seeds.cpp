// Writes small valid GLB files into the folder given, for gltf_fuzz to start from.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/geometry/model.h"
#include "tests/support/full_model.h"
#include "tests/support/gltf_builder.h"

namespace {

using lumorph::support::GltfBuilder;

GltfBuilder sparse() {
    GltfBuilder builder = GltfBuilder::triangle();
    const std::array<std::uint16_t, 2> indices = {0, 2};
    const std::array<float, 6> values = {1, 2, 3, 4, 5, 6};
    const int indexView = builder.view(indices.data(), sizeof(indices));
    const int valueView = builder.view(values.data(), sizeof(values));
    builder.document["accessors"][0]["sparse"] = {{"count", 2},
                                                  {"indices", {{"bufferView", indexView}, {"componentType", 5123}}},
                                                  {"values", {{"bufferView", valueView}}}};
    builder.document["images"] = {{{"uri", "data:image/png;base64,iVBORw=="}}};
    return builder;
}

GltfBuilder strip() {
    GltfBuilder builder = GltfBuilder::triangle();
    builder.primitive()["mode"] = 5;
    builder.primitive()["attributes"]["_LEVEL"] =
        builder.accessor(std::vector<std::uint8_t>{0, 128, 255}, "SCALAR", 5121);
    builder.document["accessors"].back()["normalized"] = true;
    builder.document["nodes"] = {{{"children", {1}}},
                                 {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1}}}};
    return builder;
}

/// JSON, a zero byte and the binary data of a GLB.
std::vector<std::byte> partsOf(const std::vector<std::byte>& glb) {
    std::uint32_t jsonBytes = 0;
    std::memcpy(&jsonBytes, glb.data() + 12, sizeof(jsonBytes));
    const auto text = glb.begin() + 20;
    std::vector<std::byte> parts(text, text + jsonBytes);
    parts.push_back(std::byte{0});
    parts.insert(parts.end(), text + jsonBytes + 8, glb.end());
    return parts;
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: gltf_seeds <folder>\n");
        return 2;
    }
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    const auto write = [&](const std::string& name, const std::vector<std::byte>& bytes) {
        std::ofstream(folder / name, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    };
    const auto writeBoth = [&](const std::string& name, const std::vector<std::byte>& glb) {
        write(name + ".glb", glb);
        write(name + ".parts", partsOf(glb));
    };
    writeBoth("full", lumorph::writeGlb(lumorph::support::fullModel()));
    writeBoth("triangle", GltfBuilder::triangle().glb());
    writeBoth("sparse", sparse().glb());
    writeBoth("strip", strip().glb());
    return 0;
}
