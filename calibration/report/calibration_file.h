#pragma once

#include <filesystem>

#include "calibration/report/opencv_yaml.h"

namespace lumorph {

/// Throws InvalidInput unless the name ends in .json, .yaml or .yml.
void requireCalibrationName(const std::filesystem::path& file);
/// By the name's ending: .json, .yaml or .yml. Written whole or not at all. Throws InvalidInput for another ending,
/// DeviceError where the disk refuses.
void writeCalibration(const CalibrationRecord& record, const std::filesystem::path& file);
/// Reads those, and YAML, XML and JSON of other programs, by what is in the file (.json, .yaml, .yml, .xml, .txt).
/// Throws InvalidInput for another ending, DataError and CaptureRefused as `parseForeignCalibration`.
[[nodiscard]] CalibrationRecord readCalibration(const std::filesystem::path& file, const KnownSizes& sizes = {});

} // namespace lumorph
