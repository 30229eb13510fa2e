#include <string>
#include <utility>

#include "calibration/stages/stage_tables.h"
#include "core/base/error.h"

// A recording of servos has the states that were visited, and the projector's light as the camera saw it in each.

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

} // namespace

namespace stages {

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
    recording.tables["light"].columns = kLightColumns;
    return recording;
}

ServoPlan planOf(const StageRecording& recording, std::size_t actuators) {
    ServoPlan plan;
    const RecordedTable& steps = tableOf(recording, kSteps, stepColumns(actuators));
    for (std::size_t k = 0; k < steps.rows(); ++k) {
        const auto row = steps.row(k);
        ServoStep step;
        step.kind = static_cast<ServoStep::Kind>(indexIn(row[0], 4, "a kind of step"));
        step.commanded.assign(row.begin() + 1, row.end());
        for (const double stroke : step.commanded)
            if (!(stroke >= 0.0 && stroke <= 1.0))
                throw DataError("recording of servos", "a command is no stroke from 0 to 1", "record the stage again");
        plan.steps.push_back(std::move(step));
    }
    const RecordedTable& measured = tableOf(recording, "measured", kMeasuredColumns);
    for (std::size_t i = 0; i < measured.rows(); ++i)
        plan.steps[indexIn(measured.row(i)[0], plan.steps.size(), "a step")].servos.push_back(
            indexIn(measured.row(i)[1], actuators, "an actuator"));
    const RecordedTable& groups = tableOf(recording, "groups", kGroupColumns);
    for (std::size_t i = 0; i < groups.rows(); ++i) {
        const std::size_t group = indexIn(groups.row(i)[1], actuators, "a group");
        if (group >= plan.groups.size()) plan.groups.resize(group + 1);
        plan.groups[group].push_back(indexIn(groups.row(i)[0], actuators, "an actuator"));
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
    options.pictures = static_cast<int>(indexIn(timing.row(0)[2], 10'000, "pictures"));
    options.pictureSeconds = timing.row(0)[3];
    return options;
}

std::vector<std::vector<ProjectorPoint>> looksOf(const StageRecording& recording, const ServoPlan& plan) {
    const RecordedTable& count = tableOf(recording, "looks", {"count"});
    const std::size_t looks = count.rows() == 1 ? indexIn(count.row(0)[0], plan.steps.size() + 1, "looks") : 0;
    return lightOf(tableOf(recording, "light", kLightColumns), looks);
}

} // namespace stages

} // namespace lumorph
