// What a glTF may lack or hold beyond the specification, and still be read.
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/gltf_files.h"
#include "core/geometry/gltf_reader.h"
#include "core/geometry/mesh_file.h"
#include "tests/support/gltf_builder.h"

namespace lumorph::gltf_extensions_test {
namespace {

using nlohmann::json;
using support::GltfBuilder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A model and what its reader says of it.
struct Told : Model {
    explicit Told(ReadModel read) : Model(std::move(read.model)), warnings(std::move(read.warnings)) {}
    std::vector<std::string> warnings;
};

Told read(const GltfBuilder& builder) { return Told(readGlbBytes(builder.glb(), "test.glb")); }
Told read(const std::filesystem::path& file) { return Told(readModelFile(file)); }

std::string refusalOf(const GltfBuilder& builder) {
    try {
        (void)read(builder);
    } catch (const DataError& error) {
        return error.what();
    }
    return "read";
}

const std::vector<glm::vec3> kTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

/// A model in a folder whose material shows a picture of this name.
struct GltfPictures : ::testing::Test {
    std::filesystem::path modelWith(const std::string& uri) {
        builder.document["buffers"] = {{{"byteLength", builder.binary.size()}, {"uri", "mesh.bin"}}};
        builder.document["images"] = {{{"uri", uri}}};
        builder.document["textures"] = {{{"source", 0}}};
        builder.document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
        builder.primitive()["material"] = 0;
        folder.write("mesh.bin", builder.binary);
        return folder.write("shape.gltf", builder.document.dump());
    }
    support::TemporaryFolder folder;
    GltfBuilder builder = GltfBuilder::triangle();
};

TEST_F(GltfPictures, ThatAreMissingLeaveTheGeometry) {
    folder.write("holz.png", std::string("\x89PNG"));
    std::filesystem::create_directory(folder.path() / "empty");
    folder.write("empty/none.png", std::string());
    const std::pair<std::string, std::string> rows[] = {
        {"stone.png", "'stone.png' is not there"},
        {"../secret.png", "leads out of the folder"},
        {"/home/ada/stone.png", "leads out of the folder"},
        {"textures\\\\stone.png", "is not there"},
        {"C:\\Users\\ada\\holz.png", "but 'holz.png' lies beside the model"},
        {"https://example.org/wood.png", "is not there"},
        {"empty/none.png", "'empty/none.png' is empty"},
        {"empty", "is not there"},
        {"data:image/png;base64,", "it is empty"},
    };
    for (const auto& [uri, why] : rows) {
        const Told model = read(modelWith(uri));
        EXPECT_EQ(model.meshes.at(0).primitives.at(0).positions, kTriangle) << uri;
        EXPECT_EQ(model.materials.at(0).baseColorImage, 0);
        EXPECT_THAT(model.images.at(0).bytes, IsEmpty()) << uri;
        EXPECT_THAT(model.warnings, ElementsAre(HasSubstr(why))) << uri;
        // Written and read again it is the same model, whose picture is still missing.
        const Told again(readGlbBytes(writeGlb(model), "again.glb"));
        EXPECT_THAT(again.warnings, ElementsAre(HasSubstr("image 0: it is empty")));
        EXPECT_TRUE(static_cast<const Model&>(again) == model) << uri;
    }
    std::vector<std::string> warnings;
    EXPECT_EQ(readMesh(folder.path() / "shape.gltf", &warnings).triangles.size(), 1U);
    EXPECT_EQ(warnings.size(), 1U);
}

TEST_F(GltfPictures, AreFoundUnderNamesThatAnotherSystemWrote) {
    std::filesystem::create_directory(folder.path() / "Textures");
    const std::string picture = "\x89PNG picture";
    folder.write("Textures/Ma\u0308rz.png", picture); // decomposed, as macOS keeps it
    folder.write("100%.png", picture);
    for (const char* uri : {"Textures/Ma%CC%88rz.png", "Textures/M\u00E4rz.png", "textures/M%C3%A4rz.PNG",
                            "Textures\\M\u00E4rz.png", "x/../Textures/M\u00E4rz.png", "100%.png", "100%25.png"}) {
        const Told model = read(modelWith(uri));
        EXPECT_THAT(model.warnings, IsEmpty()) << uri;
        EXPECT_EQ(model.images.at(0).bytes.size(), picture.size()) << uri;
    }
    // A copy beside which the files lie under the names that are told finds them as well.
    const auto names = [this](const char* uri) { return filesReferredBy(modelWith(uri)).at(1).name.string(); };
    EXPECT_EQ(names("Textures\\M\u00E4rz.png"), "Textures/M\u00E4rz.png");
    EXPECT_EQ(names("x/../textures/M%C3%A4rz.PNG"), "textures/M\u00E4rz.PNG");
    EXPECT_FALSE(filesReferredBy(modelWith("textures/m\u00E4rz.png")).at(1).missing);
    EXPECT_TRUE(filesReferredBy(modelWith("textures/april.png")).at(1).missing);
}

TEST_F(GltfPictures, DataThatIsMissingIsRefusedAndNamed) {
    (void)modelWith("stone.png");
    folder.write("mesh.bin", builder.binary);
    builder.document["buffers"][0]["uri"] = "D:\\export\\mesh.bin";
    builder.document.erase("images");
    builder.document.erase("textures");
    builder.document.erase("materials");
    builder.primitive().erase("material");
    try {
        (void)readModel(folder.write("shape.gltf", builder.document.dump()));
        ADD_FAILURE() << "was read";
    } catch (const DataError& error) {
        EXPECT_THAT(error.why(), HasSubstr("buffer 0"));
        EXPECT_THAT(error.why(), HasSubstr("but 'mesh.bin' lies beside the model"));
    }
    builder.document["buffers"][0]["uri"] = "MESH.bin";
    EXPECT_EQ(readModel(folder.write("shape.gltf", builder.document.dump())).meshes.size(), 1U);
}

TEST_F(GltfPictures, JsonInUtf16IsRead) {
    const std::filesystem::path plain = modelWith("stone.png");
    const std::string text = builder.document.dump();
    std::string wide = "\xFF\xFE";
    for (const char c : text) (wide += c) += '\0';
    Model model = readModel(folder.write("wide.gltf", wide));
    model.name = "shape";
    EXPECT_TRUE(model == readModel(plain));
    EXPECT_TRUE(readModel(folder.write("marked.gltf", "\xEF\xBB\xBF" + text)).meshes == model.meshes);
}

TEST(GltfExtensions, ThatOnlyLooksNeedLeaveTheGeometry) {
    for (const char* name : {"KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif", "MSFT_texture_dds"}) {
        GltfBuilder builder = GltfBuilder::triangle();
        const std::string bytes = "picture";
        builder.document["images"] = {
            {{"bufferView", builder.view(bytes.data(), bytes.size())}, {"mimeType", "image/ktx2"}}};
        builder.document["textures"] = {{{"extensions", {{name, {{"source", 0}}}}}}};
        builder.document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
        builder.primitive()["material"] = 0;
        builder.document["extensionsUsed"] = {name};
        const Told model = read(builder);
        EXPECT_EQ(model.meshes.at(0).primitives.at(0).positions, kTriangle);
        EXPECT_EQ(model.materials.at(0).baseColorImage, 0) << "a placeholder can stand for it";
        EXPECT_THAT(model.warnings, ElementsAre(HasSubstr(name)));
        builder.document["extensionsRequired"] = {name};
        EXPECT_EQ(read(builder).warnings.size(), 2U);
        builder.document["textures"][0]["extensions"][name]["source"] = 3;
        EXPECT_THAT(refusalOf(builder), HasSubstr("there is no image 3"));
        builder.document["textures"][0]["extensions"][name]["source"] = "0";
        EXPECT_THAT(refusalOf(builder), HasSubstr("is not a whole number"));
    }
    for (const char* name : {"FB_ngon_encoding", "KHR_animation_pointer", "KHR_node_visibility", "KHR_materials_sheen",
                             "EXT_structural_metadata", "EXT_mesh_gpu_instancing"}) {
        GltfBuilder builder = GltfBuilder::triangle();
        builder.document["extensionsRequired"] = {name};
        EXPECT_THAT(read(builder).warnings, IsEmpty()) << name;
    }
    for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "ACME_voxels"}) {
        GltfBuilder builder = GltfBuilder::triangle();
        builder.document["extensionsRequired"] = {name};
        EXPECT_THAT(refusalOf(builder), HasSubstr(std::string("needs the extension ") + name));
    }
}

TEST(GltfExtensions, CompressionThatIsOptionalIsReadFromItsOtherCopy) {
    GltfBuilder builder = GltfBuilder::triangle();
    builder.document["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    builder.primitive()["extensions"] = {{"KHR_draco_mesh_compression", {{"bufferView", 0}}}};
    EXPECT_EQ(read(builder).meshes.at(0).primitives.at(0).positions, kTriangle);
    builder.document["accessors"][0].erase("bufferView");
    EXPECT_THAT(refusalOf(builder), HasSubstr("mesh 0 primitive 0: is compressed (KHR_draco_mesh_compression)"));

    GltfBuilder packed = GltfBuilder::triangle();
    packed.document["buffers"] = {
        {{"byteLength", packed.binary.size()}},
        {{"byteLength", 36}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    EXPECT_THAT(refusalOf(packed), HasSubstr("buffer 1: is compressed (EXT_meshopt_compression)"));
}

json instancing(GltfBuilder& b, const std::vector<float>& places, const std::vector<float>& turns = {},
                const std::vector<float>& scales = {}) {
    json attributes = json::object();
    if (!places.empty()) attributes["TRANSLATION"] = b.floats(places, "VEC3");
    if (!turns.empty()) attributes["ROTATION"] = b.floats(turns, "VEC4");
    if (!scales.empty()) attributes["SCALE"] = b.floats(scales, "VEC3");
    return {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}};
}

TEST(GltfInstancing, EachCopyStandsInTheFrameOfItsNode) {
    GltfBuilder builder = GltfBuilder::triangle();
    const float half = std::sqrt(0.5F);
    builder.document["nodes"][0]["translation"] = {10, 0, 0};
    builder.document["nodes"][0]["extensions"] =
        instancing(builder, {0, 0, 0, 0, 5, 0}, {0, 0, 0, 1, 0, 0, half, half}, {1, 1, 1, 2, 2, 2});
    const Told model = read(builder);
    const TriangleMesh mesh = flatten(model);
    ASSERT_EQ(mesh.positions.size(), 6U);
    // The second is turned by 90 degrees about z, twice as large and 5 above.
    const glm::vec3 expected[] = {{10, 0, 0}, {11, 0, 0}, {10, 1, 0}, {10, 5, 0}, {10, 7, 0}, {8, 5, 0}};
    for (std::size_t v = 0; v < 6; ++v) EXPECT_LT(glm::distance(mesh.positions[v], expected[v]), 1e-5F) << v;
    EXPECT_EQ(model.nodes.size(), 3U);
    EXPECT_EQ(model.meshes.size(), 1U) << "shared";
    EXPECT_TRUE(readGlb(writeGlb(model), "again").nodes == model.nodes);
}

TEST(GltfInstancing, CopiesOfALongNameAreCountedBeforeTheyAreMade) {
    GltfBuilder builder = GltfBuilder::triangle();
    builder.document["nodes"][0]["name"] = std::string(std::size_t{1} << 20U, 'n');
    const std::size_t places = builder.document["accessors"].size();
    builder.document["accessors"].push_back({{"componentType", 5126}, {"count", 90000}, {"type", "VEC3"}}); // zeros
    builder.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", places}};
    EXPECT_THAT(refusalOf(builder), HasSubstr("node 0"));
}

TEST(GltfInstancing, IsRefusedWhereItContradictsItself) {
    GltfBuilder builder = GltfBuilder::triangle();
    builder.document["nodes"][0]["extensions"] = instancing(builder, {0, 0, 0, 1, 1, 1}, {}, {1, 1, 1});
    EXPECT_THAT(refusalOf(builder), HasSubstr("attributes differ in number"));
    builder.document["nodes"][0]["extensions"] = instancing(builder, {0, 0, 0}, {0, 0, 0, 0});
    EXPECT_THAT(refusalOf(builder), HasSubstr("ROTATION: is zero"));
    builder.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", -1}};
    EXPECT_THAT(refusalOf(builder), HasSubstr("is not a whole number"));
    builder.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", 77}};
    EXPECT_THAT(refusalOf(builder), HasSubstr("no accessor 77"));
    for (const json& odd : {json(3), json(), json("x"), json::array(), json({{"attributes", 4}})}) {
        builder.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = odd;
        EXPECT_EQ(flatten(read(builder)).triangles.size(), 1U) << odd;
    }
}

/// One channel that moves the node's morph weights or, by a pointer, whatever the pointer says.
void animate(GltfBuilder& b, const json& target, const std::vector<float>& values, const char* type) {
    const int input = b.floats({0, 1}, "SCALAR");
    const int output = b.floats(values, type);
    b.document["animations"] = {
        {{"channels", {{{"sampler", 0}, {"target", target}}}}, {"samplers", {{{"input", input}, {"output", output}}}}}};
}

TEST(GltfInstancing, ShapesThatChangeAreShownOnceAndSaid) {
    GltfBuilder builder = GltfBuilder::triangle();
    builder.primitive()["targets"] = {{{"POSITION", builder.floats({0, 0, 0, 0, 0, 0, 0, 0, 5}, "VEC3")}}};
    animate(builder, {{"node", 0}, {"path", "weights"}}, {0, 1}, "SCALAR");
    builder.document["nodes"][0]["extensions"] = instancing(builder, {0, 0, 1, 0, 0, 2});
    const Told model = read(builder);
    EXPECT_THAT(model.warnings, ElementsAre(HasSubstr("change their shape")));
    EXPECT_EQ(flatten(model, model.animations.at(0), 1.0).positions,
              (std::vector<glm::vec3>{{0, 0, 1}, {1, 0, 1}, {0, 1, 6}}));
}

json pointer(const std::string& to) {
    return {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", to}}}}}};
}

TEST(GltfAnimationPointer, ThatMovesANodeIsItsChannel) {
    GltfBuilder builder = GltfBuilder::triangle();
    animate(builder, pointer("/nodes/0/translation"), {0, 0, 0, 0, 4, 0}, "VEC3");
    const Told model = read(builder);
    EXPECT_THAT(model.warnings, IsEmpty());
    EXPECT_EQ(flatten(model, model.animations.at(0), 0.5).positions.at(0), glm::vec3(0, 2, 0));
    for (const char* other :
         {"/materials/0/alphaCutoff", "/nodes/0/extensions/KHR_node_visibility/visible", "/nodes/x/scale",
          "/nodes//scale", "/nodes/0", "", "/nodes/99999999999999999999/scale", "/nodes/-1/scale"}) {
        GltfBuilder looks = GltfBuilder::triangle();
        animate(looks, pointer(other), {0, 1}, "SCALAR");
        const Told still = read(looks);
        EXPECT_THAT(still.animations.at(0).channels, IsEmpty()) << other;
        EXPECT_THAT(still.warnings, ElementsAre(HasSubstr("1 channel of its animations"))) << other;
    }
    GltfBuilder missing = GltfBuilder::triangle();
    animate(missing, pointer("/nodes/7/translation"), {0, 0, 0, 0, 4, 0}, "VEC3");
    EXPECT_THAT(refusalOf(missing), HasSubstr("there is no node 7"));
}

TEST(GltfVisibility, WhatIsHiddenIsLeftOutWithWhatHangsFromIt) {
    GltfBuilder builder = GltfBuilder::triangle();
    const json hidden = {{"KHR_node_visibility", {{"visible", false}}}};
    builder.document["nodes"] = {{{"mesh", 0}},
                                 {{"mesh", 0}, {"extensions", hidden}, {"children", {2}}},
                                 {{"mesh", 0}},
                                 {{"mesh", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}}};
    builder.document["scenes"][0]["nodes"] = {0, 1, 3};
    const Told model = read(builder);
    EXPECT_EQ(flatten(model).triangles.size(), 2U);
    EXPECT_EQ(model.nodes.size(), 4U) << "nodes stay, as joints and parents";
    EXPECT_THAT(model.warnings, ElementsAre(HasSubstr("2 meshes are hidden")));

    GltfBuilder all = GltfBuilder::triangle();
    all.primitive()["targets"] = {{{"POSITION", 0}}};
    animate(all, {{"node", 0}, {"path", "weights"}}, {0, 1}, "SCALAR");
    all.document["nodes"][0]["extensions"] = hidden;
    EXPECT_EQ(flatten(read(all)).triangles.size(), 0U);
    const support::TemporaryFolder folder;
    try {
        (void)readMesh(folder.write("hidden.glb", all.glb()));
        ADD_FAILURE() << "was read";
    } catch (const DataError& error) {
        EXPECT_THAT(error.why(), HasSubstr("holds no mesh (1 mesh is hidden"));
    }
}

/// `meshes` triangles, each of three vertices in one list of `vertices`.
GltfBuilder crowd(std::size_t meshes, std::size_t vertices, bool ownAccessors) {
    GltfBuilder builder;
    std::vector<float> positions(3 * vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
        positions[3 * v] = static_cast<float>(v);
        positions[3 * v + 1] = static_cast<float>(v * v % 17);
    }
    const int all = builder.floats(positions, "VEC3");
    std::vector<float> texcoords(2 * vertices);
    for (std::size_t v = 0; v < vertices; ++v) texcoords[2 * v] = static_cast<float>(v);
    const int looks = builder.floats(texcoords, "VEC2");
    builder.document["meshes"] = json::array();
    builder.document["nodes"] = json::array();
    json roots = json::array();
    for (std::size_t m = 0; m < meshes; ++m) {
        const auto first = static_cast<std::uint32_t>(3 * m);
        const int indices = builder.accessor(std::vector<std::uint32_t>{first + 2, first, first + 1}, "SCALAR", 5125);
        int mine = all;
        if (ownAccessors) {
            builder.document["accessors"].push_back(builder.document["accessors"][static_cast<std::size_t>(all)]);
            mine = static_cast<int>(builder.document["accessors"].size()) - 1;
        }
        builder.document["meshes"].push_back(
            {{"primitives", {{{"attributes", {{"POSITION", mine}, {"TEXCOORD_0", looks}}}, {"indices", indices}}}}});
        builder.document["nodes"].push_back({{"mesh", m}});
        roots.push_back(m);
    }
    builder.document["scenes"][0]["nodes"] = roots;
    return builder;
}

TEST(GltfCrowdedBuffers, EachMeshTakesItsOwnVertices) {
    for (const bool ownAccessors : {false, true}) {
        // 300 times 60,000 vertices would be 216 MB of positions and as much again; the file has 1.2 MB.
        const Told model = read(crowd(300, 60'000, ownAccessors));
        ASSERT_EQ(model.meshes.size(), 300U);
        for (const std::size_t m : {std::size_t{0}, std::size_t{7}, std::size_t{299}}) {
            const Model::Primitive& primitive = model.meshes[m].primitives.at(0);
            ASSERT_EQ(primitive.positions.size(), 3U);
            EXPECT_THAT(primitive.triangles, ElementsAre(glm::uvec3(2, 0, 1)));
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t v = 3 * m + k;
                EXPECT_EQ(primitive.positions[k],
                          glm::vec3(static_cast<float>(v), static_cast<float>(v * v % 17), 0.0F));
                EXPECT_EQ(primitive.texcoords[k], glm::vec2(static_cast<float>(v), 0.0F));
            }
        }
    }
}

TEST(GltfCrowdedBuffers, MeshesOfTheirOwnKeepEveryVertex) {
    GltfBuilder builder = GltfBuilder::triangle();
    builder.primitive()["attributes"]["POSITION"] = builder.floats(std::vector<float>(30, 1.0F), "VEC3");
    EXPECT_EQ(read(builder).meshes.at(0).primitives.at(0).positions.size(), 10U) << "7 of them in no triangle";
}

TEST(GltfCrowdedBuffers, SparseVerticesAndWrongIndicesAreStillChecked) {
    GltfBuilder builder = crowd(3, 9, false);
    const std::uint8_t index = 4;
    const float value[3] = {-1, -2, -3};
    const int indices = builder.view(&index, 1);
    const int values = builder.view(value, sizeof value);
    builder.document["accessors"][0]["sparse"] = {{"count", 1},
                                                  {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                                  {"values", {{"bufferView", values}}}};
    EXPECT_EQ(read(builder).meshes.at(1).primitives.at(0).positions.at(1), glm::vec3(-1, -2, -3));
    const int beyond = builder.accessor(std::vector<std::uint32_t>{0, 1, 9}, "SCALAR", 5125);
    builder.document["meshes"][2]["primitives"][0]["indices"] = beyond;
    EXPECT_THAT(refusalOf(builder), HasSubstr("index 9 at 2 is out of range, there are 9 vertices"));
}

} // namespace
} // namespace lumorph::gltf_extensions_test
