#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/voxels/nrrd.h"
#include "core/voxels/solid.h"
#include "core/voxels/surface.h"
#include "core/voxels/winding.h"
#include "tests/support/cgal_oracle.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

/// A closed, bumpy ball.
TriangleMesh bumpyBall(int rings, float radius, const glm::vec3& centre) {
    TriangleMesh mesh;
    const int segments = 2 * rings;
    const auto point = [&](int ring, int segment) {
        const double polar = std::numbers::pi * ring / rings;
        const double around = 2.0 * std::numbers::pi * segment / segments;
        const double r = static_cast<double>(radius) * (1.0 + 0.2 * std::sin(5.0 * around) * std::sin(4.0 * polar));
        return centre + glm::vec3(static_cast<float>(r * std::sin(polar) * std::cos(around)),
                                  static_cast<float>(r * std::cos(polar)),
                                  static_cast<float>(r * std::sin(polar) * std::sin(around)));
    };
    mesh.positions.push_back(point(0, 0));
    for (int ring = 1; ring < rings; ++ring)
        for (int s = 0; s < segments; ++s) mesh.positions.push_back(point(ring, s));
    mesh.positions.push_back(point(rings, 0));
    const auto index = [&](int ring, int s) {
        return static_cast<std::uint32_t>(ring == 0       ? 0
                                          : ring == rings ? 1 + (rings - 1) * segments
                                                          : 1 + (ring - 1) * segments + s % segments);
    };
    for (int ring = 0; ring < rings; ++ring)
        for (int s = 0; s < segments; ++s) {
            if (ring > 0) mesh.triangles.emplace_back(index(ring, s), index(ring, s + 1), index(ring + 1, s));
            if (ring < rings - 1)
                mesh.triangles.emplace_back(index(ring, s + 1), index(ring + 1, s + 1), index(ring + 1, s));
        }
    return mesh;
}

VoxelFrame frameAround(const TriangleMesh& mesh, int resolution) {
    return frameOf(boundingBox(mesh.positions), resolution);
}

std::size_t differences(const VoxelFrame& frame, const BitColumns& bits, const TriangleMesh& mesh) {
    const test::InsideOracle inside(mesh);
    std::size_t count = 0;
    for (int z = 0; z < frame.dimensions.z; ++z)
        for (int y = 0; y < frame.dimensions.y; ++y)
            for (int x = 0; x < frame.dimensions.x; ++x) count += bits.test(x, y, z) != inside(frame.centre(x, y, z));
    return count;
}

// R12: the solid is what CGAL says is inside, but for centres within rounding of the surface.
TEST(SolidVoxelizer, AgreesWithCgalOnABumpyBall) {
    const TriangleMesh mesh = bumpyBall(40, 0.05F, {0.01F, 0.02F, 0.03F});
    ASSERT_GT(signedVolume(mesh), 0.0);
    const VoxelFrame frame = frameAround(mesh, 40);
    EXPECT_LE(differences(frame, voxelizeSolid(frame, mesh), mesh), frame.voxelCount() / 40'000);
}

TEST(SolidVoxelizer, OverlappingShellsUnite) {
    TriangleMesh mesh = bumpyBall(20, 0.03F, {0.0F, 0.0F, 0.0F});
    append(mesh, bumpyBall(20, 0.03F, {0.021F, 0.007F, 0.011F}));
    append(mesh, test::boxMesh({-0.011F, -0.041F, -0.012F}, {0.013F, 0.017F, 0.014F}));
    const VoxelFrame frame = frameAround(mesh, 45);
    EXPECT_LE(differences(frame, voxelizeSolid(frame, mesh), mesh), frame.voxelCount() / 40'000);
}

TEST(SolidVoxelizer, InwardFacingCavitiesStayEmpty) {
    TriangleMesh mesh = test::boxMesh({0, 0, 0}, {0.1F, 0.1F, 0.1F});
    TriangleMesh cavity = test::boxMesh({0.0201F, 0.0203F, 0.0205F}, {0.0502F, 0.0604F, 0.0706F});
    for (glm::uvec3& t : cavity.triangles) std::swap(t.y, t.z);
    append(mesh, cavity);
    const VoxelFrame frame = frameAround(mesh, 50);
    std::size_t expected = 0;
    for (int z = 0; z < 50; ++z)
        for (int y = 0; y < 50; ++y)
            for (int x = 0; x < 50; ++x) {
                const glm::dvec3 p = frame.centre(x, y, z);
                const bool hollow =
                    p.x > 0.0201 && p.x < 0.0502 && p.y > 0.0203 && p.y < 0.0604 && p.z > 0.0205 && p.z < 0.0706;
                expected += !hollow;
            }
    EXPECT_EQ(voxelizeSolid(frame, mesh).count(), expected);
}

// Every face lies exactly on column centres: no column may leak or be counted twice.
TEST(SolidVoxelizer, FacesOnColumnCentresNeverLeak) {
    const VoxelFrame frame{{0, 0, 0}, 1.0, {16, 70, 16}};
    for (const int cells : {1, 2, 8}) {
        const TriangleMesh mesh = test::boxMesh({2.5F, 2.25F, 3.5F}, {10.5F, 66.25F, 11.5F}, cells);
        const BitColumns bits = voxelizeSolid(frame, mesh);
        EXPECT_EQ(bits.count(), 8U * 8U * 64U) << cells;
        for (int z = 0; z < 16; ++z)
            for (int x = 0; x < 16; ++x) EXPECT_FALSE(bits.test(x, 69, z));
    }
}

TEST(SolidVoxelizer, AMeshThatReachesBeyondTheFrameIsCutAtIt) {
    const VoxelFrame frame{{0, 0, 0}, 0.01, {10, 10, 10}};
    const BitColumns bits =
        voxelizeSolid(frame, test::boxMesh({-5000.0F, -5000.0F, 0.0449F}, {5000.0F, 0.0551F, 5000.0F}));
    EXPECT_EQ(bits.count(), 10U * 6U * 6U); // y up to 5.51 voxels: centres 0.5..5.5 minus rounding
}

/// A mesh thousands of frames large, of which one slanting face crosses the frame.
TEST(SolidVoxelizer, AMeshFarLargerThanTheFrameKeepsItsPlace) {
    const VoxelFrame frame{{0.0F, 0.0F, 0.0F}, 0.01, {20, 20, 20}};
    for (const float half : {50.0F, 300.0F, 2000.0F}) {
        TriangleMesh slab = test::boxMesh({-half, -half, -half}, {half, 0.1F, half});
        for (glm::vec3& p : slab.positions)
            if (p.y > 0.0F) p.y = 0.1F + 0.3F * (p.x - 0.1F) - 0.2F * (p.z - 0.1F);
        const BitColumns bits = voxelizeSolid(frame, slab);
        std::size_t wrong = 0;
        for (int z = 0; z < 20; ++z)
            for (int y = 0; y < 20; ++y)
                for (int x = 0; x < 20; ++x) {
                    const glm::dvec3 c = frame.centre(x, y, z);
                    const double beneath = 0.1 + 0.3 * (c.x - 0.1) - 0.2 * (c.z - 0.1) - c.y;
                    const double room = 0.002 + 1e-6 * static_cast<double>(half); // single precision out there
                    if (std::abs(beneath) > room) wrong += bits.test(x, y, z) != (beneath > 0.0);
                }
        EXPECT_EQ(wrong, 0U) << half << " m";
    }
}

TEST(SurfaceVoxelizer, AgreesWithCgalBoxByBox) {
    const VoxelFrame frame{{-0.011F, -0.013F, -0.012F}, 0.005, {7, 6, 8}};
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(-0.03F, 0.04F);
    for (int round = 0; round < 300; ++round) {
        TriangleMesh mesh;
        for (int i = 0; i < 3; ++i) mesh.positions.emplace_back(place(random), place(random), place(random));
        mesh.triangles.emplace_back(0, 1, 2);
        const BitColumns bits = voxelizeSurface(frame, mesh);
        for (int z = 0; z < 8; ++z)
            for (int y = 0; y < 6; ++y)
                for (int x = 0; x < 7; ++x) {
                    const glm::dvec3 low = glm::dvec3(frame.origin) + frame.voxelSize * glm::dvec3(x, y, z);
                    ASSERT_EQ(bits.test(x, y, z),
                              test::boxMeetsTriangle(low, low + frame.voxelSize, glm::dvec3(mesh.positions[0]),
                                                     glm::dvec3(mesh.positions[1]), glm::dvec3(mesh.positions[2])))
                        << "triangle " << round << " voxel " << x << " " << y << " " << z;
                }
    }
}

TEST(SurfaceVoxelizer, AFaceBetweenTwoLayersTouchesBoth) {
    const VoxelFrame frame{{0, 0, 0}, 1.0, {4, 4, 4}};
    TriangleMesh mesh{{{0, 2, 0}, {4, 2, 0}, {0, 2, 4}, {4, 2, 4}}, {{0, 2, 1}, {1, 2, 3}}};
    EXPECT_EQ(voxelizeSurface(frame, mesh).count(), 2U * 16U);
}

TEST(WindingVoxelizer, FillsAMeshWithAHoleAlmostLikeTheWholeOne) {
    TriangleMesh whole = bumpyBall(40, 0.05F, {0, 0, 0});
    TriangleMesh open = whole;
    open.triangles.erase(open.triangles.begin(), open.triangles.begin() + 40);
    const VoxelFrame frame = frameAround(whole, 33);
    const BitColumns expected = voxelizeSolid(frame, whole);
    EXPECT_GT(intersectionOverUnion(voxelizeWinding(frame, open), expected), 0.985);
    EXPECT_GT(intersectionOverUnion(voxelizeWinding(frame, whole), expected), 0.999);
    TriangleMesh insideOut = open;
    for (glm::uvec3& t : insideOut.triangles) std::swap(t.y, t.z);
    EXPECT_EQ(voxelizeWinding(frame, insideOut), voxelizeWinding(frame, open)) << "whichever way its triangles turn";
}

TEST(WindingVoxelizer, TheTreeAgreesWithTheFullSum) {
    TriangleMesh open = bumpyBall(40, 0.05F, {0, 0, 0});
    open.triangles.resize(open.triangles.size() / 2);
    const VoxelFrame frame = frameAround(open, 14);
    const BitColumns bits = voxelizeWinding(frame, open);
    std::size_t wrong = 0;
    for (int z = 0; z < frame.dimensions.z; ++z)
        for (int y = 0; y < frame.dimensions.y; ++y)
            for (int x = 0; x < frame.dimensions.x; ++x) {
                const double winding = std::abs(windingNumber(open, frame.centre(x, y, z)));
                if (std::abs(winding - 0.5) > 0.02) wrong += bits.test(x, y, z) != (winding > 0.5);
            }
    EXPECT_EQ(wrong, 0U);
}

TEST(WindingVoxelizer, StopsWhenAsked) {
    std::stop_source stop;
    stop.request_stop();
    const TriangleMesh mesh = bumpyBall(10, 0.05F, {0, 0, 0});
    EXPECT_THROW((void)voxelizeWinding(frameAround(mesh, 20), mesh, Progress({}, stop.get_token())), Cancelled);
}

TEST(VoxelFrame, SmallestAxisGetsTheResolutionAndTheOthersAreRoundedUp) {
    struct Case {
        glm::vec3 size;
        int resolution;
        glm::ivec3 dimensions;
        glm::vec3 origin{1, 2, 3};
    };
    // 0.3F is three times 0.1F and a hair, which is rounding and no room for one more voxel.
    ASSERT_GT(static_cast<double>(0.3F), 3.0 * static_cast<double>(0.1F));
    for (const Case& c : {Case{{0.210F, 0.0842F, 0.150F}, 33, {83, 33, 59}}, Case{{1, 1, 1}, 10, {10, 10, 10}},
                          Case{{0.3F, 0.1F, 0.2F}, 1, {3, 1, 2}, glm::vec3(0.0F)},
                          Case{{0.3F, 0.1F, 0.2F}, 4, {12, 4, 8}, glm::vec3(0.0F)},
                          Case{{3, 1, 2.0001F}, 4, {12, 4, 9}}, Case{{0.1F, 0.3F, 0.10001F}, 2, {2, 6, 3}}}) {
        const VoxelFrame frame = frameOf({c.origin, c.origin + c.size}, c.resolution);
        EXPECT_EQ(frame.dimensions.x, c.dimensions.x);
        EXPECT_EQ(frame.dimensions.y, c.dimensions.y);
        EXPECT_EQ(frame.dimensions.z, c.dimensions.z);
    }
    EXPECT_THROW((void)frameOf({{0, 0, 0}, {1, 0, 1}}, 4), InvalidInput);
    EXPECT_THROW((void)frameOf({{0, 0, 0}, {1, 1, 1}}, 0), InvalidInput);
    EXPECT_THROW((void)frameOf({{0, 0, 0}, {1, 1, 1}}, 4096), InvalidInput);
}

TEST(Nrrd, ComesBackAsItWas) {
    const VoxelFrame frame{{-0.1F, 0.2F, 0.3F}, 0.0025, {5, 33, 7}};
    std::mt19937 random(9);
    ByteGrid grid{frame, {}};
    for (std::size_t i = 0; i < frame.voxelCount(); ++i) grid.values.push_back(static_cast<std::uint8_t>(random()));
    const ByteGrid read = parseNrrd(writeNrrd(grid, "test"), "x.nrrd");
    EXPECT_EQ(read.values, grid.values);
    EXPECT_EQ(read.frame, grid.frame);
}

std::vector<std::byte> bytesOfText(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

TEST(Nrrd, ReadsWhatOtherProgramsWrite) {
    const ByteGrid grid = parseNrrd(
        bytesOfText(
            "NRRD0005\r\n# a comment\r\ntype: unsigned char\r\ndimension: 3\r\nspace: left-posterior-superior\r\n"
            "sizes: 2 1 2\r\nspace directions: (0.5,0,0) (0,0.5,0) (0,0,0.5)\r\nkinds: domain domain domain\r\n"
            "encoding: raw\r\nspace origin: (1,2,3)\r\nnote:=anything\r\n\r\nabcd"),
        "slicer.nrrd");
    EXPECT_EQ(grid.values, (std::vector<std::uint8_t>{'a', 'b', 'c', 'd'}));
    EXPECT_DOUBLE_EQ(grid.frame.voxelSize, 0.5);
    EXPECT_FLOAT_EQ(grid.frame.origin.x, 0.75F);
    EXPECT_TRUE(bitsOf(grid).test(1, 0, 1));
}

TEST(Nrrd, VoxelsMustBeCubesWhateverSideDiffers) {
    struct Case {
        const char* field;
        double side; ///< 0: refused
    };
    const Case cases[] = {{"spacings: 0.25 0.25 0.25", 0.25},
                          {"spacings: 0.25 0.25 0.5", 0.0},
                          {"spacings: 0.25 0.5 0.25", 0.0},
                          {"spacings: 0.5 0.25 0.25", 0.0},
                          {"spacings: 0.25 0.25 -0.25", 0.0},
                          {"spacings: 0.25 0.25", 0.0},
                          {"spacings: 0 0 0", 0.0},
                          {"space directions: (0.5,0,0) (0,0.5,0) (0,0,0.5)", 0.5},
                          {"space directions: (0.5,0,0) (0,0.25,0) (0,0,0.5)", 0.0},
                          {"space directions: (0.5,0,0) (0,0.5,0) (0,0,0.25)", 0.0},
                          {"space directions: (0.25,0,0) (0,0.5,0) (0,0,0.5)", 0.0},
                          {"space directions: (0.5,0,0) (0,-0.5,0) (0,0,0.5)", 0.0},
                          {"space directions: (0.5,0,0.01) (0,0.5,0) (0,0,0.5)", 0.0},
                          {"space directions: (0.5,0,0) (0,0.5,0.01) (0,0,0.5)", 0.0},
                          {"space directions: (0.5,0,0) (0,0.5,0) (0.01,0,0.5)", 0.0},
                          {"space directions: (0.5,0,0) (0,0.5,0)", 0.0},
                          {"note: it says nothing", 1.0}};
    for (const Case& one : cases) {
        const std::string text =
            std::string("NRRD0004\ntype: uint8\ndimension: 3\nencoding: raw\nsizes: 1 2 1\n") + one.field + "\n\n12";
        try {
            EXPECT_DOUBLE_EQ(parseNrrd(bytesOfText(text), "x.nrrd").frame.voxelSize, one.side) << one.field;
        } catch (const DataError& error) {
            EXPECT_EQ(one.side, 0.0) << one.field << ": " << error.why();
        }
    }
}

// Columns stand on x and z: a wide flat grid is too large, a high narrow one is not.
TEST(Nrrd, ColumnsAreCountedOverXAndZ) {
    const std::string head = "NRRD0004\ntype: uint8\ndimension: 3\nencoding: raw\nsizes: ";
    const auto why = [&](const std::string& sizes) {
        try {
            (void)parseNrrd(bytesOfText(head + sizes + "\n\n1"), "x.nrrd");
        } catch (const DataError& error) {
            return error.why();
        }
        return std::string("it was accepted");
    };
    EXPECT_NE(why("3000 1 3000").find("columns"), std::string::npos) << why("3000 1 3000");
    EXPECT_NE(why("3000 3000 1").find("bytes where the sizes ask"), std::string::npos) << why("3000 3000 1");
}

TEST(Nrrd, BrokenFilesAreRefusedByNameWithARemedy) {
    const std::string head = "NRRD0004\ntype: uint8\ndimension: 3\nencoding: raw\n";
    const std::string files[] = {"",
                                 "NRRD",
                                 "garbage",
                                 "NRRD0004\n",
                                 head + "sizes: 2 2 2\n",
                                 head + "sizes: 2 2 2\n\n1234567",
                                 head + "sizes: 2 2 2\n\n123456789",
                                 head + "sizes: 2 2\n\n1234",
                                 head + "sizes: 2 x 2\n\n12345678",
                                 head + "sizes: -1 -1 8\n\n12345678",
                                 head + "sizes: 99999999 99999999 99999999\n\n1",
                                 head + "sizes: nan 1 1\n\n1",
                                 head + "sizes: 1 1 1\nspacings: 1 2 3\n\n1",
                                 head + "sizes: 1 1 1\nspace directions: (0,1,0) (1,0,0) (0,0,1)\n\n1",
                                 head + "sizes: 1 1 1\nspacings: -1 -1 -1\n\n1",
                                 head + "sizes: 1 1 1\ndata file: /etc/passwd\n\n1",
                                 "NRRD0004\ntype: float\ndimension: 3\nencoding: raw\nsizes: 1 1 1\n\n1234",
                                 "NRRD0004\ntype: uint8\ndimension: 3\nencoding: gzip\nsizes: 1 1 1\n\n1",
                                 head + "sizes: 1 1 1\nspace origin: (1,inf,0)\n\n1"};
    for (const std::string& file : files) {
        try {
            (void)parseNrrd(bytesOfText(file), "target.nrrd");
            FAIL() << file;
        } catch (const DataError& error) {
            EXPECT_EQ(error.subject(), "target.nrrd");
            EXPECT_FALSE(error.remedy().empty());
        }
    }
}

} // namespace
} // namespace lumorph
