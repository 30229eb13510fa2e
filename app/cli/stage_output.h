#pragma once

#include <optional>

#include "app/cli/calibrate_output.h"
#include "calibration/servos/servo_gain.h"
#include "calibration/stages/stage.h"

namespace lumorph::cli {

/// What is known beside the result of a stage when it is printed.
struct StageView {
    const Rig& rig;
    std::optional<ServoGain> servoGain; ///< in the lab's true room; empty for a result of hardware
};

/// All figures of a result: see resources/guide/formats.md, "What --json prints".
[[nodiscard]] nlohmann::json jsonOf(const Registration& result);
[[nodiscard]] nlohmann::json jsonOf(const StageResult& result, const StageView& view);
void printResult(const StageResult& result, const StageView& view);

} // namespace lumorph::cli
