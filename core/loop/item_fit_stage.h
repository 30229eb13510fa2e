#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/loop/driving_heights.h"
#include "core/loop/match_field.h"
#include "core/loop/match_frame.h"
#include "core/loop/target_voxels.h"
#include "core/mdf/coverage.h"

namespace lumorph {

/// How well the device takes the shape of the scene item whose heights servos follow. Servos can only lift what lies on
/// them, so the shape is all between the device's surface at rest and the top of the item, compared as a target's
/// voxels are. Told anew ten times a second, and less often where it takes long.
class ItemFitStage {
public:
    /// The item of `source` at a time of it, for a frame whose strokes are known. Needs a field of its rig.
    void judge(const DrivingHeights::Source& source, double seconds, const std::shared_ptr<const MatchField>& field,
               const Clock& clock, MatchFrame& frame);
    /// Another driver: what was told is forgotten.
    void forget() noexcept { fit_.reset(); }
    /// Whether what was told last is of the frame that was judged last.
    [[nodiscard]] bool current() const noexcept { return !fit_ || current_; }

private:
    void use(const std::shared_ptr<const MatchField>& field);
    void fillColumns(const std::vector<float>& heights);
    [[nodiscard]] double shareBeyond(const std::vector<float>& heights) const;
    [[nodiscard]] ItemFit fitOf(const MatchFrame& frame);

    std::shared_ptr<const MatchField> field_;
    std::optional<DrivingHeights> columns_; ///< over the middles of the frame's columns
    std::optional<DrivingHeights> around_;  ///< over the frame and as much again around it
    std::vector<glm::vec2> aroundPoints_;
    TargetVoxels voxels_;
    CoverageScratch scratch_;
    BitColumns covered_;
    std::optional<ItemFit> fit_;
    Microseconds told_{0};
    Microseconds cost_{0};
    bool current_ = false;
};

} // namespace lumorph
