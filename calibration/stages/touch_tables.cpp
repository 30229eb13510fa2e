#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "calibration/stages/stage_tables.h"
#include "core/base/error.h"

// A recording of touches has a row for each touch, and the poses of the pointer (and of what is touched, where that is
// tracked) during it.

namespace lumorph {

namespace {

const std::vector<std::string> kPoseColumns{"touch", "body", "time", "x", "y", "z", "qx", "qy", "qz", "qw"};
constexpr double kPointer = 0.0, kBody = 1.0; // of the column "body"
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kForFit = 0.0, kForCheck = 1.0; // of the column "check"

void addTrack(RecordedTable& poses, std::size_t touch, double body, const PoseTrack& track) {
    for (const auto& [seconds, pose] : track.poses) {
        const glm::dvec3& at = pose.position;
        const glm::dquat& turn = pose.rotation;
        poses.add({static_cast<double>(touch), body, seconds, at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w});
    }
}

/// Touches as they are written: a row of what was touched, and poses.
class TouchWriter {
public:
    explicit TouchWriter(std::vector<std::string> columns) {
        touches_.columns = std::move(columns);
        poses_.columns = kPoseColumns;
    }
    void add(const Touch& touch, std::initializer_list<double> row) {
        const std::size_t index = touches_.names.size();
        touches_.add(touch.name, row);
        addTrack(poses_, index, kPointer, touch.pointer);
        if (touch.body) addTrack(poses_, index, kBody, *touch.body);
    }
    void into(StageRecording& recording) && {
        recording.tables["touches"] = std::move(touches_);
        recording.tables["poses"] = std::move(poses_);
    }

private:
    RecordedTable touches_, poses_;
};

struct ReadTouch {
    Touch touch;
    std::span<const double> row;
};

/// Of a table without names the touches have none.
std::vector<ReadTouch> touchesOf(const StageRecording& recording, const std::vector<std::string>& columns) {
    const RecordedTable& table = tableOf(recording, "touches", columns);
    const RecordedTable& poses = tableOf(recording, "poses", kPoseColumns);
    std::vector<ReadTouch> touches;
    for (std::size_t i = 0; i < table.rows(); ++i)
        touches.push_back(
            {{table.names.empty() ? "touch " + std::to_string(i + 1) : table.names[i], {}, {}}, table.row(i)});
    for (std::size_t i = 0; i < poses.rows(); ++i) {
        const auto row = poses.row(i);
        Touch& touch = touches[stages::indexIn(row[0], touches.size(), "a touch")].touch;
        if (row[1] != kPointer && !touch.body) touch.body.emplace();
        (row[1] == kPointer ? touch.pointer : *touch.body)
            .poses.push_back({row[2], {{row[3], row[4], row[5]}, glm::dquat(row[9], row[6], row[7], row[8])}});
    }
    return touches;
}

const std::vector<std::string> kPointerColumns{"check", "place"};

const std::vector<std::string> kDotColumns{"check", "projector", "column", "row"};

const std::vector<std::string> kLandmarkColumns{"check", "x", "y", "z", "outward_x", "outward_y", "outward_z"};
constexpr double kForLight = 2.0; // of the column "check": judges what light tells
constexpr const char* kBodyAtRest = "body at rest";

void addLandmark(TouchWriter& writer, const TouchedLandmark& point, double check) {
    const glm::dvec3 out = point.outward.value_or(glm::dvec3(kNone));
    writer.add(point.touch, {check, point.onModel.x, point.onModel.y, point.onModel.z, out.x, out.y, out.z});
}

const std::vector<std::string> kMarkColumns{"check", "x", "y", "z"};

} // namespace

namespace stages {

// The pointer: its swings, and touches in dimples, by places.

StageRecording recordingOf(const PointerCapture& capture, StageRecording recording) {
    TouchWriter writer(kPointerColumns);
    writer.add({"swings", capture.swings, {}}, {kForFit, 0.0});
    for (std::size_t place = 0; place < capture.fresh.size(); ++place)
        for (const Touch& touch : capture.fresh[place]) writer.add(touch, {kForCheck, static_cast<double>(place)});
    std::move(writer).into(recording);
    return recording;
}

PointerCapture pointerOf(const StageRecording& recording) {
    PointerCapture capture;
    const std::vector<ReadTouch> touches = touchesOf(recording, kPointerColumns);
    for (const ReadTouch& read : touches) {
        if (read.row[0] == kForFit) {
            capture.swings = read.touch.pointer;
            continue;
        }
        const std::size_t place = indexIn(read.row[1], touches.size(), "a dimple");
        if (place >= capture.fresh.size()) capture.fresh.resize(place + 1);
        capture.fresh[place].push_back(read.touch);
    }
    return capture;
}

// The tracker: dots that a projector shows.

StageRecording recordingOf(const DotCapture& capture, StageRecording recording) {
    TouchWriter writer(kDotColumns);
    const auto add = [&writer](const std::vector<TouchedDot>& dots, double check) {
        for (const TouchedDot& dot : dots)
            writer.add(dot.touch, {check, static_cast<double>(dot.projector), dot.pixel.x, dot.pixel.y});
    };
    add(capture.dots, kForFit);
    add(capture.fresh, kForCheck);
    std::move(writer).into(recording);
    return recording;
}

DotCapture dotsOf(const StageRecording& recording, std::size_t projectors) {
    DotCapture capture;
    for (ReadTouch& read : touchesOf(recording, kDotColumns))
        (read.row[0] == kForFit ? capture.dots : capture.fresh)
            .push_back({indexIn(read.row[1], projectors, "a projector of this room"),
                        {read.row[2], read.row[3]},
                        std::move(read.touch)});
    return capture;
}

// The device: points of its model, and where the bench can, structured light on it, beside which others are touched.

StageRecording recordingOf(const DeviceTouches& touches, StageRecording recording) {
    const auto& [capture, lit] = touches;
    TouchWriter writer(kLandmarkColumns);
    for (const TouchedLandmark& point : capture.touches) addLandmark(writer, point, kForFit);
    for (const TouchedLandmark& point : capture.fresh) addLandmark(writer, point, kForCheck);
    if (lit) {
        for (const TouchedLandmark& point : lit->fresh) addLandmark(writer, point, kForLight);
        writer.add({kBodyAtRest, {}, lit->body}, {kForLight, kNone, kNone, kNone, kNone, kNone, kNone});
        RecordedTable& light = recording.tables["light"];
        light.columns = kLightColumns;
        addLight(light, 0, lit->light);
    }
    std::move(writer).into(recording);
    return recording;
}

DeviceTouches deviceTouchesOf(const StageRecording& recording) {
    DeviceTouches touches;
    LitDeviceCapture lit;
    for (ReadTouch& read : touchesOf(recording, kLandmarkColumns)) {
        if (read.touch.name == kBodyAtRest) {
            lit.body = std::move(read.touch.body).value_or(PoseTrack());
            continue;
        }
        TouchedLandmark point{{read.row[1], read.row[2], read.row[3]}, std::nullopt, std::move(read.touch)};
        if (!std::isnan(read.row[4])) point.outward = {read.row[4], read.row[5], read.row[6]};
        (read.row[0] == kForFit     ? touches.capture.touches
         : read.row[0] == kForCheck ? touches.capture.fresh
                                    : lit.fresh)
            .push_back(std::move(point));
    }
    if (!recording.tables.contains("light")) return touches;
    lit.light = lightOf(tableOf(recording, "light", kLightColumns), 1).front();
    touches.lit = std::move(lit);
    return touches;
}

// The eye: marks that the tip covers.

StageRecording recordingOf(const EyeCapture& capture, StageRecording recording) {
    TouchWriter writer(kMarkColumns);
    const auto add = [&writer](const std::vector<Alignment>& marks, double check) {
        for (const auto& [mark, touch] : marks) writer.add(touch, {check, mark.x, mark.y, mark.z});
    };
    add(capture.alignments, kForFit);
    add(capture.fresh, kForCheck);
    std::move(writer).into(recording);
    return recording;
}

EyeCapture eyeOf(const StageRecording& recording) {
    EyeCapture capture;
    for (ReadTouch& read : touchesOf(recording, kMarkColumns))
        (read.row[0] == kForFit ? capture.alignments : capture.fresh)
            .push_back({{read.row[1], read.row[2], read.row[3]}, std::move(read.touch)});
    return capture;
}

} // namespace stages

} // namespace lumorph
