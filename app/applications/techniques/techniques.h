#pragma once

#include <vector>

#include "app/applications/demo.h"

namespace lumorph {

/// A way in which light extends what a shape-changing device can show.
struct Technique {
    int key = 0; ///< the number key that shows it; 0: the device alone
    Words name;
    Words sentence; ///< what is to be seen
};

/// Keys 0 to 6 in order: the plain device, bump map, animated texture, shadows, creases, floating objects, holes
/// (R27-R32).
[[nodiscard]] std::vector<Technique> techniques();

/// The scene of one of them, for the tablet; `on` false: the same without what it adds, to compare. All have the same
/// items with the same ids; those of the others are hidden. Throws InvalidInput for a key that is none.
[[nodiscard]] Scene techniqueScene(int key, bool on = true);

[[nodiscard]] Demo techniquesDemo();

} // namespace lumorph
