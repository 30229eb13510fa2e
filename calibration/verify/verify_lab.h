#pragma once

#include <cstdint>
#include <optional>

#include "calibration/capture/device_bench.h"
#include "calibration/lab/check_lab.h"

namespace lumorph {

/// The virtual lab as a bench: the device as its true servos let it stand, and pictures with the lab's noise. It comes
/// to each stand from below, which is all that a check asks. The rig outlives it.
class LabDeviceBench : public DeviceBench {
public:
    LabDeviceBench(const Rig& rig, Installation truth, std::uint32_t seed, CheckLabOptions pictures = {});
    void stand(std::span<const double> commanded, const Progress& progress) override;
    [[nodiscard]] std::vector<cv::Mat> photograph(std::size_t projector, const CaptureOrder& order,
                                                  const Progress& progress) override;

private:
    const Rig& rig_;
    Installation truth_;
    std::uint32_t seed_, looks_ = 0;
    CheckLabOptions pictures_;
    std::vector<double> commanded_;
    std::optional<CheckLab> lab_; ///< of this stand, once it is looked at
};

} // namespace lumorph
