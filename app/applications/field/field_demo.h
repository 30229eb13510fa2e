#pragma once

#include "app/applications/demo.h"

namespace lumorph {

/// The bundled tablet with an animated target, matched live.
[[nodiscard]] Demo fieldDemo();

} // namespace lumorph
