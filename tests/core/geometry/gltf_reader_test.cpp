#include <array>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/model.h"
#include "tests/support/gltf_builder.h"

namespace lumorph {
namespace {

using nlohmann::json;
using support::GltfBuilder;
using ::testing::ElementsAre;

Model read(const GltfBuilder& builder) { return readGlb(builder.glb(), "test.glb"); }

const Model::Primitive& onlyPrimitive(const Model& model) { return model.meshes.at(0).primitives.at(0); }

template <typename Component> void putBytes(std::vector<std::byte>& bytes, const std::vector<Component>& values) {
    const auto raw = std::as_bytes(std::span(values));
    bytes.insert(bytes.end(), raw.begin(), raw.end());
}

std::string base64(std::span<const std::byte> bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

TEST(GltfReader, ReadsAnIndexedTriangle) {
    const Model model = read(GltfBuilder::triangle());
    EXPECT_THAT(onlyPrimitive(model).positions,
                ElementsAre(glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)));
    EXPECT_THAT(onlyPrimitive(model).triangles, ElementsAre(glm::uvec3(0, 1, 2)));
    EXPECT_THAT(model.roots, ElementsAre(0));
}

struct Mode {
    int mode;
    std::vector<std::uint8_t> indices;
    std::vector<glm::uvec3> triangles;
};

class GltfReaderTriangleModes : public ::testing::TestWithParam<Mode> {};

TEST_P(GltfReaderTriangleModes, BecomeTriangles) {
    GltfBuilder builder = GltfBuilder::triangle();
    builder.primitive()["attributes"]["POSITION"] = builder.floats(std::vector<float>(18, 0.0F), "VEC3");
    builder.primitive()["mode"] = GetParam().mode;
    builder.primitive().erase("indices");
    if (!GetParam().indices.empty())
        builder.primitive()["indices"] = builder.accessor(GetParam().indices, "SCALAR", 5121);
    EXPECT_EQ(onlyPrimitive(read(builder)).triangles, GetParam().triangles);
}

INSTANTIATE_TEST_SUITE_P(Table, GltfReaderTriangleModes,
                         ::testing::Values(Mode{4, {}, {{0, 1, 2}, {3, 4, 5}}},                 //
                                           Mode{4, {5, 4, 3}, {{5, 4, 3}}},                     //
                                           Mode{5, {0, 1, 2, 3}, {{0, 1, 2}, {1, 3, 2}}},       //
                                           Mode{5, {0, 1, 2, 2, 3, 4}, {{0, 1, 2}, {2, 4, 3}}}, // stitched
                                           Mode{6, {0, 1, 2, 3}, {{1, 2, 0}, {2, 3, 0}}},       //
                                           Mode{6, {}, {{1, 2, 0}, {2, 3, 0}, {3, 4, 0}, {4, 5, 0}}}));

TEST(GltfReader, LeavesOutPointsAndLines) {
    GltfBuilder builder = GltfBuilder::triangle();
    for (const int mode : {0, 1, 2, 3}) {
        json other = builder.primitive();
        other["mode"] = mode;
        builder.document["meshes"][0]["primitives"].push_back(other);
    }
    EXPECT_EQ(read(builder).meshes[0].primitives.size(), 1U);
}

struct Stored {
    const char* name;
    int componentType;
    bool normalized;
    std::vector<std::byte> bytes;
    std::vector<float> expected;
};

template <typename Component> std::vector<std::byte> bytesIn(const std::vector<Component>& values) {
    std::vector<std::byte> bytes;
    putBytes(bytes, values);
    return bytes;
}

class GltfReaderComponentTypes : public ::testing::TestWithParam<Stored> {};

TEST_P(GltfReaderComponentTypes, BecomeFloats) {
    GltfBuilder builder = GltfBuilder::triangle();
    const int index = builder.accessor(GetParam().bytes, "SCALAR", GetParam().componentType);
    builder.document["accessors"][static_cast<std::size_t>(index)]["count"] = 3;
    builder.document["accessors"][static_cast<std::size_t>(index)]["normalized"] = GetParam().normalized;
    builder.primitive()["attributes"]["_VALUE"] = index;
    const Model model = read(builder);
    EXPECT_EQ(onlyPrimitive(model).custom.at("_VALUE").values, GetParam().expected);
}

INSTANTIATE_TEST_SUITE_P(
    Table, GltfReaderComponentTypes,
    ::testing::Values(
        Stored{"Byte", 5120, false, bytesIn<std::int8_t>({-128, 0, 127}), {-128, 0, 127}},
        Stored{"ByteNormalized", 5120, true, bytesIn<std::int8_t>({-128, 0, 127}), {-1, 0, 1}},
        Stored{"UnsignedByte", 5121, false, bytesIn<std::uint8_t>({0, 51, 255}), {0, 51, 255}},
        Stored{"UnsignedByteNormalized", 5121, true, bytesIn<std::uint8_t>({0, 51, 255}), {0, 0.2F, 1}},
        Stored{"Short", 5122, false, bytesIn<std::int16_t>({-32768, 5, 32767}), {-32768, 5, 32767}},
        Stored{"ShortNormalized", 5122, true, bytesIn<std::int16_t>({-32768, 0, 32767}), {-1, 0, 1}},
        Stored{"UnsignedShort", 5123, false, bytesIn<std::uint16_t>({0, 1, 65535}), {0, 1, 65535}},
        Stored{"UnsignedShortNormalized", 5123, true, bytesIn<std::uint16_t>({0, 13107, 65535}), {0, 0.2F, 1}},
        Stored{"UnsignedInt", 5125, false, bytesIn<std::uint32_t>({0, 1, 1 << 30}), {0, 1, 1073741824.0F}},
        Stored{"Float", 5126, false, bytesIn<float>({-1.5F, 0, 1e30F}), {-1.5F, 0, 1e30F}}),
    [](const auto& row) { return row.param.name; });

TEST(GltfReader, FollowsStrideAndOffset) {
    GltfBuilder builder = GltfBuilder::triangle();
    // position and texture coordinates interleaved, after four bytes of something else
    const std::vector<float> vertices = {-1, 1, 2, 3, 10, 11, 4, 5, 6, 12, 13, 7, 8, 9, 14, 15};
    const int index = builder.floats(vertices, "SCALAR");
    json& accessors = builder.document["accessors"];
    json positions = accessors[static_cast<std::size_t>(index)];
    builder.document["bufferViews"][positions["bufferView"].get<std::size_t>()]["byteStride"] = 20;
    positions["type"] = "VEC3";
    positions["count"] = 3;
    positions["byteOffset"] = 4;
    accessors[0] = positions;
    positions["type"] = "VEC2";
    positions["byteOffset"] = 16;
    accessors[static_cast<std::size_t>(index)] = positions;
    builder.primitive()["attributes"]["TEXCOORD_0"] = index;
    const Model model = read(builder);
    EXPECT_THAT(onlyPrimitive(model).positions,
                ElementsAre(glm::vec3(1, 2, 3), glm::vec3(4, 5, 6), glm::vec3(7, 8, 9)));
    EXPECT_THAT(onlyPrimitive(model).texcoords, ElementsAre(glm::vec2(10, 11), glm::vec2(12, 13), glm::vec2(14, 15)));
}

json sparseOf(GltfBuilder& builder, const std::vector<std::uint8_t>& indices, const std::vector<float>& values) {
    const int indexView = builder.view(indices.data(), indices.size());
    const int valueView = builder.view(values.data(), values.size() * sizeof(float));
    return {{"count", indices.size()},
            {"indices", {{"bufferView", indexView}, {"componentType", 5121}}},
            {"values", {{"bufferView", valueView}}}};
}

TEST(GltfReader, SparseValuesReplaceThoseBelow) {
    GltfBuilder builder = GltfBuilder::triangle();
    builder.document["accessors"][0]["sparse"] = sparseOf(builder, {0, 2}, {5, 6, 7, 8, 9, 10});
    EXPECT_THAT(onlyPrimitive(read(builder)).positions,
                ElementsAre(glm::vec3(5, 6, 7), glm::vec3(1, 0, 0), glm::vec3(8, 9, 10)));
}

TEST(GltfReader, SparseValuesStandOverZerosWithoutABufferView) {
    GltfBuilder builder = GltfBuilder::triangle();
    builder.document["accessors"].push_back(
        {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}, {"sparse", sparseOf(builder, {1}, {0, 0, 4})}});
    builder.primitive()["targets"] = {{{"POSITION", 2}}, json::object()};
    const Model model = read(builder);
    EXPECT_THAT(onlyPrimitive(model).morphTargets[0], ElementsAre(glm::vec3(0), glm::vec3(0, 0, 4), glm::vec3(0)));
    EXPECT_THAT(onlyPrimitive(model).morphTargets[1], ElementsAre(glm::vec3(0), glm::vec3(0), glm::vec3(0)));
}

TEST(GltfReader, ParentsStandBeforeChildrenAndIndicesFollow) {
    GltfBuilder builder = GltfBuilder::triangle();
    builder.document["nodes"] = {{{"name", "leaf"}, {"mesh", 0}},
                                 {{"name", "root"}, {"children", {2}}, {"scale", {2, 2, 2}}},
                                 {{"name", "middle"}, {"children", {0}}, {"translation", {0, 0, 1}}}};
    builder.document["scenes"][0]["nodes"] = {1};
    builder.document["skins"] = {{{"joints", {0, 2}}}};
    const int times = builder.floats({0}, "SCALAR");
    builder.document["animations"] = {
        {{"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "translation"}}}}}},
         {"samplers", {{{"input", times}, {"output", builder.floats({0, 0, 5}, "VEC3")}, {"interpolation", "STEP"}}}}}};
    const Model model = read(builder);
    ASSERT_EQ(model.nodes.size(), 3U);
    EXPECT_EQ(model.nodes[0].name, "root");
    EXPECT_EQ(model.nodes[1].name, "middle");
    EXPECT_EQ(model.nodes[2].name, "leaf");
    EXPECT_THAT(model.nodes[0].children, ElementsAre(1));
    EXPECT_EQ(model.nodes[2].parent, 1);
    EXPECT_THAT(model.roots, ElementsAre(0));
    EXPECT_THAT(model.skins[0].joints, ElementsAre(2, 1));
    EXPECT_EQ(model.skins[0].inverseBindMatrices[1], glm::mat4(1.0F));
    EXPECT_EQ(model.animations[0].channels[0].node, 1);
    EXPECT_EQ(flatten(model).positions[1], glm::vec3(2, 0, 2));
    EXPECT_EQ(flatten(model, model.animations[0], 0.0).positions[1], glm::vec3(2, 0, 10));
}

TEST(GltfReader, WeightsAreNormalised) {
    GltfBuilder builder = GltfBuilder::triangle();
    builder.document["skins"] = {{{"joints", {0, 0}}}};
    builder.document["nodes"][0]["skin"] = 0;
    // A joint that does not exist, at weight 0, is what some exporters leave behind.
    builder.primitive()["attributes"]["JOINTS_0"] =
        builder.accessor(std::vector<std::uint8_t>{0, 1, 200, 0, 1, 0, 0, 0, 1, 1, 1, 1}, "VEC4", 5121);
    builder.primitive()["attributes"]["WEIGHTS_0"] = builder.floats({1, 3, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
    const Model model = read(builder);
    EXPECT_THAT(onlyPrimitive(model).weights,
                ElementsAre(glm::vec4(0.25F, 0.75F, 0, 0), glm::vec4(1, 0, 0, 0), glm::vec4(1, 0, 0, 0)));
    EXPECT_EQ(onlyPrimitive(model).joints[0], glm::u16vec4(0, 1, 0, 0));
}

TEST(GltfReader, ExtrasSurviveExactly) {
    GltfBuilder builder = GltfBuilder::triangle();
    const json extras = {{"null", nullptr}, {"big", 1234567890123456789LL}, {"deep", {{"list", {1, 2.5, "x", false}}}}};
    builder.document["nodes"][0]["extras"] = extras;
    builder.document["meshes"][0]["extras"] = {{"targetNames", {"a"}}, {"more", 1}};
    builder.document["materials"] = {{{"extras", "text"}}};
    builder.document["asset"]["extras"] = {{"both", "asset"}, {"one", 1}};
    builder.document["scenes"][0]["extras"] = {{"both", "scene"}, {"two", 2}};
    const Model model = read(builder);
    EXPECT_EQ(model.nodes[0].extras, extras);
    EXPECT_EQ(model.materials[0].extras, json("text"));
    EXPECT_EQ(model.extras, json({{"both", "asset"}, {"one", 1}, {"two", 2}}));
    // There is no morph target that "a" could name, so it stays what it was.
    EXPECT_EQ(model.meshes[0].extras, json({{"targetNames", {"a"}}, {"more", 1}}));
}

TEST(GltfReader, TargetNamesLeaveTheExtras) {
    GltfBuilder builder = GltfBuilder::triangle();
    builder.primitive()["targets"] = {{{"POSITION", 0}}};
    builder.document["meshes"][0]["extras"] = {{"targetNames", {"smile"}}};
    const Model model = read(builder);
    EXPECT_THAT(model.meshes[0].targetNames, ElementsAre("smile"));
    EXPECT_TRUE(model.meshes[0].extras.is_null());
}

TEST(GltfReader, MaterialsKeepFactorsAndPictures) {
    GltfBuilder builder = GltfBuilder::triangle();
    const std::array<unsigned char, 5> png = {0x89, 'P', 'N', 'G', 7};
    builder.document["images"] = {{{"bufferView", builder.view(png.data(), png.size())}},
                                  {{"uri", "data:image/webp;base64,QUJD"}, {"name", "letters"}}};
    builder.document["textures"] = {{{"source", 1}}, {{"source", 0}}};
    builder.document["materials"] = {
        {{"name", "paint"},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0}, {"baseColorTexture", {{"index", 1}}}}},
         {"normalTexture", {{"index", 0}, {"scale", 0.5}}},
         {"alphaMode", "BLEND"},
         {"doubleSided", true}}};
    builder.primitive()["material"] = 0;
    const Model model = read(builder);
    EXPECT_EQ(model.images[0].mimeType, "image/png");
    EXPECT_EQ(model.images[0].bytes.size(), 5U);
    EXPECT_EQ(model.images[1].mimeType, "image/webp");
    EXPECT_THAT(model.images[1].bytes, ElementsAre(std::byte{'A'}, std::byte{'B'}, std::byte{'C'}));
    const Model::Material& material = model.materials[0];
    EXPECT_EQ(material.baseColor, glm::vec4(0.1F, 0.2F, 0.3F, 0.4F));
    EXPECT_EQ(material.metallic, 0.0F);
    EXPECT_EQ(material.roughness, 1.0F);
    EXPECT_EQ(material.baseColorImage, 0);
    EXPECT_EQ(material.normalImage, 1);
    EXPECT_EQ(material.normalScale, 0.5F);
    EXPECT_EQ(material.alphaMode, "BLEND");
    EXPECT_TRUE(material.doubleSided);
}

TEST(GltfReader, KnownRequiredExtensionsAreRead) {
    GltfBuilder builder = GltfBuilder::triangle();
    builder.document["extensionsRequired"] = {"KHR_mesh_quantization", "KHR_texture_transform", "KHR_materials_unlit"};
    const std::vector<std::int16_t> positions = {0, 0, 0, 100, 0, 0, 0, -100, 0};
    builder.primitive()["attributes"]["POSITION"] = builder.accessor(positions, "VEC3", 5122);
    EXPECT_EQ(onlyPrimitive(read(builder)).positions[2], glm::vec3(0, -100, 0));
}

TEST(GltfReader, ReadsBuffersAndPicturesBesideTheFile) {
    const support::TemporaryFolder folder;
    GltfBuilder builder = GltfBuilder::triangle();
    std::filesystem::create_directory(folder.path() / "my data");
    folder.write("my data/mesh.bin", builder.binary);
    folder.write("skin.jpg", std::string("\xFF\xD8\xFF picture"));
    builder.document["buffers"] = {{{"byteLength", builder.binary.size()}, {"uri", "my%20data/mesh.bin"}}};
    builder.document["images"] = {{{"uri", "skin.jpg"}}};
    const Model model = readModel(folder.write("shape.gltf", builder.document.dump()));
    EXPECT_EQ(onlyPrimitive(model).positions[1], glm::vec3(1, 0, 0));
    EXPECT_EQ(model.images[0].mimeType, "image/jpeg");
    EXPECT_EQ(model.images[0].bytes.size(), 11U);
    EXPECT_EQ(model.name, "shape");
}

TEST(GltfReader, ReadsBuffersInDataUris) {
    const support::TemporaryFolder folder;
    GltfBuilder builder = GltfBuilder::triangle();
    builder.document["buffers"] = {{{"byteLength", builder.binary.size()},
                                    {"uri", "data:application/octet-stream;base64," + base64(builder.binary)}}};
    const Model model = readModel(folder.write("inside.gltf", builder.document.dump()));
    EXPECT_EQ(onlyPrimitive(model).positions[2], glm::vec3(0, 1, 0));
}

} // namespace
} // namespace lumorph
