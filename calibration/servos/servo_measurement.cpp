#include "calibration/servos/servo_measurement.h"

#include <string>
#include <utility>

#include "calibration/decode/pattern_decoder.h"
#include "calibration/patterns/capture_order.h"
#include "calibration/servos/servo_lab.h"
#include "calibration/servos/surface_points.h"
#include "calibration/solve/device_calibration.h"
#include "core/base/error.h"

namespace lumorph {
namespace {

/// Four steps: a projector's gamma leaves them alone where it bends three.
constexpr int kMostPoints = 20'000; // of one look
constexpr int kPlannedPixels = 14;  // camera pixels between two rays that say what would be seen

} // namespace

ServoMeasurement measureServos(const Rig& rig, const Installation& believed, std::uint32_t seed, const ServoLook& look,
                               const Progress& progress, const ServoPlanOptions& options) {
    ServoMeasurement result;
    result.room = believed;
    ServoLabOptions coarse;
    coarse.pixelStep = kPlannedPixels;
    const ServoLab eyes(rig, believed, seed, coarse);
    const auto groups = servoGroups(rig, [&](std::span<const double> strokes) {
        progress.throwIfCancelled();
        return eyes.seen(strokes);
    });
    ServoPlanOptions plan = options;
    plan.seed = seed;
    result.plan = planServos(rig, groups, plan);
    ServoSolver solver(rig, glm::dmat4(believed.worldFromDevice), result.plan);
    std::vector<double> at(rig.actuatorCount(), 0.0);
    for (std::size_t k = 0; !solver.ended(); ++k) {
        progress.throwIfCancelled();
        const double from = static_cast<double>(k), share = 1.0 / static_cast<double>(result.plan.steps.size());
        const Progress part = progress.part(from * share, (from + 1.0) * share);
        part.report(0.0, "hands off: the servos move");
        const std::vector<double>& next = result.plan.steps[k].commanded;
        solver.take(look(next, part));
        result.seconds += secondsOf(plan, at, next);
        at = next;
    }
    result.measured = solver.result();
    result.room = withMeasuredServos(believed, result.measured);
    return result;
}

Installation withMeasuredServos(const Installation& room, const ServoCalibration& measured) {
    return withServos(room, measured,
                      "structured light, " + std::to_string(measured.estimates.size()) + " states of the device");
}

std::vector<ProjectorPoint> lookBy(DeviceBench& bench, const Installation& room, const std::vector<double>& commanded,
                                   const Progress& progress) {
    const CalibratedCamera &camera = room.cameras.front().camera, &projector = room.projectors.front().camera;
    const CaptureOrder order = parsePattern(kFourStepPattern, {projector.size.x, projector.size.y});
    bench.stand(commanded, progress);
    std::vector<cv::Mat> images = bench.photograph(0, order, progress);
    if (images.size() != order.images.size() || images.front().empty())
        throw DeviceError("the camera", "it stopped in between", "look whether it is plugged in, and measure again");
    for (cv::Mat& image : images) fitPicture(image, camera.size, camera.size);
    return lightOf(decodeView(images, order), kMostPoints);
}

int picturesOfLook(const Installation& room) {
    const glm::ivec2 panel = room.projectors.front().camera.size;
    return static_cast<int>(parsePattern(kFourStepPattern, {panel.x, panel.y}).images.size());
}

} // namespace lumorph
