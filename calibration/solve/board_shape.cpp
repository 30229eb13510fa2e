#include "calibration/solve/board_shape.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Dense>

namespace lumorph {

namespace {

constexpr double kSureSigmas = 5.0; // all of a lens's faults are not modelled: be slow to blame the board
constexpr double kWarped = 1.0 / 300.0;
constexpr double kStretched = 1.0 / 200.0;

/// Heights over the plane z = 0 of points spread over a board of that frame, row by row of a 9 x 9 grid, by each bend
/// term; the plane through them is taken off.
Eigen::Matrix<double, Eigen::Dynamic, kBoardStretch> heightsByTerm(const std::vector<ViewObservations>& views,
                                                                   const BoardShape& frame) {
    std::vector<cv::Point3d> points;
    for (const ViewObservations& view : views)
        if (view.corners.board.size() > points.size()) points = view.corners.board;
    const auto count = static_cast<Eigen::Index>(points.size());
    Eigen::Matrix<double, Eigen::Dynamic, kBoardStretch> heights(count, static_cast<Eigen::Index>(kBoardStretch));
    Eigen::MatrixXd plane(count, 3);
    for (Eigen::Index i = 0; i < count; ++i) {
        const cv::Point3d& point = points[static_cast<std::size_t>(i)];
        plane.row(i) << 1.0, (point.x - frame.middle.x) / frame.half, (point.y - frame.middle.y) / frame.half;
        for (int term = 0; term < kBoardStretch; ++term) {
            BoardShape unit = frame;
            unit.terms = {};
            unit.terms[static_cast<std::size_t>(term)] = 1.0;
            heights(i, term) = onBoard(unit, {point.x, point.y, 0.0}).z;
        }
    }
    return heights - plane * plane.colPivHouseholderQr().solve(heights);
}

/// The row of the highest less that of the lowest.
Eigen::Matrix<double, 1, kBoardStretch> spanOf(const Eigen::Matrix<double, Eigen::Dynamic, kBoardStretch>& heights,
                                               const BoardShape& board) {
    const Eigen::Map<const Eigen::Matrix<double, kBoardStretch, 1>> terms(board.terms.data());
    const Eigen::VectorXd values = heights * terms;
    Eigen::Index high = 0;
    Eigen::Index low = 0;
    values.maxCoeff(&high);
    values.minCoeff(&low);
    return heights.row(high) - heights.row(low);
}

} // namespace

bool BoardMeasurement::isWarped() const { return bend > kWarped * 2.0 * shape.half && bend > kSureSigmas * bendSigma; }

bool BoardMeasurement::isStretched() const {
    return std::abs(stretch) > kStretched && std::abs(stretch) > kSureSigmas * stretchSigma;
}

double bendOf(const BoardShape& board, const std::vector<ViewObservations>& views) {
    const Eigen::Map<const Eigen::Matrix<double, kBoardStretch, 1>> terms(board.terms.data());
    const auto heights = heightsByTerm(views, board);
    return heights.rows() == 0 ? 0.0 : spanOf(heights, board) * terms;
}

BoardMeasurement measureBoard(const std::vector<ViewObservations>& views, const ProcamCalibration& calibration) {
    ViewChoice use(views.size());
    std::iota(use.begin(), use.end(), 0);
    BundleOptions options = calibration.bundle;
    for (const int i : {kBendUU, kBendUV, kBendVV, kBoardStretch}) options.board[static_cast<std::size_t>(i)] = true;
    BundleState state = calibration.state;
    refine(views, use, options, state);
    const Eigen::MatrixXd covariance = covarianceOf(views, use, options, state).matrix;
    BoardMeasurement measured;
    measured.shape = state.board;
    const auto heights = heightsByTerm(views, state.board);
    if (heights.rows() > 0) {
        const auto span = spanOf(heights, state.board);
        measured.bend = span * Eigen::Map<const Eigen::Matrix<double, kBoardStretch, 1>>(state.board.terms.data());
        measured.bendSigma = std::sqrt(std::max(
            0.0, (span * covariance.block<kBoardStretch, kBoardStretch>(kBoardPlace, kBoardPlace) * span.transpose())
                     .value()));
    }
    constexpr int kStretchPlace = static_cast<int>(kBoardPlace) + static_cast<int>(kBoardStretch);
    measured.stretch = state.board.terms[kBoardStretch];
    measured.stretchSigma = std::sqrt(std::max(0.0, covariance(kStretchPlace, kStretchPlace)));
    return measured;
}

} // namespace lumorph
