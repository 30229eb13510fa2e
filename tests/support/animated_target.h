#pragma once

#include "core/geometry/model.h"

namespace lumorph::test {

/// A closed, bumpy ellipsoid about 2 units wide around the origin, of 2 x `around` x `rings` triangles (70,000 as it
/// comes), with a two-second animation that ends as it begins: two morph targets bend and swell it while its node
/// turns about +Y.
[[nodiscard]] Model animatedEllipsoid(std::uint32_t around = 250, std::uint32_t rings = 140);

} // namespace lumorph::test
