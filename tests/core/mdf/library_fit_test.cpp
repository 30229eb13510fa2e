#include "core/mdf/library_fit.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/mesh_file.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

using testing::HasSubstr;

LibraryTarget libraryTarget(std::string name, TriangleMesh mesh) {
    LibraryTarget target{std::move(name), makeTarget(std::move(mesh)), {}};
    target.box = boundingBox(target.target.mesh.positions);
    return target;
}

std::vector<LibraryTarget> boxesAndRoof() {
    std::vector<LibraryTarget> library;
    library.push_back(libraryTarget("low", test::boxMesh({0, 0, 0}, {0.2F, 0.03F, 0.1F})));
    library.push_back(libraryTarget("tower", test::boxMesh({0, 0, 0}, {0.03F, 0.1F, 0.03F})));
    TriangleMesh roof = test::boxMesh({0, 0, 0}, {0.2F, 0.1F, 0.2F});
    for (glm::vec3& p : roof.positions)
        if (p.y > 0.05F && p.x > 0.1F) p.y = 0.02F;
    library.push_back(libraryTarget("roof", std::move(roof)));
    return library;
}

/// IoU voxel by voxel, of the volume without any kept piece.
double literalIou(const Coverage& coverage, const BitColumns& wanted, const State& state) {
    std::vector<double> strokes;
    for (const Level level : state) strokes.push_back(strokeOf(level, coverage.levels()));
    BitColumns covered;
    CoverageScratch scratch;
    coverage.coveredAt(strokes, covered, scratch);
    std::size_t both = 0;
    std::size_t either = 0;
    const glm::ivec3 size = coverage.frame().dimensions;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                both += covered.test(x, y, z) && wanted.test(x, y, z) ? 1 : 0;
                either += covered.test(x, y, z) || wanted.test(x, y, z) ? 1 : 0;
            }
    return static_cast<double>(both) / static_cast<double>(either);
}

/// The best IoU of all joint states in which only `free` actuators move.
double exhaustiveIou(const Coverage& coverage, const BitColumns& wanted, const std::vector<bool>& free) {
    State state(free.size());
    double best = 0.0;
    for (;;) {
        best = std::max(best, literalIou(coverage, wanted, state));
        std::size_t a = 0;
        while (a < free.size() && (!free[a] || state[a].index + 1 == coverage.levels())) state[a++].index = 0;
        if (a == free.size()) return best;
        ++state[a].index;
    }
}

TEST(LibraryFit, FindsTheBestOfAllStates) {
    LibraryFitOptions options;
    options.resolution = 10;
    options.levels = 6;
    const std::vector<LibraryTarget> library = boxesAndRoof();
    for (const Rig& rig : {test::lifterRig(), test::cushionRig()}) {
        LibraryMatcher matcher(rig, library, options);
        const LibraryFit& fit = matcher.fit();
        ASSERT_EQ(fit.targets.size(), 3U);
        double mean = 0.0;
        for (std::size_t t = 0; t < 3; ++t) {
            const BitColumns& wanted = matcher.voxelsOf(t);
            EXPECT_NEAR(fit.targets[t].iou, literalIou(matcher.coverage(), wanted, fit.targets[t].state), 1e-12);
            const double best = exhaustiveIou(matcher.coverage(), wanted, {true, true, true});
            EXPECT_GE(fit.targets[t].iou, best - 0.01) << rig.name() << " " << fit.targets[t].name;
            mean += fit.targets[t].iou / 3.0;
        }
        EXPECT_NEAR(fit.mean, mean, 1e-12);
        for (const TargetFit& target : fit.targets) {
            EXPECT_GE(fit.targets[fit.best].iou, target.iou);
            EXPECT_LE(fit.targets[fit.worst].iou, target.iou);
        }
    }
}

TEST(LibraryFit, LeavesOutTheActuatorThatIsMissedLeast) {
    LibraryFitOptions options;
    options.resolution = 10;
    options.levels = 6;
    LibraryMatcher matcher(test::lifterRig(), boxesAndRoof(), options);
    const std::vector<FitWithout> steps = matcher.fitByActuators();
    ASSERT_EQ(steps.size(), 3U);
    EXPECT_EQ(steps[0].actuators, 3U);
    EXPECT_EQ(steps[2].actuators, 1U);
    EXPECT_NEAR(steps[0].fit, matcher.fit().mean, 1e-12);
    std::vector<bool> free{true, true, true};
    for (std::size_t s = 1; s < 3; ++s) {
        EXPECT_LE(steps[s].fit, steps[s - 1].fit + 1e-12);
        ASSERT_EQ(steps[s].leftOut.size(), 1U);
        double mean = 0.0;
        for (std::size_t a = 0; a < 3; ++a)
            if (matcher.coverage().rig().actuators()[a].name == steps[s].leftOut[0]) free[a] = false;
        for (std::size_t t = 0; t < 3; ++t) mean += exhaustiveIou(matcher.coverage(), matcher.voxelsOf(t), free) / 3.0;
        EXPECT_NEAR(steps[s].fit, mean, 0.01);
    }
}

TEST(LibraryFit, PosesOfTheDeviceStandWhereTheyAreAndFitWell) {
    const Rig tablet = test::cutTablet();
    std::vector<LibraryTarget> library;
    library.push_back(libraryTarget("pose", deformed(tablet, std::vector<double>{0.5, 0.0, 1.0, 0.25, 0.75, 0.125})));
    library.push_back(libraryTarget("box", test::boxMesh({0, 0, 0}, {1.0F, 0.5F, 1.0F})));
    LibraryMatcher matcher(tablet, library, {});
    const LibraryFit& fit = matcher.fit();
    EXPECT_EQ(fit.targets[0].placement, Placement{});
    EXPECT_GT(fit.targets[0].iou, 0.99);
    EXPECT_EQ(fit.targets[0].state[4].index, 24); // three quarters of 32
    EXPECT_LT(fit.targets[1].placement.scale, 0.2);
    LibraryFitOptions asIs;
    asIs.placing = TargetPlacing::asIs;
    EXPECT_EQ(LibraryMatcher(tablet, library, asIs).fit().targets[1].placement, Placement{});
}

TEST(LibraryFit, IsCancelled) {
    std::stop_source stop;
    stop.request_stop();
    const Progress stopped({}, stop.get_token());
    EXPECT_THROW(LibraryMatcher(test::lifterRig(), boxesAndRoof(), {}, stopped), Cancelled);
    LibraryMatcher matcher(test::lifterRig(), boxesAndRoof(), {});
    EXPECT_THROW((void)matcher.fit(stopped), Cancelled);
    EXPECT_GT(matcher.fit().mean, 0.0); // and goes on as if nothing had been
}

TEST(LibraryFit, RefusesAnEmptyLibraryAndARigThatLiftsNothing) {
    EXPECT_THROW(LibraryMatcher(test::lifterRig(), {}, {}), InvalidInput);
}

TEST(TargetLibrary, ReadsEveryMeshOfAFolderByName) {
    const TemporaryFolder folder;
    writeMesh(test::boxMesh({0, 0, 0}, {1, 1, 1}), folder / "b.obj");
    writeMesh(test::boxMesh({0, 0, 0}, {1, 1, 1}), folder / "a.stl");
    writeMesh(test::boxMesh({0, 0, 0}, {1, 1, 1}), folder / "b.glb");
    std::ofstream(folder / "notes.txt") << "no mesh";
    std::filesystem::create_directory(folder / "inner");
    const std::vector<LibraryTarget> library = readTargetLibrary(folder.path());
    ASSERT_EQ(library.size(), 3U);
    EXPECT_EQ(library[0].name, "a");
    EXPECT_EQ(library[1].name, "b.glb");
    EXPECT_EQ(library[2].name, "b.obj");
}

TEST(TargetLibrary, RefusesByName) {
    const auto refusal = [](const std::filesystem::path& folder) -> std::string {
        try {
            (void)readTargetLibrary(folder);
        } catch (const DataError& error) {
            return error.what();
        }
        return "";
    };
    const TemporaryFolder folder;
    EXPECT_THAT(refusal(folder / "nowhere"), HasSubstr("nowhere"));
    EXPECT_THAT(refusal(folder.path()), HasSubstr("holds no mesh"));
    std::ofstream(folder / "bad.obj") << "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    EXPECT_THAT(refusal(folder.path()), HasSubstr("bad.obj"));
    std::ofstream(folder / "bad.obj") << "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n";
    EXPECT_THAT(refusal(folder.path()), HasSubstr("no volume"));
}

} // namespace
} // namespace lumorph
