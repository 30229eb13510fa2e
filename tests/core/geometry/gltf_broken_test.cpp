#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/model.h"
#include "tests/support/gltf_builder.h"

namespace lumorph {
namespace {

using nlohmann::json;
using support::GltfBuilder;
using support::packGlb;
using ::testing::HasSubstr;

void expectRefused(const std::function<void()>& read, const std::string& file, const std::string& why) {
    try {
        read();
        ADD_FAILURE() << "was read";
    } catch (const DataError& error) {
        EXPECT_THAT(error.subject(), HasSubstr(file));
        EXPECT_THAT(error.why(), HasSubstr(why));
        EXPECT_GT(error.remedy().size(), 10U);
    }
}

/// A well-formed container whose document or buffer is broken.
struct BrokenDocument {
    const char* name;
    void (*damage)(GltfBuilder&);
    const char* why;
};

class GltfReaderBrokenDocuments : public ::testing::TestWithParam<BrokenDocument> {};

TEST_P(GltfReaderBrokenDocuments, AreRefusedWithPlaceAndRemedy) {
    GltfBuilder builder = GltfBuilder::triangle();
    ASSERT_NO_THROW((void)readGlb(builder.glb(), "broken.glb"));
    GetParam().damage(builder);
    const std::vector<std::byte> glb = builder.glb();
    expectRefused([&] { (void)readGlb(glb, "broken.glb"); }, "broken.glb", GetParam().why);
}

void addJoints(GltfBuilder& b, std::uint8_t joint, float weight) {
    b.document["skins"] = {{{"joints", {0}}}};
    b.document["nodes"][0]["skin"] = 0;
    b.primitive()["attributes"]["JOINTS_0"] = b.accessor(std::vector<std::uint8_t>(12, joint), "VEC4", 5121);
    b.primitive()["attributes"]["WEIGHTS_0"] = b.floats(std::vector<float>(12, weight), "VEC4");
}

void addAnimation(GltfBuilder& b, std::vector<float> times, std::vector<float> values,
                  const char* path = "translation") {
    const int input = b.floats(times, "SCALAR");
    const int output = b.floats(values, "VEC3");
    b.document["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}},
                                 {"samplers", {{{"input", input}, {"output", output}}}}}};
}

void addSparse(GltfBuilder& b, std::uint8_t index, int offset) {
    const float value[3] = {1, 2, 3};
    const int indices = b.view(&index, 1);
    const int values = b.view(value, sizeof(value));
    b.document["accessors"][0]["sparse"] = {{"count", 1},
                                            {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                            {"values", {{"bufferView", values}, {"byteOffset", offset}}}};
}

const BrokenDocument kBroken[] = {
    {"NoVersion", [](GltfBuilder& b) { b.document.erase("asset"); }, "names no glTF version"},
    {"OldVersion", [](GltfBuilder& b) { b.document["asset"]["version"] = "1.0"; }, "version 1.0"},
    {"Draco", [](GltfBuilder& b) { b.document["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
     "KHR_draco_mesh_compression"},
    {"EmptyScene", [](GltfBuilder& b) { b.document["scenes"][0]["nodes"] = json::array(); }, "scene is empty"},
    {"NoNodes", [](GltfBuilder& b) { b.document["nodes"] = json::array(); }, "scene is empty"},
    {"SceneMissing", [](GltfBuilder& b) { b.document["scene"] = 3; }, "no scene 3"},
    {"RootMissing", [](GltfBuilder& b) { b.document["scenes"][0]["nodes"] = {7}; }, "scene 0: there is no node 7"},
    {"RootTwice",
     [](GltfBuilder& b) {
         b.document["scenes"][0]["nodes"] = {0, 0};
     },
     "listed twice"},
    {"ChildMissing", [](GltfBuilder& b) { b.document["nodes"][0]["children"] = {5}; }, "node 0: there is no child 5"},
    {"OwnChild", [](GltfBuilder& b) { b.document["nodes"][0]["children"] = {0}; }, "its own ancestor"},
    {"Cycle",
     [](GltfBuilder& b) {
         b.document["nodes"] = {{{"mesh", 0}}, {{"children", {2}}}, {{"children", {1}}}};
     },
     "node 1: is its own ancestor"},
    {"TwoParents",
     [](GltfBuilder& b) {
         b.document["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}};
     },
     "node 2: is the child of two nodes"},
    {"MeshMissing", [](GltfBuilder& b) { b.document["nodes"][0]["mesh"] = 1; }, "node 0: there is no mesh 1"},
    {"MeshIsText", [](GltfBuilder& b) { b.document["nodes"][0]["mesh"] = "0"; }, "node 0: \"mesh\""},
    {"MeshHuge", [](GltfBuilder& b) { b.document["nodes"][0]["mesh"] = 4294967296ULL; }, "node 0: \"mesh\""},
    {"SkinMissing", [](GltfBuilder& b) { b.document["nodes"][0]["skin"] = 0; }, "node 0: there is no skin 0"},
    {"ShortMatrix",
     [](GltfBuilder& b) {
         b.document["nodes"][0]["matrix"] = {1, 2, 3};
     },
     "node 0 matrix"},
    {"ZeroRotation",
     [](GltfBuilder& b) {
         b.document["nodes"][0]["rotation"] = {0, 0, 0, 0};
     },
     "node 0 rotation"},
    {"HugeTranslation",
     [](GltfBuilder& b) {
         b.document["nodes"][0]["translation"] = {1e300, 0, 0};
     },
     "beyond the range"},
    {"NodeWeights", [](GltfBuilder& b) { b.document["nodes"][0]["weights"] = {1}; }, "node 0 weights"},
    {"NoAttributes", [](GltfBuilder& b) { b.primitive().erase("attributes"); },
     "mesh 0: a primitive names no attributes"},
    {"AccessorMissing", [](GltfBuilder& b) { b.primitive()["attributes"]["POSITION"] = 9; }, "no accessor 9"},
    {"AccessorNegative", [](GltfBuilder& b) { b.primitive()["attributes"]["POSITION"] = -1; }, "no accessor -1"},
    {"AccessorType", [](GltfBuilder& b) { b.document["accessors"][0]["type"] = "VEC4"; }, "(accessor 0)"},
    {"AccessorEmpty", [](GltfBuilder& b) { b.document["accessors"][0]["count"] = 0; }, "is empty"},
    {"AccessorTooLong", [](GltfBuilder& b) { b.document["accessors"][0]["count"] = 4; },
     "reaches beyond its buffer view"},
    {"AccessorOverflow", [](GltfBuilder& b) { b.document["accessors"][0]["count"] = 2147483647; }, "more memory"},
    {"AccessorWide", [](GltfBuilder& b) { b.document["accessors"][0]["count"] = 18446744073709551615ULL; },
     "\"count\""},
    {"ZerosWithoutEnd",
     [](GltfBuilder& b) {
         b.document["accessors"][0]["count"] = 2000000000;
         b.document["accessors"][0].erase("bufferView");
     },
     "more memory"},
    {"AccessorOffset", [](GltfBuilder& b) { b.document["accessors"][0]["byteOffset"] = 4294967295ULL; },
     "reaches beyond"},
    {"AccessorDouble", [](GltfBuilder& b) { b.document["accessors"][0]["componentType"] = 5130; },
     "component type 5130"},
    {"ViewMissing", [](GltfBuilder& b) { b.document["accessors"][0]["bufferView"] = 6; }, "no buffer view 6"},
    {"ViewTooLong", [](GltfBuilder& b) { b.document["bufferViews"][0]["byteLength"] = 4000; },
     "buffer view 0 reaches beyond"},
    {"ViewOffset", [](GltfBuilder& b) { b.document["bufferViews"][0]["byteOffset"] = 4294967290ULL; },
     "reaches beyond"},
    {"ViewStride", [](GltfBuilder& b) { b.document["bufferViews"][0]["byteStride"] = 4; }, "overlap"},
    {"BufferMissing", [](GltfBuilder& b) { b.document["bufferViews"][0]["buffer"] = 1; }, "no buffer 1"},
    {"BufferTooLong",
     [](GltfBuilder& b) {
         b.document["buffers"] = {{{"byteLength", 5000}}};
     },
     "buffer 0"},
    {"BufferWithoutData",
     [](GltfBuilder& b) {
         b.document["buffers"] = {{{"byteLength", 4}}, {{"byteLength", 4}}};
     },
     "buffer 1: has no data"},
    {"BufferOutside",
     [](GltfBuilder& b) {
         b.document["buffers"] = {{{"byteLength", 4}, {"uri", "passwd"}}};
     },
     "outside the file"},
    {"BufferNotBase64",
     [](GltfBuilder& b) {
         b.document["buffers"] = {{{"byteLength", 4}, {"uri", "data:;base64,*"}}};
     },
     "buffer 0: its data URI is not base64"},
    {"IndexOutOfRange",
     [](GltfBuilder& b) {
         b.primitive()["indices"] = b.accessor(std::vector<std::uint8_t>{0, 1, 3}, "SCALAR", 5121);
     },
     "index 3 at 2 is out of range"},
    {"IndexFloat",
     [](GltfBuilder& b) {
         b.primitive()["indices"] = b.floats({0, 1, 2}, "SCALAR");
     },
     "component type 5126"},
    {"IndexPartTriangle",
     [](GltfBuilder& b) {
         b.primitive()["indices"] = b.accessor(std::vector<std::uint8_t>{0, 1, 2, 0}, "SCALAR", 5121);
     },
     "not whole triangles"},
    {"NotANumber",
     [](GltfBuilder& b) {
         const float nan = std::numeric_limits<float>::quiet_NaN();
         b.primitive()["attributes"]["POSITION"] = b.floats({0, 0, 0, 1, nan, 0, 0, 1, 0}, "VEC3");
     },
     "element 1 is not a finite number"},
    {"NormalsShort",
     [](GltfBuilder& b) {
         b.primitive()["attributes"]["NORMAL"] = b.floats({0, 0, 1}, "VEC3");
     },
     "NORMAL: is for 1 vertices, not 3"},
    {"MorphShort",
     [](GltfBuilder& b) {
         b.primitive()["targets"] = {{{"POSITION", b.floats({0, 0, 1}, "VEC3")}}};
     },
     "morph target 0: is for 1 vertices"},
    {"MaterialMissing", [](GltfBuilder& b) { b.primitive()["material"] = 0; }, "no material 0"},
    {"TextureMissing",
     [](GltfBuilder& b) {
         b.document["materials"] = {{{"emissiveTexture", {{"index", 4}}}}};
     },
     "material 0: there is no texture 4"},
    {"ImageRange",
     [](GltfBuilder& b) {
         b.document["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 4000000000ULL}, {"byteLength", 8}});
         b.document["images"] = {{{"bufferView", 2}}};
     },
     "image 0: buffer view 2"},
    {"JointMissing", [](GltfBuilder& b) { addJoints(b, 1, 0.25F); }, "names a joint beyond the 1 of skin 0"},
    {"WeightNegative", [](GltfBuilder& b) { addJoints(b, 0, -1.0F); }, "a weight is negative"},
    {"JointsAlone",
     [](GltfBuilder& b) {
         addJoints(b, 0, 1.0F);
         b.primitive()["attributes"].erase("WEIGHTS_0");
     },
     "joints or weights"},
    {"SkinWithoutJoints",
     [](GltfBuilder& b) {
         b.document["skins"] = {{{"joints", json::array()}}};
     },
     "skin 0: has no joints"},
    {"SkinNode",
     [](GltfBuilder& b) {
         b.document["skins"] = {{{"joints", {8}}}};
     },
     "skin 0: there is no node 8"},
    {"KeysShort",
     [](GltfBuilder& b) {
         addAnimation(b, {0, 1}, {1, 2, 3});
     },
     "has 3 numbers for 2 keys"},
    {"KeysBackwards",
     [](GltfBuilder& b) {
         addAnimation(b, {1, 0}, {1, 2, 3, 4, 5, 6});
     },
     "not ascending"},
    {"PathUnknown",
     [](GltfBuilder& b) {
         addAnimation(b, {0}, {1, 2, 3}, "colour");
     },
     "\"colour\""},
    {"SparseIndex", [](GltfBuilder& b) { addSparse(b, 3, 0); }, "3 is out of range"},
    {"SparseOffset", [](GltfBuilder& b) { addSparse(b, 0, 4); }, "sparse values: reaches beyond"},
    {"TooManyTriangles",
     [](GltfBuilder& b) {
         // 500 nodes that show one mesh of 40,000 triangles
         b.primitive()["indices"] = b.accessor(std::vector<std::uint8_t>(120000, 0), "SCALAR", 5121);
         for (int i = 1; i < 500; ++i) b.document["nodes"].push_back({{"mesh", 0}});
     },
     "more than 10000000 triangles"},
    {"TooManyValues", [](GltfBuilder& b) { b.document["extras"] = std::vector<int>(1000001, 0); }, "JSON values"},
    {"TooManyNodes", [](GltfBuilder& b) { b.document["nodes"] = std::vector<json>(100001, json::object()); },
     "more than 100000 nodes"},
};

INSTANTIATE_TEST_SUITE_P(Table, GltfReaderBrokenDocuments, ::testing::ValuesIn(kBroken),
                         [](const auto& row) { return row.param.name; });

/// A broken container.
struct BrokenBytes {
    const char* name;
    std::function<std::vector<std::byte>()> make;
    const char* why;
};

class GltfReaderBrokenContainers : public ::testing::TestWithParam<BrokenBytes> {};

TEST_P(GltfReaderBrokenContainers, AreRefused) {
    const std::vector<std::byte> bytes = GetParam().make();
    expectRefused([&] { (void)readGlb(bytes, "torn.glb"); }, "torn.glb", GetParam().why);
}

std::vector<std::byte> changed(std::size_t offset, std::uint8_t value) {
    std::vector<std::byte> glb = GltfBuilder::triangle().glb();
    for (std::size_t i = 0; i < 4; ++i) glb[offset + i] = static_cast<std::byte>(value);
    return glb;
}

std::string nested(std::size_t levels) {
    return R"({"asset":{"version":"2.0","extras":)" + std::string(levels, '[') + std::string(levels, ']') + "}}";
}

INSTANTIATE_TEST_SUITE_P(
    Table, GltfReaderBrokenContainers,
    ::testing::Values(BrokenBytes{"Nothing", [] { return std::vector<std::byte>(); }, "does not begin"},
                      BrokenBytes{"WrongMagic", [] { return changed(0, 'x'); }, "does not begin"},
                      BrokenBytes{"WrongVersion", [] { return changed(4, 1); }, "GLB version"},
                      BrokenBytes{"HostileLength", [] { return changed(8, 0xFF); }, "4294967295"},
                      BrokenBytes{"LengthZero", [] { return changed(8, 0); }, "header says 0"},
                      BrokenBytes{"HostileJsonLength", [] { return changed(12, 0xFF); }, "chunk 0: is longer"},
                      BrokenBytes{"WrongFirstChunk", [] { return changed(16, 0); }, "chunk 0: is not JSON"},
                      BrokenBytes{"JsonDamaged", [] { return changed(20, '#'); }, "not valid JSON at byte"},
                      BrokenBytes{"Truncated",
                                  [] {
                                      std::vector<std::byte> glb = GltfBuilder::triangle().glb();
                                      glb.resize(glb.size() - 8);
                                      return glb;
                                  },
                                  "its header says"},
                      BrokenBytes{"HeaderOnly",
                                  [] {
                                      std::vector<std::byte> glb = GltfBuilder::triangle().glb();
                                      glb.resize(15);
                                      return glb;
                                  },
                                  "ends within its header"},
                      BrokenBytes{"NotAnObject", [] { return packGlb("[1]", {}); }, "not an object"},
                      BrokenBytes{"NumberTooLarge", [] { return packGlb(R"({"a":1e999})", {}); }, "not valid JSON"},
                      BrokenBytes{"DeepExtras", [] { return packGlb(nested(100000), {}); }, "deeper than 64"},
                      BrokenBytes{"JustTooDeep", [] { return packGlb(nested(63), {}); }, "deeper than 64"},
                      BrokenBytes{"DeepEnough", [] { return packGlb(nested(62), {}); }, "scene is empty"}),
    [](const auto& row) { return row.param.name; });

TEST(GltfReaderBrokenContainers, EveryTruncationIsRefused) {
    const std::vector<std::byte> whole = GltfBuilder::triangle().glb();
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_THROW((void)readGlb(std::span(whole).first(size), "torn.glb"), DataError) << size;
}

/// A buffer that lies somewhere it must not be read from.
class GltfReaderConfinedBuffers : public ::testing::TestWithParam<std::pair<const char*, const char*>> {
protected:
    void SetUp() override {
        std::filesystem::create_directory(folder_.path() / "models");
        folder_.write("secret.bin", builder_.binary);
        std::filesystem::create_symlink("../secret.bin", folder_.path() / "models/link.bin");
        std::filesystem::create_directory_symlink("..", folder_.path() / "models/up");
        std::filesystem::create_directory(folder_.path() / "models/directory");
    }

    support::TemporaryFolder folder_;
    GltfBuilder builder_ = GltfBuilder::triangle();
};

TEST_P(GltfReaderConfinedBuffers, AreNotRead) {
    std::string uri = GetParam().first;
    if (uri == "absolute") uri = (folder_.path() / "secret.bin").string();
    builder_.document["buffers"] = {{{"byteLength", builder_.binary.size()}, {"uri", uri}}};
    const std::filesystem::path file = folder_.write("models/shape.gltf", builder_.document.dump());
    expectRefused([&] { (void)readModel(file); }, "shape.gltf", GetParam().second);
}

INSTANTIATE_TEST_SUITE_P(Table, GltfReaderConfinedBuffers,
                         ::testing::Values(std::pair{"../secret.bin", "leads out of the folder"},
                                           std::pair{"%2e%2e/secret.bin", "leads out of the folder"},
                                           std::pair{"directory/../../secret.bin", "leads out of the folder"},
                                           std::pair{"absolute", "leads out of the folder"},
                                           std::pair{"/dev/zero", "leads out of the folder"},
                                           std::pair{"link.bin", "leads out of the folder"},
                                           std::pair{"up/secret.bin", "leads out of the folder"},
                                           std::pair{"nul%00.bin", "leads out of the folder"},
                                           std::pair{"directory", "is not there"},
                                           std::pair{"missing.bin", "is not there"},
                                           std::pair{"https://example.org/mesh.bin", "is not there"}));

TEST(GltfReaderBrokenFiles, AMissingFileIsNamed) {
    expectRefused([] { (void)readModel("/nowhere/shape.glb"); }, "/nowhere/shape.glb", "is not there");
}

} // namespace
} // namespace lumorph
