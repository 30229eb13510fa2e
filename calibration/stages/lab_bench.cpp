#include "calibration/stages/lab_bench.h"

#include <string>
#include <utility>

#include "calibration/verify/room_verification.h"
#include "core/base/error.h"

namespace lumorph {

LabBenchOptions labWithFault(std::string_view stage, std::string_view fault) {
    LabBenchOptions options;
    if (fault.empty()) return options;
    if (stage == "light")
        options.light.fault = parseLightFault(fault);
    else if (stage == "servos")
        options.servos.fault = parseServoFault(fault);
    else if (stage == "delays")
        options.delays.fault = parseDelayFault(fault);
    else if (stage == "room" && fault == "pushed")
        options.boards.push = 0.004;
    else if (stage == "pointer" || stage == "tracker" || stage == "body" || stage == "eye")
        options.touches.fault = parseTrackerFault(fault);
    else
        throw InvalidInput("fault \"" + std::string(fault) + "\"",
                           "the stage " + std::string(stage) + " has none in the lab", "leave it out");
    return options;
}

LabBench::LabBench(const Rig& rig, Installation truth, std::uint32_t seed, LabBenchOptions options)
    : rig_(rig), truth_(std::move(truth)), seed_(seed), options_(std::move(options)) {}

LabBench::~LabBench() = default;

RecordingSource LabBench::source() const {
    return {RecordingSource::Kind::lab, "virtual lab, seed " + std::to_string(seed_), utcDate(), seed_};
}

BoardsCapture LabBench::recordBoards(const StageSite&, const Progress& progress) {
    truth_ = labRoomTruth(std::move(truth_));
    return captureBoardsInLab(truth_, seed_, options_.boards, progress);
}

MirrorCapture LabBench::recordMirror(const StageSite&, const Progress& progress) {
    LabMirror mirror;
    truth_ = mirrorRoomTruth(labRoomTruth(std::move(truth_)), mirror);
    return captureMirrorInLab(truth_, mirror, seed_, options_.boards, progress);
}

PointerCapture LabBench::recordPointer(const StageSite&, const Progress& progress) {
    progress.report(0.0, "swinging the pointer");
    return capturePointerInLab(truth_, seed_, options_.touches);
}

DotCapture LabBench::recordDots(const StageSite& site, const Progress& progress) {
    progress.report(0.0, "touching projected dots");
    return captureDotsInLab(rig_, site.room, truth_, seed_, options_.touches);
}

LandmarkCapture LabBench::recordLandmarks(const StageSite&, const Progress& progress) {
    progress.report(0.0, "touching points of the device");
    return captureLandmarksInLab(rig_, truth_, seed_, options_.touches);
}

EyeCapture LabBench::recordEye(const StageSite& site, const Progress& progress) {
    progress.report(0.0, "covering marks with the tip");
    return captureEyeInLab(rig_, site.room, truth_, seed_, options_.touches);
}

std::optional<LitDeviceCapture> LabBench::recordLitDevice(const StageSite& site, const Progress& progress) {
    if (site.room.cameras.empty()) return std::nullopt;
    progress.report(0.0, "structured light on the device");
    return captureLitDeviceInLab(rig_, truth_, seed_, options_.touches);
}

std::vector<ProjectorPoint> LabBench::look(const StageSite&, const std::vector<double>& commanded, const Progress&) {
    if (!servos_) servos_.emplace(rig_, truth_, seed_, options_.servos);
    servos_->command(commanded);
    return servos_->look();
}

DeviceBench& LabBench::device(const StageSite& site) {
    if (truth_.projectors.size() != site.room.projectors.size())
        throw InvalidInput("check in the lab", "the true room has another number of projectors", "give it as many");
    device_ = std::make_unique<LabDeviceBench>(
        rig_, photographedRoom(withLabCamera(truth_), VerifyOptions().cameraWidth), seed_, options_.check);
    return *device_;
}

LightBench& LabBench::light(const StageSite&, const std::optional<WhiteSheet>& sheet, const Progress&) {
    return light_.emplace(truth_, rig_, lightLabCamera(truth_, options_.light), sheet, options_.light, seed_);
}

DelaysCapture LabBench::recordDelays(const StageSite& site, const Progress& progress) {
    return captureDelaysInLab(rig_, site.room, truth_, seed_, progress, options_.delays);
}

} // namespace lumorph
