#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/cli/session.h"
#include "calibration/decode/refusal.h"
#include "calibration/solve/procam_calibration.h"
#include "core/scene/installation.h"

namespace lumorph::cli {

inline constexpr const char* kBoardHelp =
    "The board: chess:9x7:75 (inner corners, side of a square), circles:4x11:20, charuco:5x7:30:22, and with the "
    "dictionary of its markers charuco:5x7:30:22:6X6_250";
inline constexpr double kDegreesPerRadian = 57.29577951308232;

[[nodiscard]] nlohmann::json jsonOf(const Finding& finding);
[[nodiscard]] nlohmann::json jsonOf(const std::vector<Finding>& findings);
/// null where there is none.
[[nodiscard]] nlohmann::json jsonOf(const std::optional<double>& number);
/// OpenCV's matrix and k1, k2, p1, p2, k3.
[[nodiscard]] nlohmann::json jsonOf(const CalibratedDevice& device);
/// All of it: see resources/guide/formats.md, "What --json prints".
[[nodiscard]] nlohmann::json jsonOf(const ProcamCalibration& result);
/// The rows of a pose's rotation matrix.
[[nodiscard]] nlohmann::json rotationOf(const PoseVector& pose);
/// Standard deviations of a pose: of the rotation in degrees, of T in the unit of T.
[[nodiscard]] nlohmann::json poseSigmaOf(const PoseVector& sigma);

/// How what the virtual lab made gets into a project.
struct LabApply {
    bool apply = false;     ///< --apply
    bool simulated = false; ///< --simulated: also into a room that holds something measured or entered
    void addTo(CLI::App& command, const char* what);
    /// Before anything takes long. Throws InvalidInput where it may not be applied.
    void checkProject(const std::string& project) const;
    void checkRoom(const std::string& project, const Installation& room) const;
};

void printDevice(const char* name, const CalibratedDevice& device);
void printProcam(const ProcamCalibration& result);
void printFindings(const std::vector<Finding>& warnings);

/// Runs it; a refusal is also told as JSON where that was asked for, and ends the program as any failure does.
template <typename Run> auto orRefused(bool json, const Run& run) {
    try {
        return run();
    } catch (const CaptureRefused& refused) {
        if (json) printJson({{"refused", jsonOf(refused.finding())}});
        throw;
    }
}

} // namespace lumorph::cli
