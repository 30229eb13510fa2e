#include "calibration/registration/hand_eye.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

#include "calibration/registration/clock_offset.h"
#include "calibration/registration/hand_eye_fit.h"
#include "calibration/registration/refusing.h"
#include "core/base/statistics.h"

namespace lumorph {

namespace {

using registration::eigen;
using registration::kDegree;
using registration::number;

constexpr const char* kBodies = "recordings of two bodies";

using hand_eye::Deviation;
using hand_eye::Fit;
using hand_eye::Place;
using hand_eye::Range;
using hand_eye::Unknowns;

constexpr double kLeastCorrelation = 0.5;      ///< of angular speeds: below, they are of two bodies
constexpr double kLeastTurn = 8.0 * kDegree;   ///< spread of relative turns about the axis of most
constexpr double kLeastAcross = 5.0 * kDegree; ///< and about the second
constexpr std::size_t kMostPairs = 6000;
constexpr double kJump = 0.05;     ///< seconds by which a clock that runs evenly does not err
constexpr std::size_t kBlocks = 8; ///< of the recording, for sigmas

/// Poses of both at the same moments.
struct Both {
    Pose a, b;
};

std::vector<Both> together(const PoseTrack& a, const PoseTrack& b, double timeOffset) {
    std::vector<Both> both;
    for (const TimedPose& pose : b.poses)
        if (const auto at = poseAt(a, pose.seconds - timeOffset)) both.push_back({*at, pose.pose});
    return both;
}

/// Relative motions of both between two moments: X A = B X.
struct Motion {
    Pose a, b;
    glm::dvec3 turnA{0.0}, turnB{0.0};
};

/// Pairs of moments at many distances in time, which turn enough to tell something.
std::vector<Motion> motionsOf(const std::vector<Both>& both) {
    std::vector<Motion> motions;
    const std::size_t n = both.size();
    const std::size_t stride = std::max<std::size_t>(1, n * 10 / kMostPairs);
    for (std::size_t i = 0; i < n; i += stride)
        for (std::size_t k = 1; k <= 10; ++k) {
            const std::size_t j = i + std::max<std::size_t>(k, k * k * n / 200);
            if (j >= n) break;
            Motion m;
            m.a = inverseOf(both[i].a) * both[j].a;
            m.b = inverseOf(both[i].b) * both[j].b;
            m.turnA = turnOf(m.a.rotation);
            m.turnB = turnOf(m.b.rotation);
            if (glm::length(m.turnA) < 3.0) motions.push_back(m); // near a half turn the axis may be either
        }
    return motions;
}

/// Turning about one axis alone tells neither the other angle nor the place along it.
void checkTurns(const std::vector<Motion>& motions, const std::vector<Both>& both) {
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Motion& m : motions) spread += eigen(m.turnA) * eigen(m.turnA).transpose();
    spread /= std::max<double>(1.0, double(motions.size()));
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
    const double most = std::sqrt(std::max(0.0, axes.eigenvalues()[2]));
    const double second = std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
    if (most < kLeastTurn)
        registration::refuse(Cause::motionDegenerate, kBodies,
                             "the bodies hardly turned, " + number(most / kDegree, 1) + " degrees",
                             "turn them by 30 degrees and more about two axes, not only move them");
    if (second >= kLeastAcross) return;
    // Named in the world of A where it is upright or lies; worlds of ours have Y up.
    glm::dvec3 axis(axes.eigenvectors()(0, 2), axes.eigenvectors()(1, 2), axes.eigenvectors()(2, 2));
    axis = both.front().a.rotation * axis;
    const bool upright = std::abs(axis.y) > 0.94;
    registration::refuse(Cause::motionDegenerate, kBodies,
                         "the bodies turned about one axis alone, (" + number(axis.x, 2) + ", " + number(axis.y, 2) +
                             ", " + number(axis.z, 2) + ") in the world of the first" +
                             (upright ? ", which is upright" : ""),
                         upright ? "also tilt them forwards and sideways by 20 degrees and more"
                                 : "also turn them about the vertical axis by 30 degrees and more");
}

/// Motions whose turns have the same angle: only those can be of one body.
std::vector<Motion> agreeing(const std::vector<Motion>& motions) {
    std::vector<double> differences;
    const auto difference = [](const Motion& m) { return std::abs(glm::length(m.turnA) - glm::length(m.turnB)); };
    for (const Motion& m : motions) differences.push_back(difference(m));
    const double usual = std::max(0.2 * kDegree, median(differences));
    std::vector<Motion> kept;
    std::ranges::copy_if(motions, std::back_inserter(kept),
                         [&](const Motion& m) { return difference(m) < 3.0 * usual; });
    if (usual > 10.0 * kDegree)
        registration::refuse(Cause::modelDoesNotFit, kBodies,
                             "they do not turn alike: angles differ by " + number(usual / kDegree, 0) + " degrees",
                             "record two bodies that are joined rigidly, and see that the tracker does not swap them");
    return kept;
}

/// turnB = R turnA, in closed form; motions that contradict it are left out of `motions`.
glm::dquat rotationOf(std::vector<Motion>& motions) {
    glm::dquat rotation(1.0, 0.0, 0.0, 0.0);
    double limit = 1e9;
    for (int round = 0; round < 3; ++round) {
        Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
        std::vector<double> left;
        for (const Motion& m : motions) {
            const double error = glm::length(m.turnB - rotation * m.turnA);
            if (error < limit) cross += eigen(m.turnB) * eigen(m.turnA).transpose();
        }
        const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
        const double hand = (svd.matrixU() * svd.matrixV().transpose()).determinant();
        const Eigen::Quaterniond q(
            Eigen::Matrix3d(svd.matrixU() * Eigen::Vector3d(1.0, 1.0, hand).asDiagonal() * svd.matrixV().transpose()));
        rotation = {q.w(), q.x(), q.y(), q.z()};
        for (const Motion& m : motions) left.push_back(glm::length(m.turnB - rotation * m.turnA));
        limit = 3.0 * std::max(0.1 * kDegree, median(left));
    }
    std::erase_if(motions, [&](const Motion& m) { return glm::length(m.turnB - rotation * m.turnA) >= limit; });
    return rotation;
}

/// The place of A in B, and by how much A's unit of length is too long: (R_B - 1) t - s R t_A = -t_B, least squares
/// with weights that spare what fits badly.
struct PlaceFit {
    glm::dvec3 place{0.0};
    double scale = 1.0, scaleSigma = 0.0;
    double left = 0.0; ///< median of what is left, metres
};
PlaceFit placeOf(const std::vector<Motion>& motions, const glm::dquat& bFromA) {
    PlaceFit fit;
    double usual = 1e9;
    for (int round = 0; round < 6; ++round) {
        Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
        Eigen::Vector4d right = Eigen::Vector4d::Zero();
        Eigen::Vector4d solution(fit.place.x, fit.place.y, fit.place.z, fit.scale);
        const auto rowsOf = [&](const Motion& m) {
            Eigen::Matrix<double, 3, 4> rows;
            const Eigen::Quaterniond turn(m.b.rotation.w, m.b.rotation.x, m.b.rotation.y, m.b.rotation.z);
            rows.leftCols<3>() = turn.toRotationMatrix() - Eigen::Matrix3d::Identity();
            rows.col(3) = -eigen(bFromA * m.a.position);
            return rows;
        };
        for (const Motion& m : motions) {
            const auto rows = rowsOf(m);
            const double error = round == 0 ? 0.0 : (rows * solution + eigen(m.b.position)).norm() / usual;
            const double weight = 1.0 / (1.0 + error * error);
            normal += weight * rows.transpose() * rows;
            right -= weight * rows.transpose() * eigen(m.b.position);
        }
        solution = normal.ldlt().solve(right);
        std::vector<double> left;
        for (const Motion& m : motions) left.push_back((rowsOf(m) * solution + eigen(m.b.position)).norm());
        usual = std::max(1e-6, median(left));
        fit = {{solution[0], solution[1], solution[2]}, solution[3], 0.0, usual};
        // Pairs share poses: as if a tenth of them were independent.
        fit.scaleSigma = usual * std::sqrt(10.0 * std::max(0.0, normal.inverse()(3, 3)));
    }
    return fit;
}

Pose worldsOf(const std::vector<Both>& both, const Pose& bFromA) {
    std::vector<double> x, y, z;
    Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
    for (const Both& at : both) {
        const Pose world = at.b * bFromA * inverseOf(at.a);
        x.push_back(world.position.x);
        y.push_back(world.position.y);
        z.push_back(world.position.z);
        const Eigen::Vector4d q(world.rotation.w, world.rotation.x, world.rotation.y, world.rotation.z);
        sum += q * q.transpose();
    }
    // The mean of rotations whatever their signs (Markley et al. 2007).
    const Eigen::Vector4d q = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(sum).eigenvectors().col(3);
    return {{median(x), median(y), median(z)}, {q[0], q[1], q[2], q[3]}};
}

Unknowns closedForm(const PoseTrack& a, const PoseTrack& b, double offset) {
    const std::vector<Both> both = together(a, b, offset);
    if (both.size() < 20)
        registration::refuse(Cause::tooFewPoints, kBodies, "they share fewer than 20 moments",
                             "record both at the same time, for 20 s or more");
    const std::vector<Motion> all = motionsOf(both);
    checkTurns(all, both);
    std::vector<Motion> motions = agreeing(all);
    const glm::dquat rotation = rotationOf(motions);
    const PlaceFit place = placeOf(motions, rotation);
    if (place.scale < -3.0 * place.scaleSigma && place.scale < -0.5)
        registration::refuse(Cause::mirrored, kBodies,
                             "they fit only as mirror images: one of the two worlds is left-handed",
                             "turn one of them into right-handed coordinates: negate z, qx and qy");
    if (std::abs(place.scale - 1.0) > std::max(0.1, 6.0 * place.scaleSigma))
        registration::refuse(Cause::wrongUnits, kBodies,
                             "the second's places are " + number(place.scale, place.scale < 0.1 ? 4 : 2) +
                                 " times as large as the first's",
                             "write both in metres");
    const Pose bFromA{place.place, rotation};
    return {bFromA, worldsOf(both, bFromA), offset};
}

double turnBetween(const Pose& a, const Pose& b) { return angleOf(glm::conjugate(a.rotation) * b.rotation); }

/// What the recording says of its own worth.
void judge(HandEye& result, const Fit& fit, const Unknowns& solved, Place place, std::size_t poses,
           const Progress& progress) {
    const auto half = [&](Range use) { return fit.refined(solved, place, use).bFromA; };
    const Pose first = half({0, poses / 2}), second = half({poses / 2, poses});
    result.halvesTurn = turnBetween(first, second);
    result.halvesShift = glm::length(first.position - second.position);
    double turn = 0.0, shift = 0.0, offset = 0.0;
    for (std::size_t block = 0; block < kBlocks; ++block) {
        progress.throwIfCancelled();
        progress.report(0.4 + 0.6 * double(block) / double(kBlocks), "how sure it is");
        const Range leave{block * poses / kBlocks, (block + 1) * poses / kBlocks};
        const Unknowns without = fit.refined(solved, place, {0, poses}, leave);
        const double share = double(kBlocks - 1) / double(kBlocks); // jackknife
        turn += share * std::pow(turnBetween(without.bFromA, solved.bFromA), 2);
        shift += share * glm::dot(without.bFromA.position - solved.bFromA.position,
                                  without.bFromA.position - solved.bFromA.position);
        offset += share * std::pow(without.timeOffset - solved.timeOffset, 2);
    }
    result.turnSigma = std::sqrt(turn);
    result.shiftSigma = std::sqrt(shift);
    result.offsetSigma = std::sqrt(offset);
}

[[noreturn]] void refuseJump(double by, double from) {
    registration::refuse(Cause::clockJumps, kBodies,
                         "their clocks differ by " + number(by * 1000.0, 0) + " ms more or less from about " +
                             number(from, 0) + " s on",
                         "record again while both clocks run evenly, or cut the recording there");
}

/// A clock that jumped shows as another offset from there on.
void checkClocks(const Fit& fit, const PoseTrack& b, const Unknowns& solved, Place place) {
    std::vector<double> offsets;
    const std::size_t poses = b.poses.size();
    for (std::size_t block = 0; block < kBlocks; ++block)
        offsets.push_back(
            fit.refined(solved, place, {block * poses / kBlocks, (block + 1) * poses / kBlocks}, {}, true).timeOffset);
    const double usual = median(offsets);
    std::vector<double> from;
    for (const double offset : offsets) from.push_back(std::abs(offset - usual));
    const double spread = std::max(0.004, median(from));
    for (std::size_t cut = 1; cut < kBlocks; ++cut) {
        const std::vector<double> before(offsets.begin(), offsets.begin() + std::ptrdiff_t(cut));
        const std::vector<double> after(offsets.begin() + std::ptrdiff_t(cut), offsets.end());
        const auto [lowB, highB] = std::ranges::minmax(before);
        const auto [lowA, highA] = std::ranges::minmax(after);
        const double apart = std::max(lowA - highB, lowB - highA);
        if (apart > std::max(kJump, 2.0 * std::max({highB - lowB, highA - lowA, spread})) && before.size() > 1 &&
            after.size() > 1)
            registration::refuse(
                Cause::clockJumps, kBodies,
                "their clocks differ by " + number(apart * 1000.0, 0) + " ms more or less from about " +
                    number(b.poses[cut * poses / kBlocks].seconds - b.poses.front().seconds, 0) + " s on",
                "record again while both clocks run evenly, or cut the recording there");
    }
}

/// Clocks that jump by much spoil everything; quarters of the recording still tell their own offsets.
[[noreturn]] void explainMisfit(const HandEye& result, const PoseTrack& a, const PoseTrack& b) {
    constexpr std::size_t kQuarters = 4;
    std::optional<double> before;
    for (std::size_t k = 0; k < kQuarters; ++k) {
        PoseTrack quarter;
        const std::size_t n = b.poses.size();
        quarter.poses.assign(b.poses.begin() + std::ptrdiff_t(k * n / kQuarters),
                             b.poses.begin() + std::ptrdiff_t((k + 1) * n / kQuarters));
        const ClockOffset clocks = clockOffset(a, quarter);
        if (clocks.correlation < 0.9) continue;
        if (before && std::abs(clocks.seconds - *before) > kJump)
            refuseJump(std::abs(clocks.seconds - *before), quarter.poses.front().seconds - b.poses.front().seconds);
        before = clocks.seconds;
    }
    registration::refuse(Cause::modelDoesNotFit, kBodies,
                         "they do not move as one: poses differ by " + number(result.medianTurn / kDegree, 1) +
                             " degrees and " + number(1000.0 * result.medianShift, 0) + " mm",
                         "join the bodies rigidly, and see that the tracker does not swap them");
}

/// Stretches in which B is elsewhere than A says.
void tellStrays(HandEye& result, const std::vector<Deviation>& deviations, const PoseTrack& b) {
    const double far = std::max(0.02, 12.0 * result.medianShift),
                 turned = std::max(3.0 * kDegree, 12.0 * result.medianTurn);
    std::size_t strays = 0;
    double first = 0.0, last = 0.0;
    for (const Deviation& d : deviations) {
        if (glm::length(d.place) < far && glm::length(d.turn) < turned) continue;
        last = b.poses[d.pose].seconds - b.poses.front().seconds;
        if (strays++ == 0) first = last;
    }
    if (strays < 5) return;
    result.warnings.push_back({Cause::bodySwapped,
                               kBodies,
                               {},
                               std::to_string(strays) + " of " + std::to_string(deviations.size()) + " poses, from " +
                                   number(first, 1) + " s to " + number(last, 1) +
                                   " s, are of somewhere else; they count for nothing",
                               "see that the tracker neither swaps bodies nor takes reflections for markers"});
}

HandEye solveSparse(const PoseTrack& a, const PoseTrack& b, const Progress& progress) {
    progress.report(0.0, "clocks");
    const ClockOffset clocks = clockOffset(a, b);
    progress.throwIfCancelled();
    if (clocks.correlation < kLeastCorrelation)
        registration::refuse(
            Cause::clocksUnknown, kBodies,
            "their speeds of turning agree at no offset of the clocks (at best " + number(clocks.correlation, 2) + ")",
            "record both at the same time, joined rigidly, and turn them now fast, now slowly, for 20 s or more");
    progress.report(0.2, "joint");
    Unknowns solved = closedForm(a, b, clocks.seconds);
    const Fit fit(a, b);
    const Range all{0, b.poses.size()};
    const auto as = [&](Place place) { return fit.refined(solved, place, all); };
    const Unknowns byBody = as(Place::body), byOrigin = as(Place::origin);
    const auto likely = [&](const Unknowns& u, Place place) {
        return hand_eye::Noise(fit.deviations(u), b, place).logarithm();
    };
    const Place place = likely(byBody, Place::body) <= likely(byOrigin, Place::origin) ? Place::body : Place::origin;
    solved = place == Place::body ? byBody : byOrigin;

    HandEye result;
    result.bFromA = solved.bFromA;
    result.worldBFromWorldA = solved.worldBFromWorldA;
    result.timeOffset = solved.timeOffset;
    const std::vector<Deviation> deviations = fit.deviations(solved);
    std::vector<double> turns, shifts;
    for (const Deviation& d : deviations) {
        turns.push_back(glm::length(d.turn));
        shifts.push_back(glm::length(d.place));
    }
    result.poses = deviations.size();
    result.medianTurn = median(turns);
    result.medianShift = median(shifts);
    if (result.medianTurn > 6.0 * kDegree || result.medianShift > 0.08) explainMisfit(result, a, b);
    checkClocks(fit, b, solved, place);
    if (clocks.runnerUp > 0.98)
        result.warnings.push_back({Cause::clocksUnknown,
                                   kBodies,
                                   {},
                                   "another offset of the clocks agrees nearly as well",
                                   "turn the bodies less regularly"});
    tellStrays(result, deviations, b);
    judge(result, fit, solved, place, b.poses.size(), progress);
    return result;
}

double rateOf(const PoseTrack& track) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < track.poses.size(); ++i)
        steps.push_back(track.poses[i].seconds - track.poses[i - 1].seconds);
    return steps.empty() ? 0.0 : 1.0 / median(steps);
}

} // namespace

HandEye solveHandEye(const PoseTrack& a, const PoseTrack& b, const Progress& progress) {
    for (const PoseTrack* track : {&a, &b})
        if (track->poses.size() < 20)
            registration::refuse(Cause::tooFewPoints, kBodies, "a recording has fewer than 20 poses",
                                 "record both for 20 s or more");
    HandEye result;
    if (rateOf(a) >= rateOf(b)) {
        result = solveSparse(a, b, progress);
    } else { // the one with fewer is compared with the other, which is interpolated
        result = solveSparse(b, a, progress);
        result.bFromA = inverseOf(result.bFromA);
        result.worldBFromWorldA = inverseOf(result.worldBFromWorldA);
        result.timeOffset = -result.timeOffset;
    }
    for (const PoseTrack* track : {&a, &b})
        result.warnings.insert(result.warnings.end(), track->warnings.begin(), track->warnings.end());
    return result;
}

} // namespace lumorph
