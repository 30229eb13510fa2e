#pragma once

#include <memory>
#include <utility>
#include <variant>

#include "calibration/servos/surface_points.h"
#include "calibration/stages/lab_bench.h"
#include "calibration/stages/stage.h"

namespace lumorph::test {

/// A stage measured in the virtual lab the way that studio and command line measure it.
template <typename Result>
[[nodiscard]] Result measuredInLab(const char* stage, const Rig& rig, const Installation& believed,
                                   const Installation& truth, std::uint32_t seed, const LabBenchOptions& options = {},
                                   const Progress& progress = {}) {
    const StageSite site{{std::shared_ptr<const Rig>(), &rig}, believed}; // the rig is the test's
    LabBench lab(rig, truth, seed, options);
    return std::get<Result>(measureStage(calibrationStage(stage), site, lab, progress).result);
}

/// Structured light on the lab's device as the stage "body" solves it, before any point was touched.
[[nodiscard]] inline SurfaceCapture surfaceInLab(const Rig& rig, const Installation& believed,
                                                 const Installation& truth, std::uint32_t seed,
                                                 const RegistrationLabOptions& options = {}) {
    LitDeviceCapture lit = captureLitDeviceInLab(rig, truth, seed, options);
    const CalibratedCamera camera = labCamera(believed);
    SurfaceCapture capture{
        shapeAtRest(rig, believed), {}, positionOf(camera), std::move(lit.body), std::move(lit.fresh)};
    for (const MeasuredPoint& point : surfacePoints(lit.light, camera, believed.projectors.front().camera))
        capture.points.push_back(point.place);
    return capture;
}

} // namespace lumorph::test
