#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/model.h"
#include "tests/support/full_model.h"

namespace lumorph {
namespace {

using nlohmann::json;
using support::fullModel;

std::uint32_t wordAt(const std::vector<std::byte>& bytes, std::size_t offset) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, sizeof(word));
    return word;
}

json jsonOf(const std::vector<std::byte>& glb) {
    const auto* text = reinterpret_cast<const char*>(glb.data()) + 20;
    return json::parse(text, text + wordAt(glb, 12));
}

TEST(GltfWriter, ReadingBackGivesTheSameModel) {
    const Model model = fullModel();
    const Model read = readGlb(writeGlb(model), "full.glb");
    EXPECT_EQ(read.name, model.name);
    EXPECT_EQ(read.nodes, model.nodes);
    EXPECT_EQ(read.meshes, model.meshes);
    EXPECT_EQ(read.skins, model.skins);
    EXPECT_EQ(read.animations, model.animations);
    EXPECT_EQ(read.materials, model.materials);
    EXPECT_EQ(read.images, model.images);
    EXPECT_EQ(read.extras, model.extras);
    EXPECT_EQ(read, model);
}

TEST(GltfWriter, ModelOfAMeshKeepsItsPointsAndTriangles) {
    const TriangleMesh mesh{{{0, 0, 0}, {1.0F / 3.0F, 0, 0}, {0, 1e-30F, 0}, {0, 0, 1e30F}}, {{0, 2, 1}, {0, 3, 2}}};
    const TriangleMesh read = flatten(readGlb(writeGlb(modelOf(mesh, "thing")), "thing.glb"));
    EXPECT_EQ(read.positions, mesh.positions);
    EXPECT_EQ(read.triangles, mesh.triangles);
}

TEST(GltfWriter, ChunksAreAlignedAndLengthsAgree) {
    const std::vector<std::byte> glb = writeGlb(fullModel());
    const std::size_t jsonBytes = wordAt(glb, 12);
    EXPECT_EQ(wordAt(glb, 0), 0x46546C67U);
    EXPECT_EQ(wordAt(glb, 4), 2U);
    EXPECT_EQ(wordAt(glb, 8), glb.size());
    EXPECT_EQ(jsonBytes % 4, 0U);
    EXPECT_EQ(wordAt(glb, 16), 0x4E4F534AU);
    EXPECT_EQ(wordAt(glb, 24 + jsonBytes), 0x004E4942U);
    EXPECT_EQ(28 + jsonBytes + wordAt(glb, 20 + jsonBytes), glb.size());
    const json document = jsonOf(glb);
    for (const json& view : document["bufferViews"]) EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0U);
}

TEST(GltfWriter, PositionsAndTimesCarryTheirRange) {
    const json document = jsonOf(writeGlb(fullModel()));
    const json& positions =
        document["accessors"][document["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<std::size_t>()];
    EXPECT_EQ(positions["min"].get<std::vector<float>>(), (std::vector<float>{0, 0, 0}));
    EXPECT_EQ(positions["max"].get<std::vector<float>>(), (std::vector<float>{1, 2, 0.1F}));
    const json& times = document["accessors"][document["animations"][0]["samplers"][1]["input"].get<std::size_t>()];
    EXPECT_EQ(times["min"].get<std::vector<float>>(), std::vector<float>{0.5F});
    EXPECT_EQ(times["max"].get<std::vector<float>>(), std::vector<float>{2.0F});
    EXPECT_EQ(document["meshes"][0]["extras"]["targetNames"], json({"bulge", "shift"}));
}

TEST(GltfWriter, OneTextureServesAllUsesOfAPicture) {
    const json document = jsonOf(writeGlb(fullModel()));
    ASSERT_EQ(document["textures"].size(), 2U);
    const json& wood = document["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"];
    EXPECT_EQ(wood, document["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"]);
}

struct Contradiction {
    const char* name;
    void (*make)(Model&);
    const char* why;
};

class GltfWriterContradictions : public ::testing::TestWithParam<Contradiction> {};

TEST_P(GltfWriterContradictions, AreRefused) {
    Model model = fullModel();
    GetParam().make(model);
    try {
        (void)writeGlb(model);
        FAIL() << "was written";
    } catch (const InvalidInput& error) {
        EXPECT_EQ(error.subject(), "stage");
        EXPECT_THAT(error.why(), ::testing::HasSubstr(GetParam().why));
    }
}

INSTANTIATE_TEST_SUITE_P(
    Table, GltfWriterContradictions,
    ::testing::Values(
        Contradiction{"Roots", [](Model& m) { m.roots.clear(); }, "no nodes"},
        Contradiction{"Normals", [](Model& m) { m.meshes[0].primitives[0].normals.pop_back(); }, "mesh 0: normals"},
        Contradiction{"Weights", [](Model& m) { m.meshes[0].primitives[0].weights.clear(); },
                      "mesh 0: joints, weights"},
        Contradiction{"Morph", [](Model& m) { m.meshes[0].primitives[0].morphTargets[1].pop_back(); },
                      "mesh 0: a morph target"},
        Contradiction{"Custom",
                      [](Model& m) {
                          m.meshes[0].primitives[0].custom["_X"] = {3, {1, 2}};
                      },
                      "a custom attribute"},
        Contradiction{"Name",
                      [](Model& m) {
                          m.meshes[0].primitives[0].custom["X"] = {1, {1, 2, 3, 4}};
                      },
                      "underscore"},
        Contradiction{"Triangle", [](Model& m) { m.meshes[1].primitives[0].triangles[0].y = 3; }, "mesh 1: a triangle"},
        Contradiction{"Empty", [](Model& m) { m.meshes[1].primitives[0].triangles.clear(); },
                      "mesh 1: has no triangles"},
        Contradiction{"Material", [](Model& m) { m.meshes[0].primitives[0].material = 2; }, "no material 2"},
        Contradiction{"Mesh", [](Model& m) { m.nodes[3].mesh = 9; }, "node 3: there is no mesh 9"},
        Contradiction{"Image", [](Model& m) { m.materials[0].emissiveImage = 2; }, "no image 2"},
        Contradiction{"Joints", [](Model& m) { m.skins[0].joints.pop_back(); }, "skin 0"},
        Contradiction{"Keys", [](Model& m) { m.animations[0].channels[0].times.clear(); }, "animation 0"}),
    [](const auto& row) { return row.param.name; });

} // namespace
} // namespace lumorph
