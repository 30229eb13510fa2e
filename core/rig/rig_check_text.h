#pragma once

#include "core/rig/rig_check.h"

namespace lumorph {

/// What was found and what to do about it, in plain words, from the other fields of the finding.
[[nodiscard]] std::string sentenceOf(const Rig& rig, const RigFinding& finding);
[[nodiscard]] std::string remedyOf(const Rig& rig, const RigFinding& finding);

} // namespace lumorph
