#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "core/base/clock.h"
#include "core/loop/match_frame.h"
#include "core/loop/match_wish.h"
#include "core/loop/pose_stream.h"

/// What a session's recording holds, row by row. All times are of one steady clock, from the recording's begin.
namespace lumorph {

/// One frame of the loop: what was wanted of the servos, where they were, and what was seen from where.
struct FrameRow {
    Microseconds time{0};
    std::uint64_t number = 0;
    double seconds = 0.0;      ///< of the target's animation
    double turned = 0.0;       ///< radians
    double sceneSeconds = 0.0; ///< of the scene
    std::vector<int> levels;   ///< asked for; empty without a field
    std::vector<double> wanted;
    std::vector<double> estimated; ///< strokes
    glm::mat4 worldFromDevice{1.0F};
    glm::mat4 deviceFromTarget{1.0F};
    std::optional<glm::vec3> eye;
    std::string viewer;
    bool handingOver = false;
    double iou = 0.0; ///< of the volume really covered
    double milliseconds = 0.0;
    double latency = 0.0; ///< milliseconds from pose to light
    bool operator==(const FrameRow&) const = default;
};

/// One sample of one tracked body.
struct PoseRow {
    Microseconds time{0}; ///< when it arrived
    Microseconds measured{0};
    std::string source;
    std::string name;
    std::int32_t id = 0;
    bool valid = false;
    Pose pose;
    bool operator==(const PoseRow&) const = default;
};

/// Something that happened: what the user was told.
struct EventRow {
    Microseconds time{0};
    std::string kind; ///< "information", "warning", "failure", "mark"
    std::string text;
    std::string remedy;
    bool operator==(const EventRow&) const = default;
};

/// A named input that a show program took, in the frame that took it: by these the program can be run again.
struct InputRow {
    Microseconds time{0};
    std::string name;
    double value = 0.0;
    bool operator==(const InputRow&) const = default;
};

/// What went into the machine behind a device's servos, in order, and the bytes that came out of it: by these the same
/// session can be run again.
struct ServoRow {
    Microseconds time{0};
    std::string kind; ///< as ServoEngine names its inputs; "sent" for what came out
    std::vector<std::uint8_t> bytes;
    bool operator==(const ServoRow&) const = default;
};

/// A file that the session's project needs, by the name that the project has for it.
struct FileRow {
    std::string name;
    std::vector<std::uint8_t> bytes;
    bool operator==(const FileRow&) const = default;
};

/// A frame as it is recorded; `begin` is when the recording began, by the frame's clock.
[[nodiscard]] FrameRow rowOf(const MatchFrame& frame, Microseconds begin);
/// A frame to show again: of the rig, target, scene and field of `like`, deformed and posed as the row says. Throws
/// InvalidInput for another rig's row.
[[nodiscard]] MatchFrame frameOf(const FrameRow& row, const MatchWish& like);

} // namespace lumorph
