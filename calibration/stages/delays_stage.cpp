#include <string>
#include <utility>

#include "calibration/delays/delays_lab.h"
#include "calibration/stages/stage_rows.h"
#include "calibration/stages/stage_tables.h"
#include "core/base/error.h"

// Delays: flashes, a mark that follows a hand, a board that is turned, and steps of servos, with the times of all.

namespace lumorph {

namespace {

/// What the delays are worth can be told where the true room is known.
MeasuredDelays worked(const StageRecording& recording, const DelaysCapture& capture, const StageSite& site,
                      const Progress& progress) {
    MeasuredDelays delays = solveDelays(*site.rig, site.room, capture, progress);
    if (recording.truth && !delays.refusal)
        delays.gain = slipInLab(delays.installation, *recording.truth, recording.source.seed);
    return delays;
}

} // namespace

CalibrationStage stages::delaysStage() {
    CalibrationStage stage;
    stage.key = "delays";
    stage.title = "Delays";
    stage.needs = {"tracker"};
    stage.measure = [](const StageSite& site, Bench& bench, const Progress& progress) {
        const DelaysCapture capture = bench.recordDelays(site, progress.part(0.0, 0.3));
        StageRecording recording = recordingOf(capture, emptyRecording("delays", site, bench));
        MeasuredDelays delays = worked(recording, capture, site, progress.part(0.3, 1.0));
        return MeasuredStage{std::move(recording), std::move(delays)};
    };
    stage.solve = [](const StageRecording& recording, const StageSite& site, const Progress& progress) {
        return StageResult(worked(recording, stages::delaysOf(recording), site, progress));
    };
    stage.apply = takeDelays;
    stage.origin = [](const Installation& room) { return &room.origins.delays; };
    return stage;
}

} // namespace lumorph
