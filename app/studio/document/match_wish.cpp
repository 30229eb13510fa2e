#include "app/studio/document/match_wish.h"

#include "app/studio/document/state_rules.h"

namespace lumorph::studio {

MatchWish wishOf(const StudioState& state) {
    MatchWish wish;
    wish.rig = state.rig.rig;
    wish.rigOrigin = state.rig.origin;
    if (fieldFits(state)) wish.field = state.field.field;
    wish.target = state.target.target;
    wish.placement = state.placement;
    wish.driver = state.matching.driver;
    wish.method = state.matching.method;
    wish.budget = state.matching.budget;
    wish.strokes = state.strokes;
    if (state.rig.rig) wish.strokes.resize(state.rig.rig->actuatorCount(), 0.0); // while new parts are compiled
    wish.playing = state.playback.playing;
    wish.spin = state.playback.spin;
    wish.scene = state.scene;
    wish.installation = state.installation;
    wish.assets = state.assets;
    return wish;
}

} // namespace lumorph::studio
