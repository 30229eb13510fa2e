#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/solve/procam_calibration.h"

namespace lumorph {

/// What a calibration was made of.
struct CalibrationSource {
    std::string date;                ///< UTC, such as "2026-11-24T17:05:00Z"; empty: not known
    std::string board;               ///< as `parseCalibrationBoard` reads it; likewise
    std::string pattern;             ///< as `parsePattern` reads it, or the name of an order file
    std::vector<std::string> inputs; ///< folders and files
    double metresPerUnit = 0.001;    ///< of the board's lengths
    bool isSimulated = false;        ///< its pictures are the virtual lab's
    bool operator==(const CalibrationSource&) const = default;
};

/// A calibration as it is kept and exchanged.
struct CalibrationRecord {
    ProcamCalibration result;
    CalibrationSource source;
};

/// Schema version of our JSON that this program writes; newer ones are refused.
inline constexpr int kCalibrationSchema = 1;

/// Our JSON, as resources/guide/formats.md describes it. Throws InvalidInput for numbers that are not finite.
[[nodiscard]] std::string calibrationText(const CalibrationRecord& record);
/// Reads it back; what other programs leave out (figures of quality, views, beside a projector the camera's size) stays
/// empty, and what is odd becomes a warning of the result. `name` stands in errors. Throws DataError naming the key and
/// the remedy.
[[nodiscard]] CalibrationRecord parseCalibration(std::string_view text, const std::string& name);

/// The same with the lengths of its board in millimetres, and those of T, of the poses and their errors with them.
/// Throws InvalidInput for a unit that is none.
[[nodiscard]] CalibrationRecord inMillimetres(CalibrationRecord record);

/// A reprojection error or a standard deviation as a calibration has it, where 0 is: not said, or not solved for.
[[nodiscard]] inline std::optional<double> whereSaid(double figure) {
    return figure > 0.0 ? std::optional(figure) : std::nullopt;
}

/// Adds a warning where a matrix was made for pictures of another size than is said: `file` stands in it.
void addSizeDoubts(ProcamCalibration& result, const std::string& file);

// Parts of a calibration from OpenCV's matrices, for readers. Each returns what is wrong, as the end of a sentence
// about the matrix; empty when nothing is.
[[nodiscard]] std::string setIntrinsics(CalibratedDevice& device, const cv::Matx33d& matrix);
[[nodiscard]] std::string setDistortion(CalibratedDevice& device, const std::vector<double>& terms);
/// The camera's frame to the projector's.
[[nodiscard]] std::string setRig(ProcamCalibration& result, const cv::Matx33d& rotation, const cv::Vec3d& shift);

} // namespace lumorph
