#include "calibration/stages/stage.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "calibration/lab/board_lab.h"
#include "calibration/stages/stage_rows.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

template <class... Cases> struct Overloaded : Cases... { using Cases::operator()...; };
template <class... Cases> Overloaded(Cases...) -> Overloaded<Cases...>;

Installation& roomIn(StageResult& result) {
    return std::visit(Overloaded{[](PlacedDevices& of) -> Installation& { return of.room; },
                                 [](Registration& of) -> Installation& { return of.installation; },
                                 [](LightCalibration& of) -> Installation& { return of.room; },
                                 [](ServoMeasurement& of) -> Installation& { return of.room; },
                                 [](MeasuredDelays& of) -> Installation& { return of.installation; },
                                 [](VerifiedRoom& of) -> Installation& { return of.installation; }},
                      result);
}

/// The sequence of one projector and camera, as a stage that others build on.
CalibrationStage projectorStage() {
    CalibrationStage stage;
    stage.key = "projector";
    stage.title = "Projector and camera";
    stage.origin = [](const Installation& room) -> const Origin* {
        return room.projectors.empty() ? nullptr : &room.projectors.front().lens;
    };
    return stage;
}

void refuseSequence(const CalibrationStage& stage) {
    if (stage.hasSequence())
        throw InvalidInput("stage \"" + std::string(stage.key) + "\"", "it has a sequence of its own",
                           "measure it in the studio, or the stage room in its place");
}

/// Says in the origins of what was measured who said it.
void markResult(const Installation& before, StageResult& result, const RecordingSource& source, bool isRecorded) {
    Installation& made = roomIn(result);
    if (source.isSimulated())
        markSimulated(before, made);
    else if (isRecorded)
        markRecorded(before, made, source.who, source.date);
    if (auto* check = std::get_if<VerifiedRoom>(&result)) check->check.installation = check->installation;
}

} // namespace

const Installation& roomOf(const StageResult& result) { return roomIn(const_cast<StageResult&>(result)); }

bool isGood(const StageResult& result) {
    return std::visit(Overloaded{[](const PlacedDevices& of) { return of.good(); },
                                 [](const Registration& of) { return of.good(); },
                                 [](const LightCalibration& of) { return of.good(); },
                                 [](const ServoMeasurement& of) { return of.measured.usable; },
                                 [](const MeasuredDelays& of) { return of.good(); },
                                 [](const VerifiedRoom& of) { return of.check.verdict == RoomCheck::Verdict::good; }},
                      result);
}

std::optional<Finding> refusalOf(const StageResult& result) {
    return std::visit(Overloaded{[](const PlacedDevices& of) { return of.refusal; },
                                 [](const Registration& of) { return of.refusal; },
                                 [](const LightCalibration& of) { return of.refusal; },
                                 [](const ServoMeasurement&) { return std::optional<Finding>(); },
                                 [](const MeasuredDelays& of) { return of.refusal; },
                                 [](const VerifiedRoom&) { return std::optional<Finding>(); }},
                      result);
}

const std::vector<CalibrationStage>& calibrationStages() {
    static const std::vector<CalibrationStage> rows{
        projectorStage(),       stages::roomStage(),  stages::lightStage(),  stages::pointerStage(),
        stages::trackerStage(), stages::bodyStage(),  stages::eyeStage(),    stages::servosStage(),
        stages::delaysStage(),  stages::checkStage(), stages::mirrorStage(), stages::deviceStage()};
    return rows;
}

std::size_t placeOfStage(std::string_view key) {
    const auto& rows = calibrationStages();
    const auto found = std::ranges::find(rows, key, &CalibrationStage::key);
    if (found != rows.end()) return static_cast<std::size_t>(found - rows.begin());
    std::string keys;
    for (const CalibrationStage& stage : rows) keys += (keys.empty() ? "" : ", ") + std::string(stage.key);
    throw InvalidInput("stage \"" + std::string(key) + "\"", "there is none of this name", "use one of " + keys);
}

const CalibrationStage& calibrationStage(std::string_view key) { return calibrationStages()[placeOfStage(key)]; }

MeasuredStage measureStage(const CalibrationStage& stage, const StageSite& site, Bench& bench,
                           const Progress& progress) {
    refuseSequence(stage);
    MeasuredStage measured = stage.measure(site, bench, progress);
    markResult(site.room, measured.result, measured.recording.source, false);
    return measured;
}

StageResult solveStage(const CalibrationStage& stage, const StageRecording& recording, const StageSite& site,
                       const Progress& progress) {
    refuseSequence(stage);
    if (recording.stage != stage.key)
        throw DataError("recording of " + recording.stage, "it is none of the stage " + std::string(stage.key),
                        "choose another recording, or solve the stage " + recording.stage + " with it");
    if (recording.device != site.rig->name())
        throw DataError("recording of " + recording.stage,
                        "it is of the device \"" + recording.device + "\", not of \"" + site.rig->name() + "\"",
                        "choose another recording, or open that device");
    StageResult result = stage.solve(recording, site, progress);
    markResult(site.room, result, recording.source, true);
    return result;
}

namespace stages {

StageRecording emptyRecording(const char* stage, const StageSite& site, const Bench& bench) {
    StageRecording recording;
    recording.stage = stage;
    recording.device = site.rig->name();
    recording.source = bench.source();
    recording.truth = bench.truth();
    return recording;
}

Installation roomWithCamera(const StageSite& site, const RecordingSource& source) {
    if (source.kind == RecordingSource::Kind::lab) return withLabCamera(site.room);
    if (site.room.cameras.empty() || site.room.projectors.empty())
        throw InvalidInput("the room", "it has no projector or no camera", "calibrate projector and camera first");
    return site.room;
}

} // namespace stages

} // namespace lumorph
