#include "calibration/solve/board_shape.h"

#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/procam_observations.h"

namespace lumorph::test {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::Not;

constexpr double kBend = 4.0; // millimetres at the board's far ends, and half of that at the others

/// Bent like a sheet that lies hollow.
double hollow(double u, double v) { return kBend * (u * u - 0.5 * v * v); }

/// Between the highest and lowest corner of the hollow board over its plane; both terms are even, so that the plane is
/// level.
double trueBend(const ProcamSetup& setup) {
    const double side = (setup.rows - 1.0) / (setup.columns - 1.0);
    return kBend * (1.0 + 0.5 * side * side);
}

TEST(BoardShape, ABentBoardIsFoundInMillimetresAndWarnedOf) {
    const ProcamSetup setup = randomSetup(11, 8);
    const auto views = observe(setup, {0.1, 0.1, hollow}, 1);
    const ProcamCalibration found = solve(setup, views);
    const BoardMeasurement board = measureBoard(views, found);
    std::printf("bend %.2f +- %.2f mm of %.2f\n", board.bend, board.bendSigma, trueBend(setup));
    EXPECT_NEAR(board.bend, trueBend(setup), 0.1 * trueBend(setup));
    EXPECT_LT(std::abs(board.bend - trueBend(setup)), 5.0 * board.bendSigma);
    EXPECT_NEAR(found.boardBend, trueBend(setup), 0.1 * trueBend(setup));
    EXPECT_TRUE(board.isWarped());
    EXPECT_THAT(found.warnings, Contains(Field(&Finding::cause, Cause::boardWarped)));
    // And the lenses are right all the same.
    EXPECT_NEAR(found.projector.lens[kFocalLength], setup.projector.focal.x, 4.0 * found.projector.sigma[kFocalLength]);
    EXPECT_NEAR(found.camera.lens[kFocalLength], setup.camera.focal.x, 4.0 * found.camera.sigma[kFocalLength]);
    EXPECT_LT(found.rms, 0.2);
}

TEST(BoardShape, AFlatBoardStaysFlat) {
    const ProcamSetup setup = randomSetup(12, 8);
    const auto views = observe(setup, {0.1, 0.1}, 2);
    const ProcamCalibration found = solve(setup, views);
    EXPECT_EQ(found.boardBend, 0.0);
    const BoardMeasurement board = measureBoard(views, found);
    EXPECT_LT(board.bend, 5.0 * board.bendSigma);
    EXPECT_LT(std::abs(board.stretch), 4.0 * board.stretchSigma);
    EXPECT_FALSE(board.isWarped() || board.isStretched());
    EXPECT_TRUE(found.warnings.empty());
}

TEST(BoardShape, OblongSquaresAreToldFromSquareOnes) {
    const ProcamSetup setup = randomSetup(13, 8);
    auto views = observe(setup, {0.1, 0.1}, 3);
    for (ViewObservations& view : views) // printed 2 % longer along rows than was said
        for (cv::Point3d& point : view.corners.board) point.x /= 1.02;
    const ProcamCalibration found = solve(setup, views);
    const BoardMeasurement board = measureBoard(views, found);
    EXPECT_NEAR(board.stretch, 0.02, 5.0 * board.stretchSigma);
    EXPECT_TRUE(board.isStretched());
    EXPECT_THAT(found.warnings, Contains(Field(&Finding::cause, Cause::squareSize)));
    EXPECT_THAT(found.warnings, Not(Contains(Field(&Finding::cause, Cause::boardWarped))));
    // Lenses may have taken some of it for their own aspect: warned of, and not far off.
    EXPECT_NEAR(found.projector.lens[kFocalLength], setup.projector.focal.x, 0.005 * setup.projector.focal.x);
}

TEST(BoardShape, ASquareSizeThatIsWrongAltogetherOnlyScalesLengths) {
    const ProcamSetup setup = randomSetup(14, 8);
    auto views = observe(setup, {0.1, 0.1}, 4);
    const ProcamCalibration right = solve(setup, views);
    for (ViewObservations& view : views)
        for (cv::Point3d& point : view.corners.board) point *= 1.1;
    const ProcamCalibration scaled = solve(setup, views);
    EXPECT_NEAR(scaled.projector.lens[kFocalLength], right.projector.lens[kFocalLength], 0.05);
    for (std::size_t i = 3; i < 6; ++i)
        EXPECT_NEAR(scaled.projectorFromCamera[i], 1.1 * right.projectorFromCamera[i], 0.1);
    EXPECT_NEAR(scaled.rms, right.rms, 1e-3);
}

} // namespace
} // namespace lumorph::test
