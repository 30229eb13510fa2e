#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "core/geometry/mesh_check.h"
#include "core/geometry/model.h"
#include "core/mdf/field_file.h"
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
    std::vector<std::string> names{"dunes.glb", "swell.glb", "bloom.glb"};
    for (const auto& [name, model] : shapeModels()) names.push_back(name + ".glb");
    EXPECT_EQ(names.size(), 15U);
    for (const std::string& name : names) {
        const std::vector<std::byte> committed = bytesOfFile(resource("targets/" + name));
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
    EXPECT_NEAR(box.size().y, 0.040F, 0.005F);
    EXPECT_NEAR(box.size().z, 0.15F, 1e-5F);
    EXPECT_EQ(box.min.y, 0.0F);
}

TEST(BundledTargets, PlainShapesAreCleanSmallSolids) {
    for (const auto& [name, model] : shapeModels()) {
        const MeshReport report = checkMesh(flatten(model));
        EXPECT_TRUE(report.solid()) << name << ::testing::PrintToString(report.findings());
        EXPECT_LT(writeGlb(model).size(), 64U << 10U) << name;
    }
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

TEST(BundledTargets, BloomIsASolidWhosePetalsRiseOneAfterAnotherAndComeBack) {
    const Model model = bloomModel();
    ASSERT_EQ(model.animations.size(), 1U);
    const Model::Animation& bloom = model.animations.front();
    EXPECT_DOUBLE_EQ(bloom.duration(), 6.0);
    /// How high the petal at a place stands.
    const auto height = [&](double seconds, glm::vec2 place) {
        float highest = 0.0F;
        for (const glm::vec3& p : flatten(model, bloom, seconds).positions)
            if (glm::distance(glm::vec2(p.x, p.z), place) < 0.02F) highest = std::max(highest, p.y);
        return highest;
    };
    // Corners and long edges in the order of the wave, which passes one each second.
    const glm::vec2 petals[] = {{-0.09F, 0.06F}, {0.0F, 0.06F},  {0.09F, 0.06F},
                                {0.09F, -0.06F}, {0.0F, -0.06F}, {-0.09F, -0.06F}};
    for (std::size_t k = 0; k < 6; ++k) {
        SCOPED_TRACE(k);
        const auto now = static_cast<double>(k);
        const MeshReport report = checkMesh(flatten(model, bloom, now));
        EXPECT_TRUE(report.solid()) << ::testing::PrintToString(report.findings());
        EXPECT_LE(report.triangles, 8'000U);
        const float high = height(now, petals[k]);
        EXPECT_GT(high, 0.02F);
        EXPECT_GT(high, height(now + 1.0, petals[k]));
        EXPECT_GT(high, height(now + (k == 0 ? 5.0 : -1.0), petals[k]));
        EXPECT_LT(height(now < 3.0 ? now + 3.0 : now - 3.0, petals[k]), 0.3F * high);
        EXPECT_LT(height(now, {0.0F, 0.0F}), 0.4F * high) << "the middle stays low";
    }
    EXPECT_EQ(flatten(model, bloom, 6.0).positions, flatten(model, bloom, 0.0).positions);
}

// R19: the demo is worth looking at.
TEST(BundledTargets, TheTabletFollowsTheBloom) {
    const std::string field = resource("models/tablet.mdf");
    EXPECT_EQ(parseField(bytesOfFile(field), field).rigGlb, bytesOfFile(resource("models/tablet.glb")))
        << "build the field again: lumorph mdf build tablet.glb -o tablet.mdf";
    const Outcome outcome = lumorph({"match", field, resource("targets/bloom.glb"), "--animation", "first", "--method",
                                     "refined", "--budget-ms", "1000", "--fps", "10", "--csv", "-"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    std::istringstream table(outcome.out);
    std::string line;
    double wanted = 0.0, reached = 0.0;
    int frames = -1; // the first line names the columns
    for (; std::getline(table, line); ++frames) {
        if (frames < 0) continue;
        double seconds = 0.0, w1 = 0.0, r1 = 0.0;
        ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &seconds, &w1, &r1), 3) << line;
        EXPECT_GE(w1, 0.7) << "at " << seconds << " s";
        wanted += w1;
        reached += r1;
    }
    ASSERT_EQ(frames, 61);
    EXPECT_GE(wanted / frames, 0.75);
    EXPECT_GE(reached / frames, 0.65);
}

} // namespace
} // namespace lumorph::test
