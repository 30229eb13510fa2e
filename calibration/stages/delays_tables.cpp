#include <algorithm>
#include <string>
#include <utility>

#include "calibration/stages/stage_tables.h"
#include "core/base/error.h"

// A recording of delays has flashes, a mark that follows a hand, a board that is turned, and steps of servos, with the
// times of all.

namespace lumorph {

namespace {

const std::vector<std::string> kTimingColumns{"exposure", "first_row", "last_row", "shown_seconds", "seconds"};
const std::vector<std::string> kArrivalColumns{"sigma"}; // of a camera that does not say when it took pictures
const std::vector<std::string> kFlashColumns{"on", "off"};
const std::vector<std::string> kBrightnessColumns{"seconds", "brightness"};
const std::vector<std::string> kFollowedColumns{"seconds", "body_x", "body_y", "body_z", "mark_x", "mark_y", "mark_z"};
const std::vector<std::string> kBoardColumns{"seconds", "x", "y", "z", "qx", "qy", "qz", "qw"};
const std::vector<std::string> kStepColumns{"seconds", "commanded"};
const std::vector<std::string> kSampleColumns{"seconds", "stroke"};

RecordedTable tableOfTrack(const PoseTrack& track) {
    RecordedTable table{kBoardColumns, {}, {}};
    for (const auto& [seconds, pose] : track.poses)
        table.add({seconds, pose.position.x, pose.position.y, pose.position.z, pose.rotation.x, pose.rotation.y,
                   pose.rotation.z, pose.rotation.w});
    return table;
}

PoseTrack trackOf(const RecordedTable& table) {
    PoseTrack track;
    for (std::size_t i = 0; i < table.rows(); ++i) {
        const auto row = table.row(i);
        track.poses.push_back({row[0], {{row[1], row[2], row[3]}, glm::dquat(row[7], row[4], row[5], row[6])}});
    }
    return track;
}

/// Rows of all servos, each by its name.
template <class Rows, class Row>
void addRows(RecordedTable& table, const std::string& name, const Rows& rows, Row row) {
    for (const auto& one : rows) {
        const auto [first, second] = row(one);
        table.add(name, {first, second});
    }
}

/// The recording of a servo by its name; its steps come first.
StepRecording& stepsOf(DelaysCapture& capture, const std::string& servo) {
    const auto found = std::ranges::find(capture.steps, servo, &StepRecording::servo);
    if (found != capture.steps.end()) return *found;
    if (capture.steps.size() == kMostSteppedServos)
        throw DataError("recording of delays", "it has steps of too many servos", "record it again");
    capture.steps.push_back({servo, {}, {}});
    return capture.steps.back();
}

} // namespace

namespace stages {

StageRecording recordingOf(const DelaysCapture& capture, StageRecording recording) {
    auto& tables = recording.tables;
    tables["timing"] = {kTimingColumns,
                        {},
                        {capture.flashes.exposure, capture.flashes.firstRow, capture.flashes.lastRow,
                         capture.mark.shownSeconds, capture.seconds}};
    if (capture.flashes.arrivalSigma > 0.0) tables["arrival"] = {kArrivalColumns, {}, {capture.flashes.arrivalSigma}};
    RecordedTable flashes{kFlashColumns, {}, {}}, brightness{kBrightnessColumns, {}, {}},
        mark{kFollowedColumns, {}, {}};
    for (const auto& [on, off] : capture.flashes.flashes) flashes.add({on, off});
    for (const auto& [seconds, light] : capture.flashes.pictures) brightness.add({seconds, light});
    for (const auto& [seconds, body, at] : capture.mark.pictures)
        mark.add({seconds, body.x, body.y, body.z, at.x, at.y, at.z});
    tables["flashes"] = std::move(flashes);
    tables["brightness"] = std::move(brightness);
    tables["mark"] = std::move(mark);
    tables["board_tracked"] = tableOfTrack(capture.tracked);
    tables["board_seen"] = tableOfTrack(capture.seen);
    RecordedTable steps{kStepColumns, {}, {}}, samples{kSampleColumns, {}, {}};
    for (const StepRecording& servo : capture.steps) {
        addRows(steps, servo.servo, servo.steps,
                [](const StepRecording::Step& step) { return std::pair(step.seconds, step.commanded); });
        addRows(samples, servo.servo, servo.samples,
                [](const StepRecording::Sample& sample) { return std::pair(sample.seconds, sample.stroke); });
    }
    if (steps.rows() > 0) tables["servo_steps"] = std::move(steps);
    if (samples.rows() > 0) tables["servo_samples"] = std::move(samples);
    return recording;
}

DelaysCapture delaysOf(const StageRecording& recording) {
    DelaysCapture capture;
    const RecordedTable& timing = tableOf(recording, "timing", kTimingColumns);
    if (timing.rows() != 1) throw DataError("recording of delays", "timing.csv has not one row", "record it again");
    capture.flashes.exposure = timing.row(0)[0];
    capture.flashes.firstRow = timing.row(0)[1];
    capture.flashes.lastRow = timing.row(0)[2];
    capture.mark.shownSeconds = timing.row(0)[3];
    capture.seconds = timing.row(0)[4];
    if (recording.tables.contains("arrival")) {
        const RecordedTable& arrival = tableOf(recording, "arrival", kArrivalColumns);
        if (arrival.rows() != 1 || !(arrival.row(0)[0] >= 0.0))
            throw DataError("recording of delays", "arrival.csv has not one row of a sigma", "record it again");
        capture.flashes.arrivalSigma = arrival.row(0)[0];
    }
    const RecordedTable& flashes = tableOf(recording, "flashes", kFlashColumns);
    for (std::size_t i = 0; i < flashes.rows(); ++i)
        capture.flashes.flashes.push_back({flashes.row(i)[0], flashes.row(i)[1]});
    const RecordedTable& brightness = tableOf(recording, "brightness", kBrightnessColumns);
    for (std::size_t i = 0; i < brightness.rows(); ++i)
        capture.flashes.pictures.push_back({brightness.row(i)[0], brightness.row(i)[1]});
    const RecordedTable& mark = tableOf(recording, "mark", kFollowedColumns);
    for (std::size_t i = 0; i < mark.rows(); ++i) {
        const auto row = mark.row(i);
        capture.mark.pictures.push_back({row[0], {row[1], row[2], row[3]}, {row[4], row[5], row[6]}});
    }
    capture.tracked = trackOf(tableOf(recording, "board_tracked", kBoardColumns));
    capture.seen = trackOf(tableOf(recording, "board_seen", kBoardColumns));
    if (!recording.tables.contains("servo_steps")) return capture;
    const RecordedTable &steps = tableOf(recording, "servo_steps", kStepColumns),
                        &samples = tableOf(recording, "servo_samples", kSampleColumns);
    if (steps.names.size() != steps.rows() || samples.names.size() != samples.rows())
        throw DataError("recording of delays", "the steps of servos have no names", "record it again");
    for (std::size_t i = 0; i < steps.rows(); ++i)
        stepsOf(capture, steps.names[i]).steps.push_back({steps.row(i)[0], steps.row(i)[1]});
    for (std::size_t i = 0; i < samples.rows(); ++i)
        stepsOf(capture, samples.names[i]).samples.push_back({samples.row(i)[0], samples.row(i)[1]});
    return capture;
}

} // namespace stages

} // namespace lumorph
