#pragma once

#include <string>
#include <vector>

#include "app/applications/demo.h"

namespace lumorph {

/// A way in which light extends what a shape-changing device can show.
struct Technique {
    int key = 0; ///< the number key that shows it; 0: the device alone
    std::string name;
    std::string sentence; ///< what is to be seen
};

/// Keys 0 to 6 in order: the plain device, bump map, animated texture, shadows, creases, floating objects, holes
/// (R27-R32).
[[nodiscard]] std::vector<Technique> techniques();

/// The scene of one of them, for the tablet. All have the same items with the same ids; those of the others are hidden.
/// Throws InvalidInput for a key that is none.
[[nodiscard]] Scene techniqueScene(int key);

[[nodiscard]] Demo techniquesDemo();

} // namespace lumorph
