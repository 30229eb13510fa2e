#include <cmath>
#include <string>
#include <utility>

#include "calibration/stages/stage_rows.h"
#include "calibration/stages/stage_tables.h"
#include "core/base/error.h"

// Servos: the states that were visited, and the projector's light as the camera saw it in each.

namespace lumorph {

namespace {

/// Where photographs of a state take seconds. Between seven levels the curve of a lever or a servo is straight to a
/// quarter of a degree.
constexpr int kPhotographedSteps = 6;

MeasuredStage measureServos(const StageSite& site, Bench& bench, const Progress& progress) {
    StageRecording recording = stages::emptyRecording("servos", site, bench);
    const StageSite seen{site.rig, stages::roomWithCamera(site, recording.source)};
    const CalibratedCamera &camera = seen.room.cameras.front().camera, &projector = seen.room.projectors.front().camera;
    ServoPlanOptions options;
    if (const int pictures = bench.picturesOfLook(seen); pictures > 0) {
        options.pictures = pictures;
        options.steps = kPhotographedSteps;
    }
    RecordedTable light;
    light.columns = stages::kLightColumns;
    std::size_t looks = 0;
    const auto look = [&](const std::vector<double>& commanded, const Progress& part) {
        const std::vector<ProjectorPoint> points = stages::asRecorded(bench.look(seen, commanded, part));
        stages::addLight(light, looks++, points);
        return surfacePoints(points, camera, projector);
    };
    ServoMeasurement result = measureServos(*site.rig, site.room, bench.planSeed(), look, progress, options);
    recording = stages::recordingOf(result.plan, site.rig->actuatorCount(), options, std::move(recording));
    recording.tables["light"] = std::move(light);
    recording.tables["looks"] = {{"count"}, {}, {static_cast<double>(looks)}};
    return {std::move(recording), std::move(result)};
}

StageResult solveServos(const StageRecording& recording, const StageSite& site, const Progress& progress) {
    const Installation room = stages::roomWithCamera(site, recording.source);
    const std::size_t actuators = site.rig->actuatorCount();
    ServoMeasurement result;
    result.room = site.room;
    result.plan = stages::planOf(recording, actuators);
    const ServoPlanOptions timing = stages::timingOf(recording);
    const auto light = stages::looksOf(recording, result.plan);
    std::vector<ServoPass> passes;
    std::vector<double> at(actuators, 0.0);
    for (std::size_t k = 0; k < light.size(); ++k) {
        passes.push_back(surfacePoints(light[k], room.cameras.front().camera, room.projectors.front().camera));
        result.seconds += secondsOf(timing, at, result.plan.steps[k].commanded);
        at = result.plan.steps[k].commanded;
    }
    result.measured = solveServos(*site.rig, glm::dmat4(site.room.worldFromDevice), result.plan, passes, progress);
    result.room = withMeasuredServos(site.room, result.measured);
    return result;
}

} // namespace

CalibrationStage stages::servosStage() {
    CalibrationStage stage;
    stage.key = "servos";
    stage.title = "Servos";
    stage.needs = {"projector"};
    stage.measure = measureServos;
    stage.solve = solveServos;
    stage.apply = [](const Installation& measured, Installation& room) {
        const std::vector<MeasuredServo> before = std::exchange(room.servos, measured.servos);
        for (MeasuredServo& servo : room.servos) { // lags are another stage's
            const auto known = std::ranges::find(before, servo.actuator, &MeasuredServo::actuator);
            servo.lagSeconds = known == before.end() ? 0.0 : known->lagSeconds;
        }
        room.origins.servos = measured.origins.servos;
    };
    stage.origin = [](const Installation& room) { return &room.origins.servos; };
    return stage;
}

} // namespace lumorph
