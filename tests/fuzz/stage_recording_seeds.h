#pragma once

#include <string>
#include <vector>

/// Inputs of stage_recording_fuzz that hold a small recording of each stage, each by its name.
struct StageRecordingSeed {
    std::string name, input;
};
[[nodiscard]] std::vector<StageRecordingSeed> stageRecordingSeeds();
