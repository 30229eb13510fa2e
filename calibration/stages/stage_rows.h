#pragma once

#include "calibration/stages/stage.h"

/// Private to calibration/stages: the row of each stage, in the file of its kind, and what they share.
namespace lumorph::stages {

[[nodiscard]] CalibrationStage roomStage();
[[nodiscard]] CalibrationStage mirrorStage();
[[nodiscard]] CalibrationStage deviceStage();
[[nodiscard]] CalibrationStage lightStage();
[[nodiscard]] CalibrationStage pointerStage();
[[nodiscard]] CalibrationStage trackerStage();
[[nodiscard]] CalibrationStage bodyStage();
[[nodiscard]] CalibrationStage eyeStage();
[[nodiscard]] CalibrationStage servosStage();
[[nodiscard]] CalibrationStage delaysStage();
[[nodiscard]] CalibrationStage checkStage();

/// Of what is measured in place of another stage, where one chooses it.
[[nodiscard]] inline bool isNeverWanted(const Installation&) { return false; }

/// A recording of a stage in which nothing is yet.
[[nodiscard]] StageRecording emptyRecording(const char* stage, const StageSite& site, const Bench& bench);

/// The room with the camera that a recording was made by: of a lab's, without a camera in the room, the lab's own.
/// Throws InvalidInput where there is none.
[[nodiscard]] Installation roomWithCamera(const StageSite& site, const RecordingSource& source);

/// Takes over lenses and places of projectors and cameras, with those that the room did not have.
void applyPlaces(const Installation& measured, Installation& room);
/// Origin of the first projector's place, where a method whose name begins so measured it; else null.
[[nodiscard]] const Origin* originByMethod(const Installation& room, std::string_view method);
/// The middle and nearly the worst of how far light lies beside.
struct LightBeside {
    double pixels = 0.0, metres = 0.0;
};
[[nodiscard]] HeldOutLight heldOutOf(std::vector<LightBeside> all);
/// Refuses what held-out light contradicts, says where there was none, and sums up.
void judgePlaces(PlacedDevices& result);

} // namespace lumorph::stages
