#include "core/mdf/auto_place.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/mdf/refine.h"

namespace lumorph {

namespace {

/// A point of the search: heading in radians, logarithm of the scale, position in metres.
using Pose = std::array<double, 5>;
enum Axis : std::size_t { kYaw, kLogScale, kX, kY, kZ };

class Placer {
public:
    Placer(const Field& field, const Coverage& coverage, const Voting& voting, const Target& target,
           const AutoPlaceOptions& options, const Progress& progress)
        : field_(field), coverage_(coverage), voting_(voting), target_(target), options_(options), progress_(progress),
          refiner_(coverage), box_(boundingBox(target.mesh.positions)), volume_(std::abs(signedVolume(target.mesh))) {
        fitScale_ = fitPlacement(field, box_).scale;
    }

    AutoPlacement run() {
        const double fitIou = scoreOf(poseOf(fitPlacement(field_, box_)));
        AutoPlacement result;
        result.iouAtFit = std::max(0.0, fitIou);
        std::vector<std::pair<double, Pose>> starts{{fitIou, poseOf(fitPlacement(field_, box_))}};
        for (int i = 0; i < options_.yaws; ++i)
            for (const double share : {1.0, 0.8, 0.65}) {
                Placement start =
                    fitPlacement(field_, box_, Angle::radians(2.0 * std::numbers::pi * i / options_.yaws));
                start = shrunk(start, share);
                starts.emplace_back(scoreOf(poseOf(start)), poseOf(start));
                progress_.report(done_ = 0.4 * (i + 1) / options_.yaws, "trying headings");
            }
        std::stable_sort(starts.begin(), starts.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
        constexpr std::size_t kClimbs = 3;
        double best = -1.0;
        Pose bestPose{};
        for (std::size_t k = 0; k < std::min(kClimbs, starts.size()); ++k) {
            auto [score, pose] = starts[k];
            climb(pose, score);
            if (score > best) {
                best = score;
                bestPose = pose;
            }
            progress_.report(done_ = 0.4 + 0.6 * static_cast<double>(k + 1) / kClimbs, "improving the placement");
        }
        if (best < 0.0)
            throw InvalidInput("target", "no placement shows enough of it: it is thinner than a voxel or has no volume",
                               "give a solid target, or build the field with a higher resolution");
        result.placement = placementOf(bestPose);
        result.iou = scoreOf(bestPose);
        result.state = lastState_;
        result.placementsSeen = seen_;
        return result;
    }

private:
    [[nodiscard]] static Pose poseOf(const Placement& p) {
        return {p.yaw.inRadians(), std::log(p.scale), static_cast<double>(p.translation.x),
                static_cast<double>(p.translation.y), static_cast<double>(p.translation.z)};
    }
    [[nodiscard]] static Placement placementOf(const Pose& pose) {
        return {std::exp(pose[kLogScale]), Angle::radians(pose[kYaw]),
                glm::vec3(static_cast<float>(pose[kX]), static_cast<float>(pose[kY]), static_cast<float>(pose[kZ]))};
    }
    /// Smaller about the point it stands on.
    [[nodiscard]] Placement shrunk(Placement p, double share) const {
        const glm::vec3 foot(field_.frame.box().centre().x, field_.restSurface, field_.frame.box().centre().z);
        p.scale *= share;
        p.translation = foot + static_cast<float>(share) * (p.translation - foot);
        return p;
    }

    /// IoU of the refined match, or -1 where the placement does not count.
    double scoreOf(const Pose& pose) {
        progress_.throwIfCancelled();
        ++seen_;
        const Placement placement = placementOf(pose);
        const double relative = placement.scale / fitScale_;
        if (relative < options_.minScale || relative > options_.maxScale) return -1.0;
        voxelizeTarget(field_.frame, {placed(target_.mesh, placement), target_.closed, {}}, voxelizer_, bits_,
                       progress_.part(done_, done_));
        bits_ &= coverage_.domain();
        const double inside = static_cast<double>(bits_.count()) * field_.frame.voxelVolume();
        const double whole = volume_ * placement.scale * placement.scale * placement.scale;
        if (target_.closed && inside < options_.minInside * whole) return -1.0;
        voting_.match(bits_, votes_, workspace_);
        const Refinement refined = refiner_.refine(bits_, votes_.state(), Microseconds{5000}, clock_);
        lastState_ = refined.state;
        return refined.after.iou();
    }

    /// Pattern search: a step along each axis while that helps, then half the steps.
    void climb(Pose& pose, double& score) {
        const double voxel = field_.frame.voxelSize;
        Pose steps{0.26, 0.15, 8.0 * voxel, 4.0 * voxel, 8.0 * voxel};
        while (steps[kX] >= 0.25 * voxel) {
            bool moved = false;
            for (std::size_t axis = 0; axis < pose.size(); ++axis)
                for (const double sign : {1.0, -1.0}) {
                    Pose next = pose;
                    next[axis] += sign * steps[axis];
                    const double nextScore = scoreOf(next);
                    if (nextScore <= score) continue;
                    pose = next;
                    score = nextScore;
                    moved = true;
                    break;
                }
            if (!moved)
                for (double& step : steps) step *= 0.5;
        }
    }

    const Field& field_;
    const Coverage& coverage_;
    const Voting& voting_;
    const Target& target_;
    const AutoPlaceOptions& options_;
    const Progress& progress_;
    Refiner refiner_;
    SteadyClock clock_;
    Box box_;
    double volume_;
    double fitScale_ = 1.0;
    SolidVoxelizer voxelizer_;
    BitColumns bits_;
    Votes votes_;
    Voting::Workspace workspace_;
    State lastState_;
    int seen_ = 0;
    double done_ = 0.0; ///< of the progress
};

} // namespace

AutoPlacement autoPlace(const Field& field, const Coverage& coverage, const Voting& voting, const Target& target,
                        const AutoPlaceOptions& options, const Progress& progress) {
    return Placer(field, coverage, voting, target, options, progress).run();
}

} // namespace lumorph
