#include <cmath>

#include <gtest/gtest.h>

#include "core/geometry/mesh_check.h"
#include "core/geometry/model.h"
#include "resources/targets/generator/targets.h"
#include "tests/app/process.h"
#include "tests/app/workspace.h"

namespace lumorph::test {
namespace {

constexpr std::size_t kMegabyte = 1'000'000;

TEST(BundledTargets, AreWhatTheGeneratorWrites) {
    const TemporaryFolder folder;
    const Outcome made = Process(LUMORPH_BIN_DIR "/lumorph_targets", {folder.path().string()}).wait();
    ASSERT_EQ(made.exitCode, 0) << made.err;
    for (const char* name : {"dunes.glb", "swell.glb"}) {
        const std::vector<std::byte> committed = bytesOfFile(resource(std::string("targets/") + name));
        EXPECT_TRUE(bytesOfFile(folder / name) == committed) << name << ": run lumorph_targets and commit the result";
        EXPECT_LT(committed.size(), kMegabyte) << name;
    }
}

TEST(BundledTargets, DunesAreACleanSolidOfTheTabletsSize) {
    const TriangleMesh dunes = flatten(dunesModel());
    const MeshReport report = checkMesh(dunes);
    EXPECT_TRUE(report.solid()) << ::testing::PrintToString(report.findings());
    EXPECT_LE(report.triangles, 20'000U);
    const Box box = boundingBox(dunes.positions);
    EXPECT_NEAR(box.size().x, 0.21F, 1e-5F);
    EXPECT_NEAR(box.size().y, 0.055F, 0.01F);
    EXPECT_NEAR(box.size().z, 0.15F, 1e-5F);
    EXPECT_EQ(box.min.y, 0.0F);
}

TEST(BundledTargets, SwellIsAWaveThatTravelsAndComesBack) {
    const Model model = swellModel();
    ASSERT_EQ(model.animations.size(), 1U);
    const Model::Animation& swell = model.animations.front();
    EXPECT_EQ(swell.name, "swell");
    EXPECT_DOUBLE_EQ(swell.duration(), 4.0);

    // The crest along the front edge is where its highest vertex is.
    const auto crest = [&](double seconds) {
        const TriangleMesh mesh = flatten(model, swell, seconds);
        EXPECT_TRUE(checkMesh(mesh).solid()) << "at " << seconds << " s";
        glm::vec3 highest(0.0F);
        for (const glm::vec3& p : mesh.positions)
            if (p.z > 0.0749F && p.y > highest.y) highest = p;
        return highest;
    };
    const glm::vec3 start = crest(0.0);
    const glm::vec3 later = crest(0.8);
    EXPECT_NEAR(later.x - start.x, 0.8 / 4.0 * 0.26 / std::cos(0.35), 0.005);
    EXPECT_NEAR(later.y, start.y, 0.001F);
    EXPECT_EQ(crest(4.0), start);
}

} // namespace
} // namespace lumorph::test
