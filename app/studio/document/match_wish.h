#pragma once

#include "app/studio/document/studio_state.h"
#include "core/loop/match_wish.h"

namespace lumorph::studio {

/// What a document asks of the loop, without what the user does right now. `state` has a rig.
[[nodiscard]] MatchWish wishOf(const StudioState& state);

} // namespace lumorph::studio
