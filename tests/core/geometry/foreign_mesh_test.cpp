// Meshes as other programs leave them: sound, and yet not as their formats say.
#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/mesh_file.h"
#include "core/loop/match_target.h"
#include "tests/core/geometry/sample_mesh_files.h"
#include "tests/core/temporary_folder.h"

namespace lumorph::foreign_mesh_test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct ForeignMesh : ::testing::Test {
    TriangleMesh read(const std::string& name, const std::string& content) {
        const fs::path file = folder / name;
        std::ofstream(file, std::ios::binary) << content;
        warnings.clear();
        return readMesh(file, &warnings);
    }
    std::string refusal(const std::string& name, const std::string& content) {
        try {
            (void)read(name, content);
        } catch (const DataError& error) {
            return error.what();
        }
        return "read";
    }

    TemporaryFolder folder;
    std::vector<std::string> warnings;
};

TEST_F(ForeignMesh, BinaryStlMayGoOnBehindItsTriangles) {
    const std::string stl = prismStl("binary");
    const TriangleMesh sound = read("sound.stl", stl);
    EXPECT_THAT(warnings, IsEmpty());
    for (const std::string& tail :
         {std::string("\n"), std::string("x"), std::string(49, 'x'), std::string(512, '\0'), std::string(50, '\0'),
          std::string("exported by hand, 2026\r\n"), std::string(1001, 'z')}) {
        EXPECT_EQ(read("tail.stl", stl + tail), sound) << tail.size();
        ASSERT_EQ(warnings.size(), 1U);
        EXPECT_THAT(warnings.front(),
                    HasSubstr(tail.size() == 1 ? "1 byte is" : std::to_string(tail.size()) + " bytes are"));
    }
    // Whole triangles that the head does not count are no tail, nor is more of something else than there are triangles.
    EXPECT_THAT(refusal("more.stl", stl + stl.substr(84, 50)), HasSubstr("promises 20 triangles"));
    EXPECT_THAT(refusal("other.stl", stl + std::string(9001, 'z')), HasSubstr("promises 20 triangles"));
}

std::string plyOf(const std::string& vertices, const std::string& faces) {
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 4\nproperty list uchar int vertex_indices\nend_header\n" +
           vertices + faces;
}

TEST_F(ForeignMesh, LinesOfAPlyMayHoldMoreThanItsHeadNames) {
    const std::string faces = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
    const TriangleMesh sound = read("sound.ply", plyOf("0 0 0\n3 0 0\n0 2 0\n0 0 1\n", faces));
    EXPECT_THAT(warnings, IsEmpty());
    EXPECT_NEAR(signedVolume(sound), 1.0, 1e-6);
    EXPECT_EQ(read("colours.ply", plyOf("0 0 0 255 0 0\n3 0 0 1\n0 2 0\n0 0 1 nan x\n", faces)), sound);
    EXPECT_THAT(warnings, ElementsAre(HasSubstr("3 lines hold more than the head of the file names, first line 10")));
    EXPECT_EQ(read("flags.ply", plyOf("0 0 0\n3 0 0\n0 2 0\n0 0 1\n", "3 0 2 1\n3 0 1 3 7\n3 1 2 3\n3 2 0 3\n")),
              sound);
    EXPECT_THAT(warnings, ElementsAre(HasSubstr("1 line holds more than the head of the file names, first line 15")));
    EXPECT_EQ(read("blank.ply", plyOf("0 0 0 9\n\n3 0 0 9\n  \n0 2 0 9\n0 0 1 9\n", faces + "\n\n")), sound);
    // Elements that share lines, and such that need several, are read as they stand.
    EXPECT_EQ(read("joined.ply", plyOf("0 0 0 3 0 0\n0 2 0 0 0 1\n", faces)), sound);
    EXPECT_EQ(read("broken.ply", plyOf("0 0\n0\n3 0 0\n0 2 0\n0 0 1\n", faces)), sound);
    EXPECT_THAT(warnings, IsEmpty());
    EXPECT_THAT(refusal("short.ply", plyOf("0 0 0\n3 0\n0 2 0\n0 0 1\n", faces)), HasSubstr("line 11: the line ends"));
}

std::string utf16(const std::string& ascii, bool big, bool mark = true) {
    std::string bytes = !mark ? "" : big ? "\xFE\xFF" : "\xFF\xFE";
    for (const char c : ascii) {
        if (big) bytes += '\0';
        bytes += c;
        if (!big) bytes += '\0';
    }
    return bytes;
}

TEST_F(ForeignMesh, TextInUtf16IsRead) {
    const TriangleMesh sound = read("sound.obj", prismObj());
    for (const bool big : {false, true})
        for (const bool mark : {true, false}) {
            EXPECT_EQ(read("wide.obj", utf16(prismObj(), big, mark)), sound);
            EXPECT_EQ(read("wide.off", utf16(prismOff("OFF", "", ""), big, mark)),
                      read("sound.off", prismOff("OFF", "", "")));
            EXPECT_EQ(read("wide.ply", utf16(prismPlyText(), big, mark)), read("sound.ply", prismPlyText()));
            EXPECT_EQ(read("wide.stl", utf16(prismStlText(), big, mark)), read("sound.stl", prismStlText()));
        }
    EXPECT_THAT(refusal("wide.obj", utf16("v 0 0 0\nv 1 x 0\n", false)), HasSubstr("line 2: 'x' is not a number"));
}

TEST_F(ForeignMesh, WarningsComeBeforeThoseOfTheTarget) {
    (void)read("tail.stl", prismStl("binary") + "\n");
    EXPECT_EQ(readMatchTarget(folder / "tail.stl")->warnings, warnings);
    std::ofstream(folder / "hole.ply") << plyOf("0 0 0 1\n3 0 0\n0 2 0\n0 0 1\n", "3 0 2 1\n3 0 1 3\n3 1 2 3\n0\n");
    const std::vector<std::string> both = readMatchTarget(folder / "hole.ply")->warnings;
    ASSERT_GE(both.size(), 2U);
    EXPECT_THAT(both.front(), HasSubstr("1 line holds more"));
}

/// Small inputs of ../shared/data/cases, whose right values stand in FACTS.md there.
class MeshCases : public ::testing::Test {
protected:
    static fs::path folder() { return fs::path(LUMORPH_SHARED_DIR) / "data/cases/meshes"; }
    void SetUp() override {
        if (!fs::exists(folder())) GTEST_SKIP() << "without ../shared/data/cases";
    }
    TriangleMesh read(const char* name) {
        warnings.clear();
        return readMesh(folder() / name, &warnings);
    }
    std::vector<std::string> warnings;
};

TEST_F(MeshCases, ATrailingNewlineIsPassedOver) {
    EXPECT_EQ(read("trailing-newline.stl").triangles.size(), 20U); // (1085 - 84 - 1) / 50
    EXPECT_THAT(warnings, ElementsAre(HasSubstr("1 byte is passed over")));
}

TEST_F(MeshCases, MoreNumbersOnAVertexLineArePassedOver) {
    const TriangleMesh mesh = read("vertex-more.ply");
    EXPECT_THAT(mesh.positions, ElementsAre(glm::vec3(-0.03F, 0.012F, -0.02F), glm::vec3(0.03F, 0.012F, -0.02F),
                                            glm::vec3(0.0F, 0.012F, 0.02F), glm::vec3(0.0F, 0.04F, 0.0F)));
    EXPECT_THAT(mesh.triangles,
                ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 3, 1), glm::uvec3(1, 3, 2), glm::uvec3(2, 3, 0)));
    EXPECT_THAT(warnings, ElementsAre(HasSubstr("4 lines hold more")));
}

TEST_F(MeshCases, AMissingPictureLeavesTheGeometry) {
    EXPECT_EQ(read("missing-picture.gltf").triangles.size(), 20U);
    EXPECT_THAT(warnings, ElementsAre(HasSubstr("holz.png' is not there")));
}

TEST_F(MeshCases, AThousandMeshesThatShareABufferAreRead) {
    const TriangleMesh mesh = read("s50000-1000.gltf");
    EXPECT_EQ(mesh.triangles.size(), 4000U) << "12 corners each";
    EXPECT_LE(mesh.positions.size(), 12'000U) << "not 50 million";
    EXPECT_THAT(warnings, IsEmpty());
}

TEST_F(MeshCases, AnExtensionThatOnlyLooksNeedLeavesTheGeometry) {
    EXPECT_EQ(read("KHR_texture_basisu.glb").triangles.size(), 20U);
    EXPECT_THAT(warnings, ElementsAre(HasSubstr("KHR_texture_basisu")));
}

TEST_F(MeshCases, InstancingGivesThreeCopies) {
    const TriangleMesh mesh = read("instancing-optional.glb");
    EXPECT_EQ(mesh.triangles.size(), 60U);
    EXPECT_EQ(mesh.positions.size(), 36U);
    // Each copy has the same size; where they stand is in the file's last 36 bytes.
    std::ifstream file(folder() / "instancing-optional.glb", std::ios::binary);
    std::string bytes(std::istreambuf_iterator<char>(file), {});
    float places[9];
    std::memcpy(places, bytes.data() + bytes.size() - sizeof places, sizeof places);
    for (std::size_t copy = 0; copy < 3; ++copy) {
        const Box box = boundingBox(std::span(mesh.positions).subspan(12 * copy, 12));
        EXPECT_NEAR(box.size().x, 0.06F, 1e-6F);
        EXPECT_NEAR(box.min.x, -0.03F + places[3 * copy], 1e-6F);
        EXPECT_NEAR(box.min.y, 0.012F + places[3 * copy + 1], 1e-6F);
        EXPECT_NEAR(box.min.z, -0.02F + places[3 * copy + 2], 1e-6F);
    }
}

} // namespace
} // namespace lumorph::foreign_mesh_test
