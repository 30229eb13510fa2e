#pragma once

#include <array>
#include <span>
#include <vector>

#include "calibration/registration/clock_offset.h"
#include "calibration/registration/pose_track.h"
#include "core/base/progress.h"

/// The joint, robust refinement of hand_eye.h: private to it.
namespace lumorph::hand_eye {

/// What is solved for: see HandEye.
struct Unknowns {
    Pose bFromA, worldBFromWorldA;
    ClockOffset clocks;
};

/// What single poses of B show besides what the unknowns explain.
struct Deviation {
    std::size_t pose = 0;   ///< of B
    glm::dvec3 turn{0.0};   ///< radians, in B's frame
    glm::dvec3 place{0.0};  ///< metres: of B in its world
    glm::dvec3 origin{0.0}; ///< metres: of world B's origin in B's frame
};

/// Which of the two places a tracker measures with even noise. A camera that sees a board knows where the board is in
/// its own frame much better than where it is itself in the board's: the error of a turn swings it about.
enum class Place { body, origin };

/// Noise of B by how far it is from its world's origin: what a camera measures is worse from afar.
class Noise {
public:
    Noise(std::span<const Deviation> deviations, const PoseTrack& b, Place place);
    [[nodiscard]] double turn(double distance) const { return at(turns_, distance); }
    [[nodiscard]] double place(double distance) const { return at(places_, distance); }
    /// Mean logarithm of both: the lower, the likelier.
    [[nodiscard]] double logarithm() const noexcept { return logarithm_; }

private:
    static constexpr std::size_t kRings = 6;
    [[nodiscard]] double at(const std::array<double, kRings>& of, double distance) const;
    std::size_t rings_ = kRings; ///< fewer where there are few poses
    std::array<double, kRings> farthest_{}, turns_{}, places_{};
    double logarithm_ = 0.0;
};

/// Poses [from, to) of B that count.
struct Range {
    std::size_t from = 0, to = 0;
    [[nodiscard]] bool has(std::size_t pose) const noexcept { return pose >= from && pose < to; }
};

/// What a refinement changes.
enum class Free {
    all,
    offset, ///< of the clocks, alone
    poses,  ///< not the clocks, which are known
};

/// A body A that is interpolated, and B whose poses are compared with it; both outlive this.
class Fit {
public:
    Fit(const PoseTrack& a, const PoseTrack& b, const Progress& progress = {})
        : a_(a), b_(b), halfSpan_(0.5 * (b.poses.back().seconds - b.poses.front().seconds)), progress_(progress) {}

    /// Of all poses of B that A saw, too.
    [[nodiscard]] std::vector<Deviation> deviations(const Unknowns& unknowns) const;

    /// Gauss-Newton with weights by noise and Cauchy's function, over the poses in `use`, less those in `leave`. Throws
    /// Cancelled.
    [[nodiscard]] Unknowns refined(Unknowns start, Place place, Range use, Range leave = {},
                                   Free free = Free::all) const;

    /// How well the poses in `use` tell the time offset, seconds: infinite where nothing moves.
    [[nodiscard]] double offsetSigma(const Unknowns& unknowns, Place place, Range use) const;

private:
    [[nodiscard]] std::optional<Deviation> deviation(const Unknowns& unknowns, std::size_t pose) const;
    /// A being at `a` then.
    [[nodiscard]] Deviation deviationFrom(const Pose& a, const Unknowns& unknowns, std::size_t pose) const;

    const PoseTrack& a_;
    const PoseTrack& b_;
    double halfSpan_; ///< of B, seconds
    Progress progress_;
};

} // namespace lumorph::hand_eye
