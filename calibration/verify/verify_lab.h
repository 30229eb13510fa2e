#pragma once

#include <cstdint>

#include "calibration/lab/check_lab.h"
#include "calibration/verify/room_verification.h"

namespace lumorph {

/// How a check is made in the virtual lab.
struct VerifyLabOptions : VerifyOptions {
    CheckLabOptions pictures;
};

/// An installation's camera, or where it has none that of the lab beside its first projector.
[[nodiscard]] Installation withLabCamera(Installation room);

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

/// `verifyRoom` in the room as it truly is. Throws InvalidInput for rooms without a projector, Cancelled.
[[nodiscard]] VerifiedRoom measureVerifyInLab(const Rig& rig, const Installation& believed, const Installation& truth,
                                              std::uint32_t seed, const Progress& progress = {},
                                              const VerifyLabOptions& options = {});

} // namespace lumorph
