#include "calibration/solve/bundle.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/procam_observations.h"

namespace lumorph::test {
namespace {

/// All numbers of a state with one view, in the order of a covariance.
std::vector<double*> numbersOf(BundleState& state) {
    std::vector<double*> all;
    const auto add = [&all](auto& block) {
        for (double& number : block) all.push_back(&number);
    };
    add(state.camera);
    add(state.projector);
    add(state.projectorFromCamera);
    add(state.board.terms);
    add(state.cameraFromBoard.front());
    return all;
}

/// Errors of corners and points one below the other, in standard deviations.
Eigen::VectorXd errorsOf(const ViewObservations& view, const BundleState& state, const BundleOptions& options) {
    std::vector<double> all;
    for (const cv::Point2d& e : cameraErrors(view, state, state.cameraFromBoard.front()))
        for (const double v : {e.x, e.y}) all.push_back(v / options.cameraSigma);
    for (const cv::Point2d& e : projectorErrors(view, state, state.cameraFromBoard.front()))
        for (const double v : {e.x, e.y}) all.push_back(v / options.projectorSigma);
    return Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

TEST(Bundle, SlopesAreThoseOfFiniteDifferencesEvenOnABentBoard) {
    ProcamSetup setup = ProcamSetup::usual();
    setup.cameraFromBoard = {setup.pose(32, 5, 4)};
    const std::vector<ViewObservations> views = observe(setup, {0.1, 0.1}, 1);
    BundleState state;
    state.camera = {960.0, 1.01, 245.0, 172.0, -0.2, 0.1, 0.002, -0.003, 0.05};
    state.projector = {470.0, 0.99, 126.0, 213.0, -0.08, 0.05, -0.001, 0.002, 0.03};
    state.projectorFromCamera = {0.01, -0.07, 0.03, 25.0, -255.0, 60.0};
    state.board = flatBoard(views);
    state.board.terms = {2.0, -1.0, 1.5, 0.5, -0.4, 0.3, 0.6, 0.004};
    state.cameraFromBoard = {{0.55, 0.1, 0.08, -120.0, -90.0, 1000.0}};
    BundleOptions options;
    options.camera.fill(true);
    options.projector.fill(true);
    options.board.fill(true);
    const Eigen::MatrixXd normal = normalMatrixOf(views, {0}, options, state);

    const std::vector<double*> numbers = numbersOf(state);
    ASSERT_EQ(static_cast<Eigen::Index>(numbers.size()), normal.cols());
    Eigen::MatrixXd slopes(errorsOf(views[0], state, options).size(), normal.cols());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const double here = *numbers[i];
        const double step = 1e-6 * std::max(1.0, std::abs(here));
        *numbers[i] = here + step;
        const Eigen::VectorXd above = errorsOf(views[0], state, options);
        *numbers[i] = here - step;
        const Eigen::VectorXd below = errorsOf(views[0], state, options);
        *numbers[i] = here;
        slopes.col(static_cast<Eigen::Index>(i)) = (above - below) / (2.0 * step);
    }
    const Eigen::MatrixXd differences = slopes.transpose() * slopes;
    for (Eigen::Index i = 0; i < normal.rows(); ++i)
        for (Eigen::Index k = 0; k < normal.cols(); ++k)
            EXPECT_NEAR(normal(i, k), differences(i, k), 1e-5 * std::sqrt(differences(i, i) * differences(k, k)))
                << i << " " << k;
}

TEST(Bundle, TheNoiseOfErrorsIsFoundThoughSomeAreStrays) {
    std::mt19937 random(1);
    std::normal_distribution<double> grain(0.0, 0.3);
    std::vector<cv::Point2d> errors;
    for (int i = 0; i < 2000; ++i) errors.emplace_back(grain(random), grain(random));
    EXPECT_NEAR(sigmaOf(errors, 0.0), 0.3, 0.01);
    EXPECT_NEAR(sigmaOf(errors, 1000.0), 0.3 * std::sqrt(4000.0 / 3000.0), 0.012); // what was solved for counts
    errors.emplace_back(500.0, 0.0);
    EXPECT_LT(sigmaOf(errors, 0.0), 0.35);
    EXPECT_EQ(sigmaOf({}, 0.0), 0.0);
}

} // namespace
} // namespace lumorph::test
