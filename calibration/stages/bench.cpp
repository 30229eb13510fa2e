#include "calibration/stages/bench.h"

#include "core/base/error.h"

namespace lumorph {

namespace {

[[noreturn]] void lacksTracker() {
    throw DeviceError("tracker", "none is connected that sees the pointer",
                      "connect one in the studio's Devices, and measure there");
}
[[noreturn]] void lacksCamera() {
    throw DeviceError("camera", "none is connected", "connect one, and calibrate projector and camera with it first");
}

} // namespace

BoardsCapture Bench::recordBoards(const StageSite&, const Progress&) { lacksCamera(); }
MirrorCapture Bench::recordMirror(const StageSite&, const Progress&) { lacksCamera(); }
PointerCapture Bench::recordPointer(const StageSite&, const Progress&) { lacksTracker(); }
DotCapture Bench::recordDots(const StageSite&, const Progress&) { lacksTracker(); }
LandmarkCapture Bench::recordLandmarks(const StageSite&, const Progress&) { lacksTracker(); }
EyeCapture Bench::recordEye(const StageSite&, const Progress&) { lacksTracker(); }
std::optional<LitDeviceCapture> Bench::recordLitDevice(const StageSite&, const Progress&) { return std::nullopt; }
std::vector<ProjectorPoint> Bench::look(const StageSite&, const std::vector<double>&, const Progress&) {
    lacksCamera();
}
DeviceBench& Bench::device(const StageSite&) { lacksCamera(); }
LightBench& Bench::light(const StageSite&, const std::optional<WhiteSheet>&, const Progress&) { lacksCamera(); }
DelaysCapture Bench::recordDelays(const StageSite&, const Progress&) { lacksCamera(); }

} // namespace lumorph
