#include "app/workspaces/field/hand_control.h"

#include <utility>

#include "app/workspaces/field/actuator_scale.h"

namespace lumorph::studio {

bool isOf(const MatchFrame& frame, const StudioState& state) {
    const bool sameField = frame.field && frame.field == state.field.field;
    return state.rig.rig && frame.wantedStrokes.size() == state.rig.rig->actuatorCount() &&
           (sameField || frame.rig == state.rig.rig || (frame.rigOrigin && frame.rigOrigin == state.rig.origin));
}

std::vector<double> HandControl::strokes() const {
    const StudioState& state = document_.state();
    if (!state.rig.rig) return {};
    const auto& frame = loop_.frame();
    const bool driven = state.matching.live || loop_.dancing();
    const bool known = frame && isOf(*frame, state);
    return strokesFor(*state.rig.rig, driven && known ? frame->wantedStrokes : state.strokes);
}

void HandControl::preview(std::size_t actuator, double stroke) {
    if (!document_.previewing() || base_.size() <= actuator) {
        base_ = strokes();
    }
    if (actuator >= base_.size()) return;
    document_.preview([this, actuator, stroke](StudioState& state) {
        state.matching.live = false;
        state.strokes = base_;
        state.strokes[actuator] = stroke;
    });
}

void HandControl::commit(std::size_t actuator, double stroke) {
    preview(actuator, stroke);
    document_.commitPreview("Move " + nameOf(actuator));
}

void HandControl::moveAll(const QString& what, std::vector<double> strokes) {
    const StudioState& state = document_.state();
    if (!state.rig.rig) return;
    if (document_.previewing()) document_.cancelPreview();
    document_.change(what, [moved = strokesFor(*state.rig.rig, std::move(strokes))](StudioState& next) {
        next.matching.live = false;
        next.strokes = moved;
    });
}

QString HandControl::nameOf(std::size_t actuator) const {
    const auto& rig = document_.state().rig.rig;
    return rig && actuator < rig->actuatorCount() ? QString::fromStdString(rig->actuators()[actuator].name)
                                                  : QString("actuator");
}

} // namespace lumorph::studio
