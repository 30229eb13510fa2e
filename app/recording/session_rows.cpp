#include "app/recording/session_rows.h"

#include <algorithm>

#include "core/base/error.h"

namespace lumorph {
namespace {

/// As the target stood at that time of its animation; nothing: as its file has it.
std::shared_ptr<const std::vector<glm::vec3>> posed(const MatchTarget* target, double seconds) {
    if (target == nullptr || !target->model || target->animation < 0 || target->duration <= 0.0) return nullptr;
    return std::make_shared<const std::vector<glm::vec3>>(meshAt(*target, seconds).positions);
}

/// One an actuator and within the field's, whatever field it was recorded with.
State levelsOf(const FrameRow& row, const MatchField* field) {
    State state;
    for (const int level : row.levels) state.push_back(Level{level});
    if (field == nullptr) return state;
    state.resize(row.estimated.size(), Level{0});
    for (Level& level : state) level.index = std::clamp(level.index, 0, field->field.levels - 1);
    return state;
}

} // namespace

FrameRow rowOf(const MatchFrame& frame, Microseconds begin) {
    FrameRow row;
    row.time = frame.time - begin;
    row.number = frame.number;
    row.seconds = frame.seconds;
    row.turned = frame.turned.inRadians();
    row.sceneSeconds = frame.sceneSeconds;
    for (const Level level : frame.wanted) row.levels.push_back(level.index);
    row.wanted = frame.wantedStrokes;
    row.estimated = frame.estimatedStrokes;
    row.worldFromDevice = frame.worldFromDevice;
    row.deviceFromTarget = frame.deviceFromTarget;
    row.eye = frame.eye;
    row.viewer = frame.viewer;
    row.handingOver = frame.handingOver;
    row.iou = frame.iouEstimated;
    row.milliseconds = frame.ms.total;
    row.latency = frame.ms.latency;
    return row;
}

MatchFrame frameOf(const FrameRow& row, const MatchWish& like) {
    if (!like.rig)
        throw InvalidInput("recording", "there is no rig to show it with", "open the session's project first");
    if (row.estimated.size() != like.rig->actuatorCount())
        throw InvalidInput("recording",
                           "it is of a rig with " + std::to_string(row.estimated.size()) + " actuators, and this has " +
                               std::to_string(like.rig->actuatorCount()),
                           "open the project it was made with");
    MatchFrame frame;
    frame.number = row.number;
    frame.time = row.time;
    frame.rig = like.rig;
    frame.rigOrigin = like.rigOrigin;
    frame.field = like.field;
    frame.target = like.target;
    frame.seconds = row.seconds;
    frame.turned = Angle::radians(row.turned);
    frame.targetPositions = posed(like.target.get(), row.seconds);
    frame.deviceFromTarget = row.deviceFromTarget;
    auto positions = std::make_shared<std::vector<glm::vec3>>(like.rig->restMesh().positions.size());
    like.rig->deform(row.estimated, *positions);
    frame.devicePositions = std::move(positions);
    frame.wanted = levelsOf(row, like.field.get());
    frame.wantedStrokes = row.wanted;
    frame.estimatedStrokes = row.estimated;
    frame.iouEstimated = row.iou;
    frame.scene = like.scene;
    frame.assets = like.assets;
    frame.sceneSeconds = row.sceneSeconds;
    frame.worldFromDevice = row.worldFromDevice;
    frame.eye = row.eye;
    frame.viewer = row.viewer;
    frame.handingOver = row.handingOver;
    frame.ms.total = row.milliseconds;
    frame.ms.latency = row.latency;
    return frame;
}

} // namespace lumorph
