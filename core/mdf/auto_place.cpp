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
        if (!target.closed) volume_ = volumeAtFit();
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
                progress_.report(done_ = 0.2 * (i + 1) / options_.yaws, "trying headings");
            }
        const std::vector<Box> reaches = reachesOf();
        for (std::size_t k = 0; k < reaches.size(); ++k) {
            for (const Placement& start : startsOver(reaches[k]))
                starts.emplace_back(scoreOf(poseOf(start)), poseOf(start));
            progress_.report(done_ = 0.2 + 0.2 * static_cast<double>(k + 1) / static_cast<double>(reaches.size()),
                             "trying what each actuator reaches");
        }
        std::stable_sort(starts.begin(), starts.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
        constexpr std::size_t kClimbs = 3;
        std::vector<std::pair<double, Pose>> ends;
        std::vector<Pose> climbed;
        for (const auto& [startScore, start] : starts) {
            if (startScore < 0.0 || climbed.size() == kClimbs) break;
            if (std::ranges::any_of(climbed, [&](const Pose& other) { return areAlike(start, other); })) continue;
            climbed.push_back(start);
            double score = startScore;
            Pose pose = start;
            climb(pose, score);
            ends.emplace_back(score, pose);
            progress_.report(done_ = 0.4 + 0.6 * static_cast<double>(climbed.size()) / kClimbs,
                             "improving the placement");
        }
        if (ends.empty())
            throw InvalidInput("target", "no placement shows enough of it: it is thinner than a voxel or has no volume",
                               "give a solid target, or build the field with a higher resolution");
        std::stable_sort(ends.begin(), ends.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
        std::vector<Pose> kept;
        for (const auto& [score, pose] : ends) {
            if (std::ranges::any_of(kept, [&](const Pose& other) { return areAlike(pose, other); })) continue;
            kept.push_back(pose);
            result.alternatives.push_back({placementOf(pose), score});
        }
        result.placement = placementOf(kept.front());
        result.iou = scoreOf(kept.front());
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

    /// Whether two starts lead to the same place, and two ends look the same.
    [[nodiscard]] bool areAlike(const Pose& one, const Pose& other) const {
        const double turn = std::remainder(one[kYaw] - other[kYaw], 2.0 * std::numbers::pi);
        const double way = std::hypot(one[kX] - other[kX], one[kY] - other[kY], one[kZ] - other[kZ]);
        return std::abs(turn) < 0.35 && std::abs(one[kLogScale] - other[kLogScale]) < 0.15 &&
               way < 0.1 * std::exp(one[kLogScale]) * static_cast<double>(glm::length(box_.size()));
    }

    /// Around what each actuator can change, the largest first; a device with hundreds has many that are alike.
    [[nodiscard]] std::vector<Box> reachesOf() const {
        constexpr std::size_t kMost = 12;
        std::vector<std::pair<std::size_t, Box>> reaches;
        const auto width = static_cast<std::uint32_t>(field_.frame.dimensions.x);
        for (const ActuatorField& actuator : field_.actuators) {
            std::size_t count = 0;
            glm::ivec3 low = field_.frame.dimensions;
            glm::ivec3 high(-1);
            for (const ActuatorField::Run& run : actuator.runs)
                for (std::uint32_t i = 0; i < run.count; ++i) {
                    if (actuator.ramps[run.firstRamp + i].v0 == kUnchanged) continue;
                    const glm::ivec3 at(run.column % width, run.firstY + static_cast<int>(i), run.column / width);
                    low = glm::min(low, at);
                    high = glm::max(high, at);
                    ++count;
                }
            if (count == 0) continue;
            const auto size = static_cast<float>(field_.frame.voxelSize);
            reaches.emplace_back(count, Box{field_.frame.origin + size * glm::vec3(low),
                                            field_.frame.origin + size * glm::vec3(high + 1)});
        }
        std::stable_sort(reaches.begin(), reaches.end(),
                         [](const auto& a, const auto& b) { return a.first > b.first; });
        std::vector<Box> boxes;
        for (const auto& [count, box] : reaches)
            if (boxes.size() < kMost) boxes.push_back(box);
        return boxes;
    }

    /// Standing in the middle of a reach: as large as it is across, and as large as fits into it.
    [[nodiscard]] std::vector<Placement> startsOver(const Box& reach) const {
        constexpr int kHeadings = 4;
        std::vector<Placement> starts;
        for (int i = 0; i < kHeadings; ++i) {
            Placement start{1.0, Angle::radians(2.0 * std::numbers::pi * i / kHeadings), glm::vec3(0.0F)};
            const Box turned = boundingBox(cornersOf(box_, start.deviceFromTarget()));
            const glm::vec3 share = reach.size() / glm::max(turned.size(), glm::vec3(1e-12F));
            const float across = std::min(share.x, share.z);
            for (const float scale : {across, std::min(across, share.y)}) {
                start.scale = std::clamp(static_cast<double>(scale), options_.minScale * fitScale_,
                                         options_.maxScale * fitScale_);
                const auto s = static_cast<float>(start.scale);
                const glm::vec3 middle = s * turned.centre();
                start.translation = {reach.centre().x - middle.x, reach.min.y - s * turned.min.y,
                                     reach.centre().z - middle.z};
                starts.push_back(start);
            }
        }
        return starts;
    }

    /// Of a target whose triangles say nothing of it: at scale 1, by its voxels where it fits.
    double volumeAtFit() {
        const Placement placement = fitPlacement(field_, box_);
        voxelizeTarget(field_.frame, {placed(target_.mesh, placement), false, {}}, voxelizer_, bits_,
                       progress_.part(done_, done_));
        bits_ &= coverage_.domain();
        return static_cast<double>(bits_.count()) * field_.frame.voxelVolume() / std::pow(placement.scale, 3.0);
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
        if (!(inside > 0.0) || inside < options_.minInside * whole) return -1.0;
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
