#pragma once

#include "app/studio/document/studio_document.h"

namespace lumorph::studio {

/// The parts in which two states differ; rigs, fields and targets differ when they are other objects, scenes when they
/// hold something else.
[[nodiscard]] StateParts differenceOf(const StudioState& a, const StudioState& b);

/// Whether a field was built for this rig.
[[nodiscard]] bool isFieldOf(const MatchField& field, const Rig& rig);

/// The one place where a state is made sound after an edit of `before`: a field of another rig is dropped, there is one
/// stroke an actuator, and every number is finite and within what a project file can hold. A number that is not finite
/// is refused: it stays what it was; so does a scene or an installation that is not sound.
[[nodiscard]] StudioState settled(const StudioState& before, StudioState edited);

} // namespace lumorph::studio
