#pragma once

#include <optional>

#include "core/mdf/coverage.h"
#include "core/mdf/field.h"
#include "core/mdf/relief.h"
#include "core/mdf/voting.h"
#include "core/rig/rig.h"

namespace lumorph {

/// A field and all that matching needs of it. Immutable; shared between threads.
struct MatchField {
    explicit MatchField(Field built); ///< reads the rig out of the field; throws DataError when it is not there
    Field field;
    Rig rig;
    Coverage coverage;
    Voting voting;
    std::optional<ReliefRoom> relief; ///< none for a device that rises nowhere
};

/// Whether a field was built for this rig, or for one that is the same solid in every joint state.
[[nodiscard]] bool isFieldOf(const MatchField& field, const Rig& rig);

} // namespace lumorph
