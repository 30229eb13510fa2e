#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "calibration/solve/error_map.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/procam_observations.h"

namespace lumorph::test {
namespace {

constexpr const char* kPython = "/usr/bin/python3"; // Debian's, which sees Debian's mrcal

/// The lines that the script prints; empty where it fails.
std::vector<double> mrcalUncertainty(const nlohmann::json& given) {
    const TemporaryFolder folder;
    std::ofstream(folder / "in.json") << given;
    const std::string command = std::string(kPython) +
                                " " LUMORPH_SOURCE_DIR "/tests/calibration/mrcal_uncertainty.py < " +
                                (folder / "in.json").string() + " > " + (folder / "out").string();
    std::vector<double> numbers;
    if (std::system(command.c_str()) == 0) {
        std::ifstream out(folder / "out");
        for (double number = 0.0; out >> number;) numbers.push_back(number);
    }
    return numbers;
}

TEST(CameraUncertainty, AgreesWithMrcalOnTheSameCorners) {
    if (std::system((std::string(kPython) + " -c 'import mrcal' 2> /dev/null").c_str()) != 0)
        GTEST_SKIP() << "without python3-mrcal";
    const ProcamSetup setup = randomSetup(4, 8);
    SolveOptions options;
    options.cameraModel = "k1 k2 p1 p2 aspect";
    const auto views = observe(setup, {0.15, 0.1}, 4);
    const cv::Size size(setup.camera.size.x, setup.camera.size.y);
    const ProcamCalibration found = calibrateIntrinsics(views, size, options);
    ASSERT_EQ(found.camera.model, "k1 k2 p1 p2 aspect");

    const Lens& lens = found.camera.lens;
    nlohmann::json given = {{"columns", setup.columns},
                            {"rows", setup.rows},
                            {"spacing", setup.square / 1000.0},
                            {"size", {size.width, size.height}},
                            {"lens",
                             {lens[kFocalLength], lens[kFocalLength] * lens[kAspect], lens[kPrincipalX],
                              lens[kPrincipalY], lens[kK1], lens[kK2], lens[kP1], lens[kP2]}}};
    for (std::size_t v = 0; v < views.size(); ++v) {
        PoseVector pose = found.state.cameraFromBoard[v];
        for (std::size_t i = 3; i < 6; ++i) pose[i] /= 1000.0;
        given["poses"].push_back(pose);
        for (const cv::Point2d& seen : views[v].corners.seen) given["corners"].push_back({seen.x, seen.y});
    }
    std::vector<cv::Point3d> points;
    for (const double y : {0.15, 0.5, 0.85})
        for (const double x : {0.15, 0.5, 0.85}) {
            const auto [a, b] = directionOfPixel(lens, x * size.width, y * size.height);
            points.emplace_back(2000.0 * a, 2000.0 * b, 2000.0);
            given["points"].push_back({2.0 * a, 2.0 * b, 2.0});
        }
    const std::vector<double> theirs = mrcalUncertainty(given);
    ASSERT_EQ(theirs.size(), points.size());
    const std::vector<Eigen::Matrix2d> ours = cameraUncertainty(found, points);
    std::printf("worst direction, pixels, ours/mrcal:");
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double sigma =
            std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(ours[i]).eigenvalues().maxCoeff());
        std::printf(" %.3f/%.3f", sigma, theirs[i]);
        EXPECT_NEAR(sigma, theirs[i], 0.15 * theirs[i]);
    }
    std::printf("\n");
}

} // namespace
} // namespace lumorph::test
