#include <cmath>
#include <string>
#include <utility>

#include "calibration/stages/stage_rows.h"
#include "core/base/error.h"

// Servos: the states that were visited, and the projector's light as the camera saw it in each.

namespace lumorph {

namespace {

const std::vector<std::string> kGroupColumns{"actuator", "group"};
const std::vector<std::string> kMeasuredColumns{"step", "actuator"};
constexpr const char* kSteps = "steps";

/// Kind and seconds of a step, then the commands of all actuators.
std::vector<std::string> stepColumns(std::size_t actuators) {
    std::vector<std::string> columns{"kind"};
    for (std::size_t i = 0; i < actuators; ++i) columns.push_back("commanded_" + std::to_string(i + 1));
    return columns;
}

StageRecording recordingOf(const ServoPlan& plan, std::size_t actuators, const ServoPlanOptions& options,
                           StageRecording recording) {
    RecordedTable &steps = recording.tables[kSteps], &groups = recording.tables["groups"],
                  &measured = recording.tables["measured"], &timing = recording.tables["timing"];
    steps.columns = stepColumns(actuators);
    groups.columns = kGroupColumns;
    measured.columns = kMeasuredColumns;
    timing.columns = {"velocity", "settle_seconds", "pictures", "picture_seconds"};
    for (std::size_t k = 0; k < plan.steps.size(); ++k) {
        const ServoStep& step = plan.steps[k];
        steps.add({static_cast<double>(step.kind)});
        steps.numbers.insert(steps.numbers.end(), step.commanded.begin(), step.commanded.end());
        for (const std::size_t servo : step.servos) measured.add({static_cast<double>(k), static_cast<double>(servo)});
    }
    for (std::size_t g = 0; g < plan.groups.size(); ++g)
        for (const std::size_t servo : plan.groups[g]) groups.add({static_cast<double>(servo), static_cast<double>(g)});
    timing.add(
        {options.velocity, options.settleSeconds, static_cast<double>(options.pictures), options.pictureSeconds});
    recording.tables["light"].columns = stages::kLightColumns;
    return recording;
}

ServoPlan planOf(const StageRecording& recording, std::size_t actuators) {
    ServoPlan plan;
    const RecordedTable& steps = tableOf(recording, kSteps, stepColumns(actuators));
    for (std::size_t k = 0; k < steps.rows(); ++k) {
        const auto row = steps.row(k);
        ServoStep step;
        step.kind = static_cast<ServoStep::Kind>(stages::indexIn(row[0], 4, "a kind of step"));
        step.commanded.assign(row.begin() + 1, row.end());
        for (const double stroke : step.commanded)
            if (!(stroke >= 0.0 && stroke <= 1.0))
                throw DataError("recording of servos", "a command is no stroke from 0 to 1", "record the stage again");
        plan.steps.push_back(std::move(step));
    }
    const RecordedTable& measured = tableOf(recording, "measured", kMeasuredColumns);
    for (std::size_t i = 0; i < measured.rows(); ++i)
        plan.steps[stages::indexIn(measured.row(i)[0], plan.steps.size(), "a step")].servos.push_back(
            stages::indexIn(measured.row(i)[1], actuators, "an actuator"));
    const RecordedTable& groups = tableOf(recording, "groups", kGroupColumns);
    for (std::size_t i = 0; i < groups.rows(); ++i) {
        const std::size_t group = stages::indexIn(groups.row(i)[1], actuators, "a group");
        if (group >= plan.groups.size()) plan.groups.resize(group + 1);
        plan.groups[group].push_back(stages::indexIn(groups.row(i)[0], actuators, "an actuator"));
    }
    return plan;
}

ServoPlanOptions timingOf(const StageRecording& recording) {
    const RecordedTable& timing =
        tableOf(recording, "timing", {"velocity", "settle_seconds", "pictures", "picture_seconds"});
    if (timing.rows() != 1 || !(timing.row(0)[0] > 0.0))
        throw DataError("recording of servos", "timing.csv does not say how fast servos moved",
                        "record the stage again");
    ServoPlanOptions options;
    options.velocity = timing.row(0)[0];
    options.settleSeconds = timing.row(0)[1];
    options.pictures = static_cast<int>(stages::indexIn(timing.row(0)[2], 10'000, "pictures"));
    options.pictureSeconds = timing.row(0)[3];
    return options;
}

MeasuredStage measureServos(const StageSite& site, Bench& bench, const Progress& progress) {
    StageRecording recording = stages::emptyRecording("servos", site, bench);
    const StageSite seen{site.rig, stages::roomWithCamera(site, recording.source)};
    const CalibratedCamera &camera = seen.room.cameras.front().camera, &projector = seen.room.projectors.front().camera;
    ServoPlanOptions options;
    if (const int pictures = bench.picturesOfLook(seen); pictures > 0) options.pictures = pictures;
    RecordedTable light;
    light.columns = stages::kLightColumns;
    std::size_t looks = 0;
    const auto look = [&](const std::vector<double>& commanded, const Progress& part) {
        const std::vector<ProjectorPoint> points = bench.look(seen, commanded, part);
        stages::addLight(light, looks++, points);
        return surfacePoints(points, camera, projector);
    };
    ServoMeasurement result = measureServos(*site.rig, site.room, bench.planSeed(), look, progress, options);
    recording = recordingOf(result.plan, site.rig->actuatorCount(), options, std::move(recording));
    recording.tables["light"] = std::move(light);
    recording.tables["looks"] = {{"count"}, {}, {static_cast<double>(looks)}};
    return {std::move(recording), std::move(result)};
}

StageResult solveServos(const StageRecording& recording, const StageSite& site, const Progress& progress) {
    const Installation room = stages::roomWithCamera(site, recording.source);
    const std::size_t actuators = site.rig->actuatorCount();
    ServoMeasurement result;
    result.room = site.room;
    result.plan = planOf(recording, actuators);
    const ServoPlanOptions timing = timingOf(recording);
    const RecordedTable& count = tableOf(recording, "looks", {"count"});
    // A measurement ends early where the wiring is wrong: not all of the plan was seen then.
    const std::size_t looks =
        count.rows() == 1 ? stages::indexIn(count.row(0)[0], result.plan.steps.size() + 1, "looks") : 0;
    const auto light = stages::lightOf(tableOf(recording, "light", stages::kLightColumns), looks);
    std::vector<ServoPass> passes;
    std::vector<double> at(actuators, 0.0);
    for (std::size_t k = 0; k < looks; ++k) {
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
