#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/loop/match_frame.h"
#include "core/loop/match_wish.h"
#include "core/loop/stage_timer.h"
#include "core/loop/target_voxels.h"
#include "core/voxels/solid.h"

namespace lumorph {

/// First stages of a frame: where the target's animation and its spin stand, its pose, its voxels in a field. What has
/// not changed since the frame before is kept.
class TargetStage {
public:
    /// Moves animation and spin on; a target shown for the first time starts at 0.
    void play(const MatchWish& wish, double sinceLast);
    /// Poses the target of the wish and voxelises it when there is a field and neither program nor scene item drives
    /// the servos. True when the voxels are other ones than those of the frame before.
    bool show(const MatchWish& wish, const Clock& clock, MatchTimes& ms);
    /// What there is to say about the target, written into a frame.
    void describe(MatchFrame& frame) const;

    /// Only with a target and a field.
    [[nodiscard]] const TargetVoxels& voxels() const noexcept { return voxels_; }
    /// Whether the target will stand elsewhere in the next frame with the same wish.
    [[nodiscard]] static bool moves(const MatchWish& wish) noexcept;

private:
    void pose(const MatchWish& wish);
    void voxelize(const std::shared_ptr<const MatchField>& field);

    std::shared_ptr<const MatchTarget> target_;
    double seconds_ = 0.0;
    Angle turned_;
    glm::mat4 deviceFromTarget_{1.0F};

    std::shared_ptr<const MatchTarget> posed_; ///< that `positions_` are of, at `posedSeconds_`
    double posedSeconds_ = 0.0;
    std::shared_ptr<const std::vector<glm::vec3>> positions_;

    std::shared_ptr<const MatchField> field_; ///< that `voxels_` are in; empty while they are not worked out
    glm::mat4 voxelizedAt_{1.0F};
    bool relief_ = false; ///< so `voxels_` are shaped
    Target placed_;       ///< the posed mesh in device coordinates; a buffer
    SolidVoxelizer voxelizer_;
    TargetVoxels voxels_;
    double shareBeyondFrame_ = 0.0;
};

} // namespace lumorph
