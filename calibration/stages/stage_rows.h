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

/// Decoded light as a table of camera and projector pixels, with the number of the look as its first column.
inline const std::vector<std::string> kLightColumns{"look", "camera_column", "camera_row", "light_column", "light_row"};
void addLight(RecordedTable& table, std::size_t look, const std::vector<ProjectorPoint>& light);
/// By looks; at least `looks`. Throws DataError for a number that is none of a look.
[[nodiscard]] std::vector<std::vector<ProjectorPoint>> lightOf(const RecordedTable& table, std::size_t looks);

/// A number of a table that counts something, less than `end`. Throws DataError.
[[nodiscard]] std::size_t indexIn(double number, std::size_t end, const char* what);

} // namespace lumorph::stages
