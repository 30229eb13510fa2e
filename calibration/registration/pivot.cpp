#include "calibration/registration/pivot.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "calibration/registration/refusing.h"
#include "calibration/registration/time_unit.h"
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
constexpr std::size_t kSlideParts = 8;        ///< of the recording, each with a dimple of its own
constexpr double kLeastSlide = 0.003;         ///< metres
constexpr double kSlideExplains = 0.9;        ///< of the straying, at most, is left by a dimple that slid

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

/// A dimple for each part of the recording, and one tip: of a dimple that was pushed about meanwhile.
struct Slide {
    glm::dvec3 tip{0.0}, tipSigma{0.0};
    std::vector<glm::dvec3> dimples;
    std::vector<double> strays; ///< of all poses, metres
    double usual = 0.0;
    double by = 0.0, sigma = 0.0; ///< metres between the two dimples that are farthest apart
};

std::size_t partOf(std::size_t pose, std::size_t poses) { return pose * kSlideParts / poses; }

/// As of `solve`, of the poses that do not stray farther than `limit` in `before`.
Slide solveSlide(const PoseTrack& swings, const Solution& before, double limit) {
    constexpr Eigen::Index kTip = 3, kAll = kTip + 3 * Eigen::Index(kSlideParts);
    const std::size_t count = swings.poses.size();
    Slide slide;
    std::vector<double> weights(count, 1.0);
    for (std::size_t i = 0; i < count; ++i) weights[i] = strayOf(before, swings.poses[i].pose) < limit ? 1.0 : 0.0;
    Eigen::MatrixXd normal;
    for (int round = 0; round < 6; ++round) {
        normal = 1e-9 * Eigen::MatrixXd::Identity(kAll, kAll); // a part of which nothing counts
        Eigen::VectorXd right = Eigen::VectorXd::Zero(kAll);
        for (std::size_t i = 0; i < count; ++i) {
            const Eigen::Index at = kTip + 3 * Eigen::Index(partOf(i, count));
            const Eigen::Matrix<double, 3, 6> rows = rowsOf(swings.poses[i].pose);
            const Eigen::Matrix3d turn = rows.leftCols<3>();
            const Eigen::Vector3d place = registration::eigen(swings.poses[i].pose.position);
            normal.topLeftCorner<3, 3>() += weights[i] * Eigen::Matrix3d::Identity();
            normal.block<3, 3>(0, at) -= weights[i] * turn.transpose();
            normal.block<3, 3>(at, 0) -= weights[i] * turn;
            normal.block<3, 3>(at, at) += weights[i] * Eigen::Matrix3d::Identity();
            right.head<3>() -= weights[i] * turn.transpose() * place;
            right.segment<3>(at) += weights[i] * place;
        }
        const Eigen::VectorXd solved = normal.ldlt().solve(right);
        slide.tip = {solved[0], solved[1], solved[2]};
        slide.dimples.clear();
        for (Eigen::Index at = kTip; at < kAll; at += 3)
            slide.dimples.emplace_back(solved[at], solved[at + 1], solved[at + 2]);
        slide.strays.clear();
        for (std::size_t i = 0; i < count; ++i)
            slide.strays.push_back(glm::distance(swings.poses[i].pose * slide.tip, slide.dimples[partOf(i, count)]));
        slide.usual = std::max(1e-7, median(slide.strays) / kMedianOfNorm);
        for (std::size_t i = 0; i < count; ++i) {
            const double far = slide.strays[i] / (2.0 * slide.usual);
            weights[i] = far > 0.5 * kStrays ? 0.0 : 1.0 / (1.0 + far * far);
        }
    }
    // Neighbouring poses err alike: as if one in five were independent.
    const Eigen::MatrixXd inverse = 5.0 * slide.usual * slide.usual * normal.inverse();
    for (int i = 0; i < 3; ++i) slide.tipSigma[i] = std::sqrt(std::max(0.0, inverse(i, i)));
    for (std::size_t i = 0; i < kSlideParts; ++i)
        for (std::size_t k = 0; k < i; ++k) {
            const double far = glm::distance(slide.dimples[i], slide.dimples[k]);
            if (far <= slide.by) continue;
            const Eigen::Index at = kTip + 3 * Eigen::Index(i), from = kTip + 3 * Eigen::Index(k);
            slide.by = far;
            slide.sigma =
                std::sqrt(std::max(0.0, inverse.block<3, 3>(at, at).trace() + inverse.block<3, 3>(from, from).trace() -
                                            2.0 * inverse.block<3, 3>(at, from).trace()));
        }
    return slide;
}

Finding slid(const Slide& slide) {
    return {Cause::tipSlipped,
            kSwings,
            {},
            "the dimple slid by " + number(1000.0 * slide.by, 1) + " mm while the pointer swung",
            "the tip was solved with a dimple of its own for each eighth of the time; fix what the dimple is in, and "
            "swing again"};
}

/// Stretches of poses that stray, as findings with their times.
void tellSlips(Pivot& pivot, const PoseTrack& swings, const std::vector<double>& strays, double limit) {
    const double begin = swings.poses.front().seconds, second = likelyTimeUnit(swings).seconds;
    const auto since = [&](std::size_t pose) {
        return number((swings.poses[pose].seconds - begin) * second, 1) + " s";
    };
    for (std::size_t i = 0; i < swings.poses.size(); ++i) {
        if (strays[i] < limit) continue;
        const std::size_t first = i;
        double farthest = 0.0;
        std::size_t count = 0;
        for (std::size_t calm = 0; i < swings.poses.size() && calm < 10; ++i) {
            calm = strays[i] < limit ? calm + 1 : 0;
            count += calm == 0 ? 1 : 0;
            farthest = std::max(farthest, strays[i]);
        }
        if (count < 5) continue; // single poses err now and then
        const std::size_t last = std::min(i, swings.poses.size()) - 1;
        pivot.warnings.push_back({Cause::tipSlipped,
                                  kSwings,
                                  {},
                                  "from " + since(first) + " to " + since(last) + " the tip was up to " +
                                      number(1000.0 * farthest, 1) + " mm beside its dimple",
                                  "these poses count for nothing; keep the tip in the dimple"});
    }
}

/// Root mean square of what does not stray.
void judgeStrays(Pivot& pivot, const std::vector<double>& strays, double limit) {
    double squares = 0.0;
    for (const double stray : strays)
        if (stray < limit) {
            squares += stray * stray;
            ++pivot.poses;
        }
    pivot.rms = std::sqrt(squares / double(std::max<std::size_t>(1, pivot.poses)));
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
    double limit = std::max(kLeastStray, kStrays * usual);
    std::vector<double> strays;
    for (const TimedPose& at : swings.poses) strays.push_back(strayOf(solution, at.pose));
    Pivot pivot;
    const Slide slide = solveSlide(swings, solution, limit);
    if (slide.by > std::max(kLeastSlide, 5.0 * slide.sigma) && slide.usual < kSlideExplains * usual) {
        limit = std::max(kLeastStray, kStrays * slide.usual);
        strays = slide.strays;
        judgeStrays(pivot, strays, limit);
        pivot.tip = slide.tip;
        pivot.dimple = slide.dimples.back();
        pivot.tipSigma = slide.tipSigma;
        pivot.warnings.push_back(slid(slide));
    } else {
        judgeStrays(pivot, strays, limit);
        pivot.tip = {solution.at[0], solution.at[1], solution.at[2]};
        pivot.dimple = {solution.at[3], solution.at[4], solution.at[5]};
        // Neighbouring poses err alike: as if one in five were independent.
        const double sigma = std::sqrt(5.0 / 3.0) * pivot.rms;
        for (int i = 0; i < 3; ++i) pivot.tipSigma[i] = sigma * std::sqrt(std::max(0.0, solution.inverse(i, i)));
    }
    tellSlips(pivot, swings, strays, limit);
    pivot.warnings.insert(pivot.warnings.end(), swings.warnings.begin(), swings.warnings.end());
    return pivot;
}

} // namespace lumorph
