#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/capture/device_bench.h"
#include "calibration/delays/delays_calibration.h"
#include "calibration/doctor/boards_capture.h"
#include "calibration/lab/registration_lab.h"
#include "calibration/light/light_bench.h"
#include "calibration/light/light_patches.h"
#include "calibration/stages/recording.h"
#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph {

/// What a stage begins with: the device, and the room as it is believed to be.
struct StageSite {
    std::shared_ptr<const Rig> rig;
    Installation room;
};

/// What a stage is recorded with: the virtual lab, or a table with what is connected there. All parts are optional;
/// what a bench lacks throws DeviceError that names the part and says what to do, and nothing takes its place. All
/// throw Cancelled.
class Bench {
public:
    virtual ~Bench() = default;
    [[nodiscard]] virtual RecordingSource source() const = 0;
    /// Of a lab: the room as it truly is.
    [[nodiscard]] virtual std::optional<Installation> truth() const { return std::nullopt; }
    /// By which plans choose what may be chosen anyhow.
    [[nodiscard]] virtual std::uint32_t planSeed() const { return 1; }

    // With a printed board in somebody's hand, cameras and projectors.
    [[nodiscard]] virtual BoardsCapture recordBoards(const StageSite& site, const Progress& progress);
    [[nodiscard]] virtual MirrorCapture recordMirror(const StageSite& site, const Progress& progress);

    // With a tracked pointer in somebody's hand.
    [[nodiscard]] virtual PointerCapture recordPointer(const StageSite& site, const Progress& progress);
    [[nodiscard]] virtual DotCapture recordDots(const StageSite& site, const Progress& progress);
    [[nodiscard]] virtual LandmarkCapture recordLandmarks(const StageSite& site, const Progress& progress);
    [[nodiscard]] virtual EyeCapture recordEye(const StageSite& site, const Progress& progress);
    /// Empty where structured light on the device is not to be had beside the tracker.
    [[nodiscard]] virtual std::optional<LitDeviceCapture> recordLitDevice(const StageSite& site,
                                                                          const Progress& progress);

    // With camera, projectors and servos.
    /// Moves the servos slowly, and decodes the first projector's light as the first camera sees it.
    [[nodiscard]] virtual std::vector<ProjectorPoint> look(const StageSite& site, const std::vector<double>& commanded,
                                                           const Progress& progress);
    /// Pictures of one `look`; 0: it decodes without pictures.
    [[nodiscard]] virtual int picturesOfLook(const StageSite& /*site*/) const { return 0; }
    [[nodiscard]] virtual DeviceBench& device(const StageSite& site);
    /// What a check projects.
    [[nodiscard]] virtual std::string checkPattern() const { return "graycode"; }
    /// `sheet`: where white paper is to lie. The bench outlives what it gives.
    [[nodiscard]] virtual LightBench& light(const StageSite& site, const std::optional<WhiteSheet>& sheet,
                                            const Progress& progress);
    /// Whether a sheet of white paper can lie where it is wanted.
    [[nodiscard]] virtual bool laysSheet() const { return false; }
    [[nodiscard]] virtual DelaysCapture recordDelays(const StageSite& site, const Progress& progress);
};

} // namespace lumorph
