#include "core/loop/target_stage.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace lumorph {

namespace {

bool animated(const MatchTarget& target) { return target.model && target.animation >= 0 && target.duration > 0.0; }

glm::mat4 turnedPlacement(Placement placement, Angle turned) {
    placement.yaw = Angle::radians(placement.yaw.inRadians() + turned.inRadians());
    return placement.deviceFromTarget();
}

} // namespace

bool TargetStage::moves(const MatchWish& wish) noexcept {
    return wish.target && ((wish.playing && animated(*wish.target)) || wish.spin != 0.0);
}

void TargetStage::play(const MatchWish& wish, double sinceLast) {
    if (wish.target != target_) {
        target_ = wish.target;
        seconds_ = 0.0;
        turned_ = {};
        sinceLast = 0.0;
    }
    if (!target_) return;
    turned_ = Angle::radians(std::remainder(turned_.inRadians() + wish.spin * sinceLast, 2.0 * std::numbers::pi));
    if (!animated(*target_)) return;
    if (wish.playing)
        seconds_ = std::fmod(seconds_ + sinceLast, target_->duration);
    else if (wish.seek)
        seconds_ = animationTime(*target_, *wish.seek);
}

bool TargetStage::show(const MatchWish& wish, const Clock& clock, MatchTimes& ms) {
    if (!target_) {
        posed_ = nullptr;
        positions_ = nullptr;
        field_ = nullptr;
        return false;
    }
    const bool compared = wish.driver != Driver::program && wish.driver != Driver::sceneItem;
    const std::shared_ptr<const MatchField> field = compared ? wish.field : nullptr;
    const bool sameField = field && field == field_;
    const bool samePose = posed_ == target_ && posedSeconds_ == seconds_;
    deviceFromTarget_ = turnedPlacement(wish.placement, turned_);
    if (!samePose) {
        field_ = nullptr; // until the voxels are those of the new pose
        const StageTimer timer(clock, ms.pose);
        pose(wish);
    }
    if (!field) field_ = nullptr;
    if (!field || (samePose && sameField && voxelizedAt_ == deviceFromTarget_ && relief_ == wish.placement.relief))
        return false;
    const StageTimer timer(clock, ms.voxelize);
    field_ = nullptr;
    relief_ = wish.placement.relief;
    voxelize(field);
    voxelizedAt_ = deviceFromTarget_;
    field_ = field;
    return true;
}

void TargetStage::pose(const MatchWish& wish) {
    const bool sameTarget = posed_ == wish.target;
    posed_ = nullptr;
    if (animated(*wish.target)) {
        TriangleMesh mesh = meshAt(*wish.target, seconds_);
        positions_ = std::make_shared<const std::vector<glm::vec3>>(std::move(mesh.positions));
        if (!sameTarget) placed_.mesh.triangles = std::move(mesh.triangles);
    } else {
        positions_ = {wish.target, &wish.target->solid.mesh.positions};
        placed_.mesh.triangles = wish.target->solid.mesh.triangles;
    }
    placed_.closed = wish.target->solid.closed;
    posedSeconds_ = seconds_;
    posed_ = wish.target;
}

void TargetStage::voxelize(const std::shared_ptr<const MatchField>& shared) {
    const MatchField& field = *shared;
    placePoints(*positions_, deviceFromTarget_, placed_.mesh.positions);
    if (relief_ && field.relief) {
        voxelizeRelief(*field.relief, placed_.mesh.positions, placed_.mesh.triangles, voxels_.written());
        shareBeyondFrame_ = 0.0; // it was compressed to what is there
    } else {
        voxelizeTarget(field.field.frame, placed_, voxelizer_, voxels_.written());
        shareBeyondFrame_ = shareBeyondFrame(field.field.frame, placed_, voxels_.bits());
    }
    voxels_.keepDomain(shared);
}

void TargetStage::describe(MatchFrame& frame) const {
    frame.target = target_;
    if (!target_) return;
    frame.seconds = seconds_;
    frame.turned = turned_;
    frame.deviceFromTarget = deviceFromTarget_;
    frame.targetPositions = positions_;
    frame.relief = relief_;
    if (!field_) return;
    frame.matched = true;
    frame.targetVolume = static_cast<double>(voxels_.count()) * field_->field.frame.voxelVolume();
    frame.shareBeyondFrame = shareBeyondFrame_;
    frame.shareUnreachable = voxels_.shareUnreachable();
}

} // namespace lumorph
