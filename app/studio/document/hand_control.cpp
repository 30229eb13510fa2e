#include "app/studio/document/hand_control.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lumorph::studio {

namespace {

/// One in [0, 1] an actuator; missing ones at rest.
std::vector<double> soundStrokesOf(const Rig& rig, std::vector<double> strokes) {
    strokes.resize(rig.actuatorCount(), 0.0);
    for (double& stroke : strokes) stroke = std::isfinite(stroke) ? std::clamp(stroke, 0.0, 1.0) : 0.0;
    return strokes;
}

} // namespace

bool isOf(const MatchFrame& frame, const StudioState& state) {
    const bool sameField = frame.field && frame.field == state.field.field;
    return state.rig.rig && frame.wantedStrokes.size() == state.rig.rig->actuatorCount() &&
           (sameField || frame.rig == state.rig.rig || (frame.rigOrigin && frame.rigOrigin == state.rig.origin));
}

std::vector<double> HandControl::strokes() const {
    const StudioState& state = document_.state();
    if (!state.rig.rig) return {};
    const auto& frame = loop_.frame();
    const bool driven = loop_.driver() != Driver::hand || loop_.posePlay();
    const bool known = frame && isOf(*frame, state);
    return soundStrokesOf(*state.rig.rig, driven && known ? frame->wantedStrokes : state.strokes);
}

void HandControl::preview(std::size_t actuator, double stroke) {
    if (!document_.previewing() || base_.size() <= actuator) {
        base_ = strokes();
    }
    if (actuator >= base_.size()) return;
    document_.preview([this, actuator, stroke](StudioState& state) {
        state.matching.driver = Driver::hand;
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
    document_.change(what, [moved = soundStrokesOf(*state.rig.rig, std::move(strokes))](StudioState& next) {
        next.matching.driver = Driver::hand;
        next.strokes = moved;
    });
}

QString HandControl::nameOf(std::size_t actuator) const {
    const auto& rig = document_.state().rig.rig;
    return rig && actuator < rig->actuatorCount() ? QString::fromStdString(rig->actuators()[actuator].name)
                                                  : QString("actuator");
}

} // namespace lumorph::studio
