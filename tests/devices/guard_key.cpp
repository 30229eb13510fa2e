#include "tests/devices/guard_key.h"

namespace lumorph {

GuardKey testGuardKey() { return {}; }

} // namespace lumorph
