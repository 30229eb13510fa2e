#pragma once

#include "app/studio/document/studio_document.h"

namespace lumorph::studio {

/// The parts in which two states differ; rigs, fields and targets differ when they are other objects, scenes when they
/// hold something else.
[[nodiscard]] StateParts differenceOf(const StudioState& a, const StudioState& b);

/// Whether the rig is another one than was opened.
[[nodiscard]] bool isEdited(const StudioState::RigAsset& rig);

/// Whether the field's actuators are those of the rig one by one, so that levels that it finds are theirs. True without
/// a field; a field of the rig before an edit may have others.
[[nodiscard]] bool fieldFits(const StudioState& state);

/// A step of undo holds edited parts without the rig that they were compiled to; until it is compiled again, `shown`
/// goes on being shown where it is an edit of the same rig.
[[nodiscard]] StudioState withRig(StudioState state, const StudioState::RigAsset& shown);

/// An edit that gives servos something new to follow hands them over to it, in the same step: a target that is opened,
/// or an item of the scene that is made physical or shown. Where what they followed is gone, what is left takes over.
/// An edit that says itself who drives is left as it is.
[[nodiscard]] StudioState withTakeover(const StudioState& before, StudioState edited);

/// The one place where a state is made sound after an edit of `before`: a rig that was put in the place of another
/// begins a line of edits, a field of another line is dropped and one of an earlier edit is stale, there is one stroke
/// an actuator, poses go along with actuators that were renamed, and every number is finite and within what a project
/// file can hold. A number that is not finite is refused: it stays what it was; so do poses, a scene or an installation
/// that are not sound.
[[nodiscard]] StudioState settled(const StudioState& before, StudioState edited);

} // namespace lumorph::studio
