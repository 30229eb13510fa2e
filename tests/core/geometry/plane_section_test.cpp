#include "core/geometry/plane_section.h"

#include <map>
#include <tuple>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

TEST(PlaneSection, OfABoxIsItsOutline) {
    const TriangleMesh box = test::boxMesh({0.0F, 1.0F, 2.0F}, {3.0F, 2.0F, 6.0F}, 4);
    const std::array<float, 3> perimeters{2.0F * (1.0F + 4.0F), 2.0F * (3.0F + 4.0F), 2.0F * (3.0F + 1.0F)};
    for (int axis = 0; axis < 3; ++axis) {
        const float at = std::array{1.3F, 1.7F, 4.1F}[static_cast<std::size_t>(axis)];
        float length = 0.0F;
        for (const auto& [from, to] : planeSection(box.positions, box.triangles, axis, at)) {
            EXPECT_EQ(from[axis], at);
            EXPECT_EQ(to[axis], at);
            length += glm::distance(from, to);
        }
        EXPECT_NEAR(length, perimeters[static_cast<std::size_t>(axis)], 1e-4F);
    }
    EXPECT_TRUE(planeSection(box.positions, box.triangles, 0, 3.5F).empty());
}

TEST(PlaneSection, ThroughVerticesIsClosedToo) {
    // The top is divided at x = 1, where the plane goes through its vertices.
    const TriangleMesh box = test::boxMesh({0.0F, 0.0F, 0.0F}, {4.0F, 1.0F, 4.0F}, 4);
    std::map<std::tuple<float, float>, int> ends;
    for (const auto& segment : planeSection(box.positions, box.triangles, 0, 1.0F))
        for (const glm::vec3& end : segment) ++ends[{end.y, end.z}];
    EXPECT_FALSE(ends.empty());
    for (const auto& [place, count] : ends) EXPECT_EQ(count % 2, 0) << std::get<0>(place) << " " << std::get<1>(place);
}

} // namespace
} // namespace lumorph
