#include "calibration/registration/pivot.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "calibration/registration/refusing.h"
#include "core/base/statistics.h"

namespace lumorph {

namespace {

using registration::kDegree;
using registration::number;

constexpr const char* kSwings = "swings of the pointer";

constexpr double kLeastSwing = 8.0 * kDegree; ///< spread of the swings, in the second direction too
constexpr double kSlipped = 0.015;            ///< metres: the usual straying of a tip that rests nowhere
constexpr double kStrays = 4.0;               ///< times the usual straying
constexpr double kLeastStray = 0.002;         ///< metres: hands tremble
constexpr double kMedianOfNorm = 1.538;       ///< of a normal vector in space with sigma 1

/// How far the swings spread about their mean orientation, radians: about the axis of most, the second, the third.
Eigen::Vector3d spreadOf(const PoseTrack& swings) {
    const glm::dquat middle = swings.poses[swings.poses.size() / 2].pose.rotation;
    std::vector<Eigen::Vector3d> turns;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const TimedPose& at : swings.poses) {
        const glm::dvec3 turn = turnOf(glm::conjugate(middle) * at.pose.rotation);
        turns.emplace_back(turn.x, turn.y, turn.z);
        mean += turns.back() / double(swings.poses.size());
    }
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& turn : turns)
        spread += (turn - mean) * (turn - mean).transpose() / double(turns.size());
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues().cwiseMax(0.0).cwiseSqrt().reverse();
}

void checkSwings(const PoseTrack& swings) {
    if (swings.poses.size() < 20)
        registration::refuse(Cause::tooFewPoints, kSwings, "fewer than 20 poses", "swing it for 10 s or more");
    const Eigen::Vector3d spread = spreadOf(swings);
    if (spread[0] < kLeastSwing)
        registration::refuse(Cause::motionDegenerate, kSwings,
                             "it hardly swung, " + number(spread[0] / kDegree, 1) + " degrees",
                             "swing it by 30 degrees and more to each side, the tip resting in the dimple");
    if (spread[1] < kLeastSwing)
        registration::refuse(Cause::motionDegenerate, kSwings,
                             "it swung about one axis alone: where the tip lies along that stays open",
                             "also swing it across: forwards and back as well as to the left and right");
}

struct Solution {
    Eigen::Matrix<double, 6, 1> at = Eigen::Matrix<double, 6, 1>::Zero(); ///< tip, dimple
    Eigen::Matrix<double, 6, 6> inverse = Eigen::Matrix<double, 6, 6>::Identity();
};

Eigen::Matrix<double, 3, 6> rowsOf(const Pose& pose) {
    const glm::dmat3 r = glm::mat3_cast(pose.rotation);
    Eigen::Matrix<double, 3, 6> rows;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) rows(i, j) = r[j][i];
    rows.rightCols<3>() = -Eigen::Matrix3d::Identity();
    return rows;
}

double strayOf(const Solution& solution, const Pose& pose) {
    const Eigen::Vector3d place(pose.position.x, pose.position.y, pose.position.z);
    return (rowsOf(pose) * solution.at + place).norm();
}

/// Cauchy weights about `usual` metres; of all alike where that is 0.
Solution solve(const PoseTrack& swings, const Solution& before, double usual) {
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
    for (const TimedPose& at : swings.poses) {
        const auto rows = rowsOf(at.pose);
        const double far = usual > 0.0 ? strayOf(before, at.pose) / (2.0 * usual) : 0.0;
        const double weight = far > 0.5 * kStrays ? 0.0 : 1.0 / (1.0 + far * far);
        normal += weight * rows.transpose() * rows;
        right -=
            weight * rows.transpose() * Eigen::Vector3d(at.pose.position.x, at.pose.position.y, at.pose.position.z);
    }
    return {normal.ldlt().solve(right), normal.inverse()};
}

double usualStray(const PoseTrack& swings, const Solution& solution) {
    std::vector<double> strays;
    for (const TimedPose& at : swings.poses) strays.push_back(strayOf(solution, at.pose));
    return std::max(1e-7, median(strays) / kMedianOfNorm);
}

/// Stretches of poses that stray, as findings with their times.
void tellSlips(Pivot& pivot, const PoseTrack& swings, const Solution& solution, double limit) {
    const double begin = swings.poses.front().seconds;
    for (std::size_t i = 0; i < swings.poses.size(); ++i) {
        if (strayOf(solution, swings.poses[i].pose) < limit) continue;
        const std::size_t first = i;
        double farthest = 0.0;
        std::size_t strays = 0;
        for (std::size_t calm = 0; i < swings.poses.size() && calm < 10; ++i) {
            const double stray = strayOf(solution, swings.poses[i].pose);
            calm = stray < limit ? calm + 1 : 0;
            strays += calm == 0 ? 1 : 0;
            farthest = std::max(farthest, stray);
        }
        if (strays < 5) continue; // single poses err now and then
        const std::size_t last = std::min(i, swings.poses.size()) - 1;
        pivot.warnings.push_back({Cause::tipSlipped,
                                  kSwings,
                                  {},
                                  "from " + number(swings.poses[first].seconds - begin, 1) + " s to " +
                                      number(swings.poses[last].seconds - begin, 1) + " s the tip was up to " +
                                      number(1000.0 * farthest, 1) + " mm beside its dimple",
                                  "these poses count for nothing; keep the tip in the dimple"});
    }
}

} // namespace

Pivot solvePivot(const PoseTrack& swings) {
    checkSwings(swings);
    Solution solution = solve(swings, {}, 0.0);
    double usual = usualStray(swings, solution);
    for (int round = 0; round < 10; ++round) {
        solution = solve(swings, solution, usual);
        usual = usualStray(swings, solution);
    }
    if (usual > kSlipped)
        registration::refuse(Cause::tipSlipped, kSwings,
                             "the tip rested nowhere: it strays by " + number(1000.0 * usual, 0) + " mm",
                             "keep the tip in one dimple, and see that the pointer's markers do not shift");
    const double limit = std::max(kLeastStray, kStrays * usual);
    Pivot pivot;
    double squares = 0.0;
    for (const TimedPose& at : swings.poses)
        if (const double stray = strayOf(solution, at.pose); stray < limit) {
            squares += stray * stray;
            ++pivot.poses;
        }
    pivot.tip = {solution.at[0], solution.at[1], solution.at[2]};
    pivot.dimple = {solution.at[3], solution.at[4], solution.at[5]};
    pivot.rms = std::sqrt(squares / double(std::max<std::size_t>(1, pivot.poses)));
    // Neighbouring poses err alike: as if one in five were independent.
    const double sigma = std::sqrt(5.0 / 3.0) * pivot.rms;
    for (int i = 0; i < 3; ++i) pivot.tipSigma[i] = sigma * std::sqrt(std::max(0.0, solution.inverse(i, i)));
    tellSlips(pivot, swings, solution, limit);
    pivot.warnings.insert(pivot.warnings.end(), swings.warnings.begin(), swings.warnings.end());
    return pivot;
}

} // namespace lumorph
