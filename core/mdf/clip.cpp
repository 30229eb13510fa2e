#include "core/mdf/clip.h"

#include <cmath>
#include <cstdio>

#include "core/base/error.h"
#include "core/base/text.h"
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

} // namespace

std::vector<ClipFrame> matchClip(const Field& field, const Coverage& coverage, const Voting& voting, const Model& model,
                                 const Model::Animation& animation, const ClipOptions& options,
                                 const Progress& progress) {
    const double fps = options.framesPerSecond;
    if (!(fps >= 1.0 && fps <= 240.0))
        throw InvalidInput("frame rate", "it must be 1 to 240 frames a second", "give a rate in that range");
    const int frames = frameCount(animation, fps);
    const Placement placement =
        options.placement
            ? *options.placement
            : fitPlacement(field, boxOverAnimation(model, animation, frames, fps, progress.part(0.0, 0.3)));

    const std::optional<ReliefRoom> room = placement.relief ? reliefRoom(field) : std::nullopt;
    MotionModel motion(motionLimits(coverage.rig()));
    FrameMatcher matcher(coverage, voting);
    const SteadyClock clock;
    SolidVoxelizer voxelizer;
    CoverageScratch scratch;
    Votes votes;
    BitColumns target;
    BitColumns reached;
    const bool closed = isClosedSolid(flatten(model));
    std::vector<ClipFrame> result;
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
        const std::vector<double> wantedStrokes = strokesOf(coverage.rig(), frame.wanted, coverage.levels());
        const auto strokes = motion.step(wantedStrokes, k == 0 ? 0.0 : 1.0 / fps);
        frame.strokes.assign(strokes.begin(), strokes.end());
        coverage.coveredAt(frame.strokes, reached, scratch);
        frame.iouReached = compareVolumes(reached, target).iou();
        result.push_back(std::move(frame));
        progress.report(matched(k + 1), "matching the animation");
    }
    return result;
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
