#pragma once

#include <map>
#include <memory>
#include <vector>

#include "calibration/capture/pose_capture.h"
#include "calibration/light/light_bench.h"
#include "core/base/progress.h"

namespace lumorph {

/// Flat light at a table: a camera whose exposure can be set, and the projectors' windows. Its pictures are made as
/// small as flat light needs them. Somebody covers lenses when they are asked to, by the stage of the progress; whether
/// it was done shows in the pictures.
class CameraLight : public LightBench {
public:
    /// Displays by projectors of the room, null for one that is off. Camera and displays outlive it. Throws DeviceError
    /// for a camera whose exposure cannot be set.
    CameraLight(CaptureCamera& camera, std::vector<PatternDisplay*> displays, std::vector<std::string> names,
                const Progress& progress, std::shared_ptr<const Clock> clock = std::make_shared<SteadyClock>());
    ~CameraLight() override;

    /// Throws what camera and display throw; DeviceError for a lens that is not covered within a minute; Cancelled.
    [[nodiscard]] cv::Mat photograph(const LightShow& show, double seconds) override;
    [[nodiscard]] double shortestExposure() const override { return exposures_.shortest; }
    [[nodiscard]] double longestExposure() const override { return exposures_.longest; }

private:
    void expose(double seconds);
    void show(const LightShow& show);
    [[nodiscard]] cv::Mat look();
    [[nodiscard]] cv::Mat lightOf(std::size_t projector);
    void waitFor(std::size_t projector, bool covered);

    CaptureCamera& camera_;
    std::vector<PatternDisplay*> displays_;
    std::vector<std::string> names_;
    Progress progress_;
    std::shared_ptr<const Clock> clock_;
    CaptureCamera::Exposures exposures_;
    Microseconds settle_{0};
    double exposure_ = 0.0;
    std::vector<bool> covered_;
    struct Whole {
        cv::Mat light;
        double seconds = 0.0; ///< exposed for
    };
    std::map<std::size_t, Whole> whole_; ///< what each projector's white adds, uncovered
};

} // namespace lumorph
