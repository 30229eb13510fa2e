#include <functional>
#include <string>
#include <utility>

#include "calibration/servos/surface_points.h"
#include "calibration/stages/stage_rows.h"
#include "calibration/stages/stage_tables.h"

// Pointer, tracker, device and eye: what a pointer's tip touches.

namespace lumorph {

namespace {

StageResult solvePointer(const StageRecording& recording, const StageSite& site, const Progress& progress) {
    return registerPointer(stages::pointerOf(recording), site.room, progress);
}

StageResult solveTracker(const StageRecording& recording, const StageSite& site, const Progress& progress) {
    return registerTracker(stages::dotsOf(recording, site.room.projectors.size()), site.room, progress);
}

stages::DeviceTouches recordDevice(Bench& bench, const StageSite& site, const Progress& progress) {
    stages::DeviceTouches touches{bench.recordLandmarks(site, progress.part(0.0, 0.5)), std::nullopt};
    progress.throwIfCancelled();
    touches.lit = bench.recordLitDevice(site, progress.part(0.5, 1.0));
    return touches;
}

StageResult solveDevice(const StageRecording& recording, const StageSite& site, const Progress& progress) {
    stages::DeviceTouches touches = stages::deviceTouchesOf(recording);
    Registration touched = registerDevice(touches.capture, site.room, progress.part(0.0, 0.5));
    if (!touched.good() || !touches.lit) return touched;
    progress.throwIfCancelled();
    const Installation room = stages::roomWithCamera(site, recording.source);
    const CalibratedCamera& camera = room.cameras.front().camera;
    SurfaceCapture surface;
    surface.model = shapeAtRest(*site.rig, site.room);
    surface.seenFrom = positionOf(camera);
    surface.body = std::move(touches.lit->body);
    surface.fresh = std::move(touches.lit->fresh);
    for (const MeasuredPoint& point : surfacePoints(touches.lit->light, camera, room.projectors.front().camera))
        surface.points.push_back(point.place);
    Registration lit = registerDevice(surface, touched.installation, progress.part(0.5, 1.0));
    if (lit.good()) return lit;
    if (lit.refusal) touched.warnings.push_back(*lit.refusal); // what was touched still holds
    return touched;
}

StageResult solveEye(const StageRecording& recording, const StageSite& site, const Progress& progress) {
    return registerEye(stages::eyeOf(recording), site.room, progress);
}

/// A row of touches: what it is recorded by, and the figure that it measures. All solve what they wrote: there is one
/// way from touches to figures.
template <const char* key, auto record, auto solve, auto figure, auto origin>
CalibrationStage touchStage(const char* title, std::vector<std::string_view> needs) {
    CalibrationStage stage;
    stage.key = key;
    stage.title = title;
    stage.needs = std::move(needs);
    stage.measure = [](const StageSite& site, Bench& bench, const Progress& progress) {
        StageRecording recording = stages::recordingOf(std::invoke(record, bench, site, progress.part(0.0, 0.6)),
                                                       stages::emptyRecording(key, site, bench));
        progress.throwIfCancelled();
        StageResult result = solve(recording, site, progress.part(0.6, 1.0));
        return MeasuredStage{std::move(recording), std::move(result)};
    };
    stage.solve = solve;
    stage.apply = [](const Installation& measured, Installation& room) {
        room.*figure = measured.*figure;
        room.origins.*origin = measured.origins.*origin;
    };
    stage.origin = [](const Installation& room) -> const Origin* { return &(room.origins.*origin); };
    return stage;
}

constexpr char kPointerKey[] = "pointer", kTrackerKey[] = "tracker", kDeviceKey[] = "body", kEyeKey[] = "eye";
using Origins = Installation::Origins;

} // namespace

CalibrationStage stages::pointerStage() {
    return touchStage<kPointerKey, &Bench::recordPointer, solvePointer, &Installation::pointerTip, &Origins::pointer>(
        "Pointer tip", {});
}

CalibrationStage stages::trackerStage() {
    return touchStage<kTrackerKey, &Bench::recordDots, solveTracker, &Installation::worldFromTracker,
                      &Origins::tracker>("Tracker and projector in one world", {"projector", "pointer"});
}

CalibrationStage stages::bodyStage() {
    return touchStage<kDeviceKey, recordDevice, solveDevice, &Installation::bodyFromDevice, &Origins::deviceBody>(
        "Device on its body", {"pointer"});
}

CalibrationStage stages::eyeStage() {
    return touchStage<kEyeKey, &Bench::recordEye, solveEye, &Installation::eyeFromHead, &Origins::eyeOffset>(
        "Eye", {"pointer", "tracker"});
}

} // namespace lumorph
