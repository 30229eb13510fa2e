#pragma once

#include <memory>
#include <utility>

#include "core/loop/match_wish.h"
#include "core/mdf/builder.h"
#include "tests/support/animated_target.h"
#include "tests/support/small_rigs.h"

namespace lumorph::test {

/// A clock that moves by a fixed step each time it is looked at, so that every stage that runs takes some time.
class TickingClock final : public Clock {
public:
    explicit TickingClock(Microseconds step = Microseconds{1}) : step_(step) {}
    [[nodiscard]] Microseconds now() const override { return now_ += step_; }

private:
    Microseconds step_;
    mutable Microseconds now_{0};
};

inline std::shared_ptr<const MatchField> matchFieldOf(const Rig& rig, int resolution = 12, int levels = 9) {
    BuildOptions options;
    options.resolution = resolution;
    options.levels = levels;
    options.samples = 32;
    return std::make_shared<const MatchField>(buildField(rig, options));
}

inline std::shared_ptr<const MatchTarget> stillTarget(TriangleMesh mesh) {
    MatchTarget target;
    target.name = "still";
    target.solid = makeTarget(std::move(mesh));
    target.box = boundingBox(target.solid.mesh.positions);
    return std::make_shared<const MatchTarget>(std::move(target));
}

inline std::shared_ptr<const MatchTarget> movingTarget(std::uint32_t around = 24, std::uint32_t rings = 14) {
    MatchTarget target;
    target.name = "moving";
    target.model = std::make_shared<const Model>(animatedEllipsoid(around, rings));
    const Model::Animation& animation = target.model->animations.front();
    target.solid = makeTarget(flatten(*target.model, animation, 0.0));
    target.animation = 0;
    target.duration = animation.duration();
    target.box = boxOverAnimation(*target.model, animation, 20, 10.0);
    return std::make_shared<const MatchTarget>(std::move(target));
}

/// A wish with a target fitted into the field's frame.
inline MatchWish wishFor(std::shared_ptr<const MatchField> field, std::shared_ptr<const MatchTarget> target) {
    MatchWish wish;
    wish.rig = std::make_shared<const Rig>(field->rig);
    wish.field = std::move(field);
    wish.target = std::move(target);
    if (wish.target) wish.placement = fitPlacement(wish.field->field, wish.target->box);
    wish.strokes.assign(wish.rig->actuatorCount(), 0.0);
    return wish;
}

} // namespace lumorph::test
