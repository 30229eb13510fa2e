#pragma once

#include "devices/controllers/guarded_pulses.h"

namespace lumorph {

/// For guards without an engine, and pulses without a guard. Defined in test programs alone.
[[nodiscard]] GuardKey testGuardKey();

} // namespace lumorph
