#pragma once

#include "app/applications/demo.h"

namespace lumorph {

/// A sea: long, slow waves for the servos, short, fast ones for the light, two things afloat and a wandering sun.
[[nodiscard]] Scene waterScene();

/// Clear water over a ground with a net of light; what is seen of the ground is its colour picture.
[[nodiscard]] Material seaMaterial();

[[nodiscard]] Demo waterDemo();

} // namespace lumorph
