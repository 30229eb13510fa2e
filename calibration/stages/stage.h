#pragma once

#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "calibration/light/light_calibration.h"
#include "calibration/servos/servo_measurement.h"
#include "calibration/stages/bench.h"
#include "calibration/stages/placed_devices.h"
#include "calibration/verify/room_verification.h"

/// The stages of a calibration: recorded by whatever bench, solved from what was recorded. Whoever adds one writes a
/// row, and what it calls in a file beside it (CONTRIBUTING.md has the recipe).
namespace lumorph {

/// What a stage came to, by its kind.
using StageResult =
    std::variant<Registration, PlacedDevices, LightCalibration, ServoMeasurement, MeasuredDelays, VerifiedRoom>;

/// The room with what a result measured, and as it was believed where it was refused.
[[nodiscard]] const Installation& roomOf(const StageResult& result);
/// What was found in it may be used; of a check: nothing has moved.
[[nodiscard]] bool isGood(const StageResult& result);
/// Why nothing of it may be used, where it was refused.
[[nodiscard]] std::optional<Finding> refusalOf(const StageResult& result);

/// A stage as it was measured: what devices said, and what that came to.
struct MeasuredStage {
    StageRecording recording;
    StageResult result;
};

/// One stage.
struct CalibrationStage {
    const char* key = "";                ///< of command line, recordings and names of widgets
    const char* title = "";              ///< of a few words
    std::vector<std::string_view> needs; ///< keys of the stages that it builds on
    /// Whether a room is measured by it in its turn; null: any. Others are there to be chosen.
    bool (*isWanted)(const Installation& room) = nullptr;
    /// Records by a bench and solves, in one go: some ask for a picture by what they saw before.
    /// Null, as solve and apply: projector and camera have a sequence of their own (calibration/capture).
    MeasuredStage (*measure)(const StageSite& site, Bench& bench, const Progress& progress) = nullptr;
    /// Solves what was recorded, by the room as it is believed to be now.
    StageResult (*solve)(const StageRecording& recording, const StageSite& site, const Progress& progress) = nullptr;
    /// Takes over what this stage measures, and nothing else.
    void (*apply)(const Installation& measured, Installation& room) = nullptr;
    /// Null, or null given: it changes nothing.
    const Origin* (*origin)(const Installation& room) = nullptr;

    [[nodiscard]] bool hasSequence() const noexcept { return measure == nullptr; }
    /// What it came to is no figure of the room, but that the room is as it was.
    [[nodiscard]] bool isCheck() const noexcept { return origin == nullptr; }
};

/// In the order in which they are measured.
[[nodiscard]] const std::vector<CalibrationStage>& calibrationStages();
/// Throws InvalidInput that lists the keys.
[[nodiscard]] const CalibrationStage& calibrationStage(std::string_view key);

/// Its place among them; throws as above.
[[nodiscard]] std::size_t placeOfStage(std::string_view key);

/// Measures a stage. What a lab or a rehearsal made is simulated. Throws what the bench lacks, as DeviceError; what the
/// solvers throw for rooms that lack something, and for the one with a sequence of its own, InvalidInput; Cancelled. A
/// capture that cannot be trusted is a result.
[[nodiscard]] MeasuredStage measureStage(const CalibrationStage& stage, const StageSite& site, Bench& bench,
                                         const Progress& progress = {});

/// Solves a recording: origins say that they were recorded, by whom and when, or stay simulated. Throws DataError for a
/// recording of another stage or device, or one that lacks something; else as `measureStage`.
[[nodiscard]] StageResult solveStage(const CalibrationStage& stage, const StageRecording& recording,
                                     const StageSite& site, const Progress& progress = {});

} // namespace lumorph
