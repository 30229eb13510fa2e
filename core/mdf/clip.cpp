#include "core/mdf/clip.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/mdf/clip_plan.h"
#include "core/mdf/frame_matcher.h"
#include "core/mdf/relief.h"
#include "core/motion/rig_motion.h"

namespace lumorph {

namespace {

std::string number(double value, const char* format) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

int frameCount(const Model::Animation& animation, double fps) {
    const std::string subject = "animation '" + animation.name + "'";
    if (!(animation.duration() > 0.0)) throw InvalidInput(subject, "it has no duration", "choose another animation");
    const double frames = std::ceil(animation.duration() * fps);
    if (frames < kMaxClipFrames) return static_cast<int>(frames);
    throw InvalidInput(subject,
                       "it lasts " + number(animation.duration(), "%.0f") + " s, which are " + number(frames, "%.0f") +
                           " frames at " + number(fps, "%g") + " a second, more than the limit of " +
                           std::to_string(kMaxClipFrames),
                       "give a lower frame rate, or cut the animation into shorter ones");
}

/// Moves the actuators through the frames of a clip: each at once, or looking ahead as soon as enough of what follows
/// it is known.
class ClipMotion {
public:
    /// `ahead` is a number of frames; 0: each at once.
    ClipMotion(const Coverage& coverage, double framesPerSecond, std::size_t ahead)
        : coverage_(coverage), seconds_(1.0 / framesPerSecond), ahead_(ahead), motion_(motionLimits(coverage.rig())) {
        if (ahead > 0) planner_.emplace(coverage, seconds_);
    }

    /// The next frame, matched, and its target.
    void add(ClipFrame frame, const BitColumns& target, const Progress& progress) {
        frames_.push_back(std::move(frame));
        if (frames_.size() == 1) // at rest
            return move(frames_.back(), target, std::vector<double>(coverage_.rig().actuatorCount(), 0.0), 0.0);
        if (!planner_)
            return move(frames_.back(), target, strokesOf(coverage_.rig(), frames_.back().wanted, coverage_.levels()),
                        seconds_);
        targets_.push_back(target);
        // Twice as many, so that a plan is made once for many frames and still looks so far beyond the last of them.
        if (targets_.size() == 2 * ahead_) plan(ahead_, progress);
    }

    [[nodiscard]] std::vector<ClipFrame> finish(const Progress& progress) {
        plan(targets_.size(), progress);
        return std::move(frames_);
    }

private:
    /// Plans all frames that have not moved yet and moves the first `count` of them.
    void plan(std::size_t count, const Progress& progress) {
        if (count == 0) return;
        const std::span<ClipFrame> frames = std::span(frames_).last(targets_.size());
        std::vector<MotionState> start;
        for (std::size_t i = 0; i < motion_.positions().size(); ++i)
            start.push_back({motion_.positions()[i], motion_.velocities()[i]});
        std::vector<State> wanted;
        for (const ClipFrame& frame : frames) wanted.push_back(frame.wanted);
        const FrameCommands commands = planner_->plan(start, targets_, wanted, progress);
        for (std::size_t k = 0; k < count; ++k) move(frames[k], targets_[k], commands[k], seconds_);
        targets_.erase(targets_.begin(), targets_.begin() + static_cast<std::ptrdiff_t>(count));
    }

    void move(ClipFrame& frame, const BitColumns& target, const std::vector<double>& commands, double seconds) {
        const auto strokes = motion_.step(commands, seconds);
        frame.commands = commands;
        frame.strokes.assign(strokes.begin(), strokes.end());
        coverage_.coveredAt(frame.strokes, reached_, scratch_);
        frame.iouReached = compareVolumes(reached_, target).iou();
    }

    const Coverage& coverage_;
    double seconds_;
    std::size_t ahead_;
    MotionModel motion_;
    std::optional<ClipPlanner> planner_;
    std::vector<ClipFrame> frames_;
    std::vector<BitColumns> targets_; ///< of the last frames, those that have not moved yet
    CoverageScratch scratch_;
    BitColumns reached_;
};

} // namespace

std::vector<ClipFrame> matchClip(const Field& field, const Coverage& coverage, const Voting& voting, const Model& model,
                                 const Model::Animation& animation, const ClipOptions& options,
                                 const Progress& progress) {
    const double fps = options.framesPerSecond;
    if (!(fps >= 1.0 && fps <= 240.0))
        throw InvalidInput("frame rate", "it must be 1 to 240 frames a second", "give a rate in that range");
    if (!(options.lookAhead >= 0.0 && options.lookAhead <= kMostLookAhead))
        throw InvalidInput("look-ahead", "it must be 0 to " + number(kMostLookAhead, "%g") + " seconds",
                           "give a time in that range");
    const int frames = frameCount(animation, fps);
    const Placement placement =
        options.placement
            ? *options.placement
            : fitPlacement(field, boxOverAnimation(model, animation, frames, fps, progress.part(0.0, 0.3)));

    const std::optional<ReliefRoom> room = placement.relief ? reliefRoom(field) : std::nullopt;
    ClipMotion motion(coverage, fps, static_cast<std::size_t>(std::ceil(options.lookAhead * fps)));
    FrameMatcher matcher(coverage, voting);
    const SteadyClock clock;
    SolidVoxelizer voxelizer;
    Votes votes;
    BitColumns target;
    const bool closed = isClosedSolid(flatten(model));
    const auto matched = [&](int count) { return 0.3 + 0.7 * count / (frames + 1); };
    for (int k = 0; k <= frames; ++k) {
        progress.throwIfCancelled();
        ClipFrame frame;
        frame.seconds = k / fps;
        const Target now{placed(flatten(model, animation, frame.seconds), placement), closed, {}};
        if (room)
            voxelizeRelief(*room, now.mesh.positions, now.mesh.triangles, target);
        else
            voxelizeTarget(field.frame, now, voxelizer, target, progress.part(matched(k), matched(k + 1)));
        target &= coverage.domain();
        matcher.vote(target, votes);
        options.refined ? matcher.refine(target, options.budget, clock) : matcher.keepVotes(target);
        frame.wanted = matcher.found().wanted;
        frame.iouWanted = matcher.found().quality.iou();
        motion.add(std::move(frame), target, progress);
        progress.report(matched(k + 1), "matching the animation");
    }
    return motion.finish(progress);
}

std::string clipCsv(const Field& field, const std::vector<ClipFrame>& frames) {
    std::string csv = "seconds,iou wanted,iou reached";
    for (const ActuatorField& actuator : field.actuators)
        csv += "," + csvField(actuator.name + " level") + "," + csvField(actuator.name + " stroke");
    csv += "\n";
    for (const ClipFrame& frame : frames) {
        csv += number(frame.seconds, "%.6f") + "," + number(frame.iouWanted, "%.6f") + "," +
               number(frame.iouReached, "%.6f");
        for (std::size_t i = 0; i < frame.wanted.size(); ++i)
            csv += "," + std::to_string(frame.wanted[i].index) + "," + number(frame.strokes[i], "%.6f");
        csv += "\n";
    }
    return csv;
}

} // namespace lumorph
