#pragma once

#include "app/applications/demo.h"

namespace lumorph {

/// A sea: long, slow waves for the servos, short, fast ones for the light, two things afloat and a wandering sun.
[[nodiscard]] Scene waterScene();

[[nodiscard]] Demo waterDemo();

} // namespace lumorph
