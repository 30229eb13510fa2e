#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "calibration/delays/delays_lab.h"
#include "calibration/lab/boards_lab.h"
#include "calibration/light/light_lab.h"
#include "calibration/servos/servo_lab.h"
#include "calibration/stages/bench.h"
#include "calibration/verify/verify_lab.h"

namespace lumorph {

/// How things are in the lab, by what is measured.
struct LabBenchOptions {
    BoardsLabOptions boards;
    RegistrationLabOptions touches;
    LightLabOptions light;
    ServoLabOptions servos;
    DelaysLabOptions delays;
    CheckLabOptions check;
    std::string checkPattern = "graycode";
};
/// The options with which a stage meets a fault, by the stage's key and the fault's. Throws InvalidInput for one that
/// it does not have.
[[nodiscard]] LabBenchOptions labWithFault(std::string_view stage, std::string_view fault);

/// The virtual lab: the true room, and somebody in it who does what is asked. What it records is simulated.
class LabBench : public Bench {
public:
    /// `rig` outlives it.
    LabBench(const Rig& rig, Installation truth, std::uint32_t seed, LabBenchOptions options = {});
    ~LabBench() override;

    [[nodiscard]] RecordingSource source() const override;
    [[nodiscard]] std::optional<Installation> truth() const override { return truth_; }
    [[nodiscard]] std::uint32_t planSeed() const override { return seed_; }
    [[nodiscard]] BoardsCapture recordBoards(const StageSite& site, const Progress& progress) override;
    [[nodiscard]] MirrorCapture recordMirror(const StageSite& site, const Progress& progress) override;
    [[nodiscard]] PointerCapture recordPointer(const StageSite& site, const Progress& progress) override;
    [[nodiscard]] DotCapture recordDots(const StageSite& site, const Progress& progress) override;
    [[nodiscard]] LandmarkCapture recordLandmarks(const StageSite& site, const Progress& progress) override;
    [[nodiscard]] EyeCapture recordEye(const StageSite& site, const Progress& progress) override;
    [[nodiscard]] std::optional<LitDeviceCapture> recordLitDevice(const StageSite& site,
                                                                  const Progress& progress) override;
    [[nodiscard]] std::vector<ProjectorPoint> look(const StageSite& site, const std::vector<double>& commanded,
                                                   const Progress& progress) override;
    [[nodiscard]] DeviceBench& device(const StageSite& site) override;
    [[nodiscard]] std::string checkPattern() const override { return options_.checkPattern; }
    [[nodiscard]] LightBench& light(const StageSite& site, const std::optional<WhiteSheet>& sheet,
                                    const Progress& progress) override;
    [[nodiscard]] bool laysSheet() const override { return options_.light.laysSheet; }
    [[nodiscard]] DelaysCapture recordDelays(const StageSite& site, const Progress& progress) override;

private:
    const Rig& rig_;
    Installation truth_;
    std::uint32_t seed_;
    LabBenchOptions options_;
    std::optional<ServoLab> servos_;
    std::unique_ptr<LabDeviceBench> device_;
    std::optional<LightLab> light_;
};

} // namespace lumorph
