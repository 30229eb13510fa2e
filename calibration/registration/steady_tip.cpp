#include "calibration/registration/steady_tip.h"

#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <glm/mat3x3.hpp>

#include "calibration/registration/refusing.h"

namespace lumorph {

namespace {

using registration::eigen;

constexpr double kStretch = 0.8;       ///< seconds
constexpr double kStandsStill = 0.002; ///< metres RMS within which a point stands still
constexpr std::size_t kTogether = 3;   ///< neighbouring stretches that propose a tip
constexpr std::size_t kLeast = 8;      ///< stretches that agree; they overlap by half

/// Poses over a short time, each less their mean: a point of the body at p moves by turns * p + places.
struct Stretch {
    std::vector<Eigen::Matrix3d> turns;
    std::vector<Eigen::Vector3d> places;
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
};

Stretch stretchOf(std::span<const TimedPose> poses) {
    Stretch stretch;
    Eigen::Matrix3d meanTurn = Eigen::Matrix3d::Zero();
    Eigen::Vector3d meanPlace = Eigen::Vector3d::Zero();
    const auto count = static_cast<double>(poses.size());
    for (const TimedPose& at : poses) {
        const glm::dmat3 turn = glm::mat3_cast(at.pose.rotation);
        Eigen::Matrix3d rows;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) rows(r, c) = turn[c][r];
        stretch.turns.push_back(rows);
        stretch.places.push_back(eigen(at.pose.position));
        meanTurn += rows / count;
        meanPlace += stretch.places.back() / count;
    }
    for (std::size_t i = 0; i < poses.size(); ++i) {
        stretch.turns[i] -= meanTurn;
        stretch.places[i] -= meanPlace;
        stretch.normal += stretch.turns[i].transpose() * stretch.turns[i];
        stretch.right -= stretch.turns[i].transpose() * stretch.places[i];
    }
    return stretch;
}

double strayOf(const Stretch& stretch, const Eigen::Vector3d& tip) {
    double squares = 0.0;
    for (std::size_t i = 0; i < stretch.turns.size(); ++i)
        squares += (stretch.turns[i] * tip + stretch.places[i]).squaredNorm();
    return std::sqrt(squares / double(stretch.turns.size()));
}

/// Only what turned about two axes tells the tip.
bool turns(const Eigen::Matrix3d& normal, double poses) {
    const Eigen::Vector3d spread = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(normal / poses).eigenvalues();
    return spread[0] > std::pow(registration::kDegree, 2);
}

std::vector<Stretch> stretchesOf(std::span<const TimedPose> poses) {
    std::vector<Stretch> stretches;
    for (std::size_t from = 0; from < poses.size();) {
        std::size_t to = from;
        const double middle = poses[from].seconds + 0.5 * kStretch;
        while (to < poses.size() && poses[to].seconds - poses[from].seconds < kStretch) ++to;
        if (to - from >= 5) stretches.push_back(stretchOf(poses.subspan(from, to - from)));
        while (from < to && poses[from].seconds < middle) ++from;
    }
    return stretches;
}

/// Solves over the stretches in which `tip` rests; how many they are is in `agree`.
std::optional<Eigen::Vector3d> refined(const std::vector<Stretch>& stretches, const Eigen::Vector3d& tip,
                                       std::size_t& agree) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double poses = 0.0;
    agree = 0;
    for (const Stretch& stretch : stretches)
        if (strayOf(stretch, tip) < kStandsStill) {
            normal += stretch.normal;
            right += stretch.right;
            poses += double(stretch.turns.size());
            ++agree;
        }
    if (agree == 0 || !turns(normal, poses)) return std::nullopt;
    return normal.ldlt().solve(right);
}

} // namespace

std::optional<glm::dvec3> steadyTip(std::span<const TimedPose> poses) {
    const std::vector<Stretch> stretches = stretchesOf(poses);
    std::size_t most = kLeast - 1;
    std::optional<Eigen::Vector3d> best;
    for (std::size_t first = 0; first + kTogether <= stretches.size(); ++first) {
        Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
        Eigen::Vector3d right = Eigen::Vector3d::Zero();
        double count = 0.0;
        for (std::size_t i = first; i < first + kTogether; ++i) {
            normal += stretches[i].normal;
            right += stretches[i].right;
            count += double(stretches[i].turns.size());
        }
        if (!turns(normal, count)) continue;
        std::size_t agree = 0;
        const auto tip = refined(stretches, normal.ldlt().solve(right), agree);
        if (!tip || agree <= most) continue;
        most = agree;
        best = tip;
    }
    std::size_t agree = 0;
    for (int round = 0; round < 5 && best; ++round) best = refined(stretches, *best, agree);
    if (!best) return std::nullopt;
    return glm::dvec3((*best)[0], (*best)[1], (*best)[2]);
}

} // namespace lumorph
