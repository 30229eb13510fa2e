#include <cmath>
#include <numbers>
#include <utility>

#include <QVariantAnimation>

#include "app/studio/document/project_service_data.h"
#include "app/studio/document/state_rules.h"
#include "core/base/error.h"
#include "core/mdf/auto_place.h"

namespace lumorph::studio {

namespace {

constexpr int kGlideMilliseconds = 700;

/// Part of the way from one placement to another, the short way round.
Placement between(const Placement& from, const Placement& to, double share) {
    const auto part = static_cast<float>(share);
    const double turn = std::remainder(to.yaw.inRadians() - from.yaw.inRadians(), 2.0 * std::numbers::pi);
    return {from.scale * std::pow(to.scale / from.scale, share), Angle::radians(from.yaw.inRadians() + share * turn),
            from.translation + part * (to.translation - from.translation)};
}

} // namespace

void ProjectService::Data::fit() {
    const StudioState& state = document.state();
    if (!state.rig.rig || !state.target.target) return;
    try {
        const Placement placement =
            placementThatFits(*state.rig.rig, state.field.field.get(), state.target.target->box, state.placement.yaw);
        document.change(tr("Fit target"), [&](StudioState& next) { next.placement = placement; });
    } catch (const InvalidInput& error) {
        fail("target", error, {chooseAnother("target")});
    }
}

void ProjectService::Data::autoPlace() {
    const StudioState::TargetAsset target = document.state().target;
    const std::shared_ptr<const MatchField> field = document.state().field.field;
    if (!target.target) return;
    if (!field) {
        notices.post("target", {Notice::Level::error,
                                tr("Auto-place"),
                                tr("the field of this rig has not been built yet"),
                                tr("build it first"),
                                {{tr("Build the field"), [this] { build({}, false); }}}});
        return;
    }
    run<AutoPlacement>(
        "place", "target", tr("Placing the target"),
        [target, field](const Progress& progress) {
            return lumorph::autoPlace(field->field, field->coverage, field->voting, target.target->solid, {}, progress);
        },
        [this, target, field](const AutoPlacement& found) {
            if (document.state().target.target != target.target || document.state().field.field != field) return;
            document.change(tr("Auto-place target"), [&](StudioState& state) { state.placement = found.placement; });
        },
        {{tr("Fit"), [this] { fit(); }}});
}

void ProjectService::Data::placeNew() {
    const StudioState& state = document.state();
    if (!unplaced.target || state.target.target != unplaced.target || state.placement != unplaced.placement) {
        unplaced = {}; // someone else has moved it, or taken it away
        return;
    }
    const std::shared_ptr<const MatchField> field = state.field.field;
    if (!field) return; // when it is built
    const auto [target, placement] = std::exchange(unplaced, {});
    const QString what = tr("Auto-place %1").arg(fullName(state.target.path.stem()));
    runWith<AutoPlacement>(
        "place", "target", tr("Looking for a better place"),
        [target = target, field](const Progress& progress) {
            return lumorph::autoPlace(field->field, field->coverage, field->voting, target->solid, {}, progress);
        },
        [this, target = target, placement = placement, field, what](const AutoPlacement& found) {
            const StudioState& now = document.state();
            if (now.target.target != target || now.placement != placement || now.field.field != field) return;
            if (!document.previewing() && found.iou > found.iouAtFit) glideTo(found.placement, what);
        },
        [](const std::exception&) {}); // nobody asked for it, and it stays where it fits
}

void ProjectService::Data::glideTo(const Placement& place, const QString& what) {
    auto* glide = new QVariantAnimation(&service);
    glide->setDuration(kGlideMilliseconds);
    glide->setStartValue(0.0);
    glide->setEndValue(1.0);
    glide->setEasingCurve(QEasingCurve::InOutCubic);
    const auto target = document.state().target.target;
    const auto shown = std::make_shared<Placement>(document.state().placement);
    const auto stillOurs = [this, target, shown] {
        return document.state().target.target == target && document.state().placement == *shown;
    };
    QObject::connect(glide, &QVariantAnimation::valueChanged, &service,
                     [this, glide, stillOurs, shown, from = *shown, place](const QVariant& share) {
                         if (!stillOurs()) { // taken over by hand, or undone
                             glide->stop();
                             glide->deleteLater();
                             return;
                         }
                         document.preview(
                             [&](StudioState& state) { state.placement = between(from, place, share.toDouble()); });
                         *shown = document.state().placement;
                     });
    QObject::connect(glide, &QVariantAnimation::finished, &service, [this, stillOurs, place, what, glide] {
        glide->deleteLater();
        if (!stillOurs()) return;
        document.preview([&](StudioState& state) { state.placement = place; });
        document.commitPreview(what);
    });
    glide->start();
}

} // namespace lumorph::studio
