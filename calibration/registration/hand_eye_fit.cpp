#include "calibration/registration/hand_eye_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <glm/geometric.hpp>

#include "core/base/statistics.h"

namespace lumorph::hand_eye {

namespace {

constexpr int kUnknowns = 14;
constexpr int kOffset = 12, kDrift = 13; // of the unknowns; the drift as what it makes of the offset until the end
constexpr double kUsualDrift = 1e-4;     // of a clock
constexpr int kRounds = 12;
constexpr std::size_t kLeastOfRing = 10;                // poses
constexpr double kMedianOfNorm = 1.538;                 ///< of a normal vector in space with sigma 1
constexpr double kLeastTurn = 1e-6, kLeastPlace = 1e-7; ///< noise below which numbers end
constexpr double kCauchy = 2.4;                         ///< sigmas of a vector's part
using Vector = Eigen::Matrix<double, kUnknowns, 1>;
using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Slopes = Eigen::Matrix<double, 6, kUnknowns>;

Pose stepOf(const double* d) { return {{d[3], d[4], d[5]}, rotationOfTurn({d[0], d[1], d[2]})}; }

Unknowns moved(const Unknowns& u, const Vector& d, double halfSpan) {
    Unknowns next{u.bFromA * stepOf(d.data()), stepOf(d.data() + 6) * u.worldBFromWorldA, u.clocks};
    next.clocks.seconds += d[kOffset];
    next.clocks.drift += d[kDrift] / halfSpan;
    return next;
}

const glm::dvec3& placeOf(const Deviation& d, Place place) { return place == Place::body ? d.place : d.origin; }

double distanceOf(const TimedPose& pose) { return glm::length(pose.pose.position); }

/// Weight of a vector of this length under Cauchy's function, over its variance.
double weightOf(const glm::dvec3& error, double sigma) {
    const double far = glm::length(error) / (std::sqrt(3.0) * sigma * kCauchy);
    return 1.0 / (sigma * sigma * (1.0 + far * far));
}

} // namespace

Noise::Noise(std::span<const Deviation> deviations, const PoseTrack& b, Place place) {
    std::vector<const Deviation*> byDistance;
    for (const Deviation& d : deviations) byDistance.push_back(&d);
    const auto distance = [&](const Deviation* d) { return distanceOf(b.poses[d->pose]); };
    std::ranges::sort(byDistance, {}, distance);
    rings_ = std::clamp<std::size_t>(byDistance.size() / kLeastOfRing, 1, kRings);
    for (std::size_t ring = 0; ring < rings_; ++ring) {
        const std::size_t from = ring * byDistance.size() / rings_, to = (ring + 1) * byDistance.size() / rings_;
        std::vector<double> turns, places;
        for (std::size_t i = from; i < to; ++i) {
            turns.push_back(glm::length(byDistance[i]->turn));
            places.push_back(glm::length(placeOf(*byDistance[i], place)));
        }
        farthest_[ring] = to > from ? distance(byDistance[to - 1]) : 0.0;
        turns_[ring] = std::max(kLeastTurn, median(turns) / kMedianOfNorm);
        places_[ring] = std::max(kLeastPlace, median(places) / kMedianOfNorm);
        logarithm_ += (std::log(turns_[ring]) + std::log(places_[ring])) / double(rings_);
    }
}

double Noise::at(const std::array<double, kRings>& of, double distance) const {
    std::size_t ring = 0;
    while (ring + 1 < rings_ && distance > farthest_[ring]) ++ring;
    return of[ring];
}

std::optional<Deviation> Fit::deviation(const Unknowns& unknowns, std::size_t pose) const {
    const auto a = poseAt(a_, unknowns.clocks.toA(b_.poses[pose].seconds));
    return a ? std::optional(deviationFrom(*a, unknowns, pose)) : std::nullopt;
}

Deviation Fit::deviationFrom(const Pose& a, const Unknowns& unknowns, std::size_t pose) const {
    const TimedPose& seen = b_.poses[pose];
    const Pose told = unknowns.worldBFromWorldA * a * inverseOf(unknowns.bFromA);
    Deviation d;
    d.pose = pose;
    d.turn = turnOf(glm::conjugate(seen.pose.rotation) * told.rotation);
    d.place = told.position - seen.pose.position;
    d.origin = inverseOf(told).position - inverseOf(seen.pose).position;
    return d;
}

std::vector<Deviation> Fit::deviations(const Unknowns& unknowns) const {
    std::vector<Deviation> all;
    for (std::size_t i = 0; i < b_.poses.size(); ++i)
        if (const auto d = deviation(unknowns, i)) all.push_back(*d);
    return all;
}

double Fit::offsetSigma(const Unknowns& unknowns, Place place, Range use) const {
    constexpr double kStep = 0.04, kAlike = 5.0; // seconds; neighbouring poses err alike
    // What noise alone makes of both squares, where it is of A: of two poses, along three axes.
    constexpr double kByNoise = 2.0 * 2.0 * 3.0 / (4.0 * kStep * kStep);
    std::vector<Deviation> all = deviations(unknowns);
    std::erase_if(all, [&](const Deviation& d) { return !use.has(d.pose); });
    if (all.empty()) return std::numeric_limits<double>::infinity();
    const Noise noise(all, b_, place);
    Unknowns more = unknowns, less = unknowns;
    more.clocks.seconds += kStep;
    less.clocks.seconds -= kStep;
    double sure = 0.0;
    for (const Deviation& d : all) {
        const auto up = deviation(more, d.pose), down = deviation(less, d.pose);
        if (!up || !down) continue;
        const double distance = distanceOf(b_.poses[d.pose]);
        const double turn = glm::length(up->turn - down->turn) / (2.0 * kStep * noise.turn(distance));
        const double moves =
            glm::length(placeOf(*up, place) - placeOf(*down, place)) / (2.0 * kStep * noise.place(distance));
        sure += turn * turn + moves * moves - kByNoise;
    }
    return std::sqrt(kAlike / std::max(sure, 1e-12));
}

Unknowns Fit::refined(Unknowns u, Place place, Range use, Range leave, Free free) const {
    constexpr double kStep = 1e-6; // of a central difference: radians, metres, seconds
    const bool offsetAlone = free == Free::offset;
    const std::size_t least = free == Free::poses ? 4 : 10;
    for (int round = 0; round < kRounds; ++round) {
        progress_.throwIfCancelled();
        std::vector<Deviation> all = deviations(u);
        std::erase_if(all, [&](const Deviation& d) { return !use.has(d.pose) || leave.has(d.pose); });
        if (all.size() < least) break;
        const Noise noise(all, b_, place);
        std::array<Unknowns, kUnknowns> more, less;
        for (int k = 0; k < kUnknowns; ++k) {
            more[static_cast<std::size_t>(k)] = moved(u, kStep * Vector::Unit(k), halfSpan_);
            less[static_cast<std::size_t>(k)] = moved(u, -kStep * Vector::Unit(k), halfSpan_);
        }
        Matrix normal = Matrix::Zero();
        Vector right = Vector::Zero();
        for (const Deviation& d : all) {
            Slopes slopes = Slopes::Zero();
            bool whole = true;
            const int first = offsetAlone ? kOffset : 0;
            const int last = free == Free::all ? kDrift : offsetAlone ? kOffset : kOffset - 1;
            const auto a = poseAt(a_, u.clocks.toA(b_.poses[d.pose].seconds));
            // Only the clocks change which pose of A it is.
            const auto at = [&](const Unknowns& by, int k) {
                return k < kOffset && a ? std::optional(deviationFrom(*a, by, d.pose)) : deviation(by, d.pose);
            };
            for (int k = first; k <= last && whole; ++k) {
                const auto up = at(more[static_cast<std::size_t>(k)], k);
                const auto down = at(less[static_cast<std::size_t>(k)], k);
                whole = up && down;
                if (!whole) break;
                const glm::dvec3 turn = (up->turn - down->turn) / (2.0 * kStep);
                const glm::dvec3 moves = (placeOf(*up, place) - placeOf(*down, place)) / (2.0 * kStep);
                slopes.col(k) << turn.x, turn.y, turn.z, moves.x, moves.y, moves.z;
            }
            if (!whole) continue; // at the rim of a gap
            const double distance = distanceOf(b_.poses[d.pose]);
            const glm::dvec3& off = placeOf(d, place);
            const double turnWeight = weightOf(d.turn, noise.turn(distance));
            const double placeWeight = weightOf(off, noise.place(distance));
            Eigen::Matrix<double, 6, 1> weights, error;
            weights << turnWeight, turnWeight, turnWeight, placeWeight, placeWeight, placeWeight;
            error << d.turn.x, d.turn.y, d.turn.z, off.x, off.y, off.z;
            normal += slopes.transpose() * weights.asDiagonal() * slopes;
            right -= slopes.transpose() * weights.asDiagonal() * error;
        }
        // A short recording does not tell the drift from noise.
        if (free == Free::all) {
            const double usual = kUsualDrift * halfSpan_;
            normal(kDrift, kDrift) += 1.0 / (usual * usual);
            right[kDrift] -= u.clocks.drift * halfSpan_ / (usual * usual);
        }
        // What is kept has no slopes; the smallest of dampings also keeps what the data cannot tell where it is.
        const double damping = 1e-9 * normal.diagonal().maxCoeff();
        normal.diagonal().array() += damping;
        const Vector step = normal.ldlt().solve(right);
        u = moved(u, step, halfSpan_);
        if (step.cwiseAbs().maxCoeff() < 1e-6) break;
    }
    return u;
}

} // namespace lumorph::hand_eye
