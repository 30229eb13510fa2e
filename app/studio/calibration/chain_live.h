#pragma once

#include "app/studio/calibration/chain.h"
#include "calibration/stages/bench.h"

namespace lumorph::studio {

// Links of the chain measured with the tracker that is connected, step by step: what a person is asked to do. The last
// points of each plan are check points, which the fit never sees.

/// Swings in one dimple; then three others, two ways to hold the pointer in each.
[[nodiscard]] std::vector<LiveStep> pointerSteps(const Rig& rig, const Installation& room);
/// Dots that the first projector shows on the table.
[[nodiscard]] std::vector<LiveStep> trackerSteps(const Rig& rig, const Installation& room);
/// Corners of the device, whose body is tracked too.
[[nodiscard]] std::vector<LiveStep> deviceSteps(const Rig& rig, const Installation& room);
/// Dots that the tip covers for the eye, while the head is tracked.
[[nodiscard]] std::vector<LiveStep> eyeSteps(const Rig& rig, const Installation& room);

/// What was recorded by such steps, as a bench: it gives the link of whose steps they are what was touched.
class LiveBench : public Bench {
public:
    /// One take a step. `isSimulated`: by a tracker that is no real one.
    LiveBench(LivePlan plan, std::vector<LiveTake> takes, bool isSimulated)
        : plan_(std::move(plan)), takes_(std::move(takes)), isSimulated_(isSimulated) {}

    [[nodiscard]] RecordingSource source() const override;
    [[nodiscard]] PointerCapture recordPointer(const StageSite& site, const Progress& progress) override;
    [[nodiscard]] DotCapture recordDots(const StageSite& site, const Progress& progress) override;
    [[nodiscard]] LandmarkCapture recordLandmarks(const StageSite& site, const Progress& progress) override;
    [[nodiscard]] EyeCapture recordEye(const StageSite& site, const Progress& progress) override;

private:
    [[nodiscard]] Touch touchOf(std::size_t step, std::optional<PoseRole> body) const;
    [[nodiscard]] std::size_t fitted() const;

    LivePlan plan_;
    std::vector<LiveTake> takes_;
    bool isSimulated_;
};

} // namespace lumorph::studio
