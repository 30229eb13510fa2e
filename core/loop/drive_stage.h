#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/loop/driving_heights.h"
#include "core/loop/match_frame.h"
#include "core/loop/match_wish.h"
#include "core/loop/target_stage.h"
#include "core/motion/frequency_split.h"
#include "core/motion/view_dependence.h"

namespace lumorph {

/// What servos do with a scene: heights of its driving item become strokes, and the view-dependent rule bends edges.
class DriveStage {
public:
    enum class Mode {
        asWished, ///< as without a scene
        atRest,   ///< light alone works
        byHeights ///< the driving item's
    };
    [[nodiscard]] static Mode modeOf(const MatchWish& wish);

    /// Strokes for the driving item at a scene time; the target's own time passes by `sinceLast` seconds.
    [[nodiscard]] std::vector<double> strokes(const MatchWish& wish, const MatchFrame& frame, double sinceLast);
    /// What those strokes were made from, and the time of it, seconds.
    [[nodiscard]] const DrivingHeights::Source& source() const noexcept { return source_; }
    [[nodiscard]] double sourceSeconds() const noexcept { return sourceSeconds_; }
    /// Strokes that view dependence asks for; all 0 without a viewer, none while it is off.
    [[nodiscard]] std::vector<double> bends(const MatchWish& wish, const MatchFrame& frame);

private:
    void use(const MatchWish& wish, const MatchFrame& frame, const SceneItem& item, double sinceLast);
    void followTarget(const MatchWish& wish, const MatchFrame& frame, double sinceLast);

    std::shared_ptr<const Rig> splitRig_;
    std::optional<FrequencySplit> split_;
    std::optional<DrivingHeights> heights_;
    DrivingHeights::Source source_;
    double sourceSeconds_ = 0.0;
    Placement placement_;      ///< of the wish that `source_` was made for
    double turned_ = 0.0;      ///< by spinning when `targetClock_` was 0, radians
    double targetClock_ = 0.0; ///< the time in which the target has moved, seconds

    std::shared_ptr<const Rig> ruleRig_;
    std::optional<ViewRule> rule_;
};

} // namespace lumorph
