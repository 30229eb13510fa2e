#include "app/studio/document/target_placing.h"

#include <cmath>
#include <numbers>
#include <utility>

#include <QVariantAnimation>

#include "app/studio/document/assets.h"
#include "app/studio/document/path_text.h"
#include "core/base/error.h"
#include "core/mdf/auto_place.h"

namespace lumorph::studio {

namespace {

constexpr int kGlideMilliseconds = 400;

/// Part of the way from one placement to another, the short way round.
Placement between(const Placement& from, const Placement& to, double share) {
    const auto part = static_cast<float>(share);
    const double turn = std::remainder(to.yaw.inRadians() - from.yaw.inRadians(), 2.0 * std::numbers::pi);
    return {from.scale * std::pow(to.scale / from.scale, share), Angle::radians(from.yaw.inRadians() + share * turn),
            from.translation + part * (to.translation - from.translation),
            glm::slerp(from.orientation, to.orientation, part), to.relief};
}

AutoPlacement search(const MatchField& field, const MatchTarget& target, ReliefChoice relief,
                     const Progress& progress) {
    AutoPlaceOptions options;
    options.relief = relief;
    return autoPlace(field.field, field.coverage, field.voting, target.solid, options, progress);
}

} // namespace

TargetPlacing::TargetPlacing(StudioDocument& document, JobSlots& jobs, Notices& notices)
    : document_(document), jobs_(jobs), notices_(notices) {
    connect(&document, &StudioDocument::changed, this, [this](StateParts parts) {
        if (parts & StatePart::field) placeNew();
        if ((parts & (StatePart::field | StatePart::target)) && places().empty() == placesShown_) tellPlaces();
    });
}

void TargetPlacing::expect() {
    const StudioState& state = document_.state();
    if (!placesNewTargets_ || state.target.target->duration > 0.0) return;
    unplaced_ = {state.target.target, state.placement};
    placeNew();
}

void TargetPlacing::fit() {
    const StudioState& state = document_.state();
    if (!state.rig.rig || !state.target.target) return;
    try {
        const Placement placement = placementThatFits(*state.rig.rig, state.field.field.get(), state.target.target->box,
                                                      state.placement.yaw, state.placement.orientation);
        document_.change(tr("Fit target"), [&](StudioState& next) { next.placement = placement; });
    } catch (const InvalidInput& error) {
        jobs_.fail("target", error, {{tr("Choose another file..."), [this] { emit targetWanted(); }}});
    }
}

void TargetPlacing::autoPlace(ReliefChoice relief) {
    const StudioState::TargetAsset target = document_.state().target;
    const std::shared_ptr<const MatchField> field = document_.state().field.field;
    if (!target.target) return;
    if (!field) {
        notices_.post("target", {Notice::Level::error,
                                 tr("Auto-place"),
                                 tr("the field of this rig has not been built yet"),
                                 tr("build it first"),
                                 {{tr("Build the field"), [this] { emit fieldWanted(); }}}});
        return;
    }
    jobs_.run<AutoPlacement>(
        "place", "target", tr("Placing the target"),
        [target, field, relief](const Progress& progress) { return search(*field, *target.target, relief, progress); },
        [this, target, field](const AutoPlacement& found) {
            if (document_.state().target.target != target.target || document_.state().field.field != field) return;
            keep(target.target, field, found, found.placement);
            document_.change(tr("Auto-place target"), [&](StudioState& state) { state.placement = found.placement; });
        },
        {{tr("Fit"), [this] { fit(); }}});
}

void TargetPlacing::keep(const std::shared_ptr<const MatchTarget>& target,
                         const std::shared_ptr<const MatchField>& field, const AutoPlacement& found,
                         const Placement& stands) {
    placed_ = {target, field, stands, found.alternatives};
    if (found.iou < kFitsNowhere)
        notices_.post(
            "target",
            {Notice::Level::warning,
             fullName(document_.state().target.path.stem()),
             tr("it fits nowhere on this device; this is its best place, at %1 IoU").arg(found.iou, 0, 'f', 2),
             tr("take a target with wide, low shapes, or a device that rises higher"),
             {}});
    tellPlaces();
}

void TargetPlacing::tellPlaces() {
    placesShown_ = !places().empty();
    emit placesChanged();
}

std::span<const PlacementCandidate> TargetPlacing::places() const {
    const StudioState& state = document_.state();
    if (!placed_.target || placed_.target != state.target.target || placed_.field != state.field.field) return {};
    return placed_.places;
}

void TargetPlacing::choosePlace(std::size_t index) {
    const std::span<const PlacementCandidate> found = places();
    if (index >= found.size()) return;
    const Placement placement = found[index].placement;
    document_.change(tr("Choose another place"), [&](StudioState& state) { state.placement = placement; });
}

bool TargetPlacing::autoPlaced() const {
    const StudioState& state = document_.state();
    return placed_.target && placed_.target == state.target.target && placed_.field == state.field.field &&
           placed_.placement == state.placement;
}

void TargetPlacing::placeNew() {
    const StudioState& state = document_.state();
    if (!unplaced_.target || state.target.target != unplaced_.target || state.placement != unplaced_.placement) {
        unplaced_ = {}; // someone else has moved it, or taken it away
        return;
    }
    const std::shared_ptr<const MatchField> field = state.field.field;
    if (!field) return; // when it is built
    const auto [target, placement] = std::exchange(unplaced_, {});
    const QString what = tr("Auto-place %1").arg(fullName(state.target.path.stem()));
    jobs_.runWith<AutoPlacement>(
        "place", "target", tr("Looking for a better place"),
        [target = target, field](const Progress& progress) {
            return search(*field, *target, ReliefChoice::automatic, progress);
        },
        [this, target = target, placement = placement, field, what](const AutoPlacement& found) {
            const StudioState& now = document_.state();
            if (now.target.target != target || now.placement != placement || now.field.field != field) return;
            const bool better = found.iou > found.iouAtFit;
            keep(target, field, found, better ? found.placement : now.placement);
            if (!document_.previewing() && better) glideTo(found.placement, what);
        },
        [](const std::exception&) {}); // nobody asked for it, and it stays where it fits
}

void TargetPlacing::glideTo(const Placement& place, const QString& what) {
    auto* glide = new QVariantAnimation(this);
    glide->setDuration(kGlideMilliseconds);
    glide->setStartValue(0.0);
    glide->setEndValue(1.0);
    glide->setEasingCurve(QEasingCurve::InOutCubic);
    const auto target = document_.state().target.target;
    const auto shown = std::make_shared<Placement>(document_.state().placement);
    const auto stillOurs = [this, target, shown] {
        return document_.state().target.target == target && document_.state().placement == *shown;
    };
    connect(glide, &QVariantAnimation::valueChanged, this,
            [this, glide, stillOurs, shown, from = *shown, place](const QVariant& share) {
                if (!stillOurs()) { // taken over by hand, or undone
                    glide->stop();
                    glide->deleteLater();
                    return;
                }
                document_.preview(
                    [&](StudioState& state) { state.placement = between(from, place, share.toDouble()); });
                *shown = document_.state().placement;
            });
    connect(glide, &QVariantAnimation::finished, this, [this, stillOurs, place, what, glide] {
        glide->deleteLater();
        if (!stillOurs()) return;
        document_.preview([&](StudioState& state) { state.placement = place; });
        document_.commitPreview(what);
    });
    glide->start();
}

} // namespace lumorph::studio
