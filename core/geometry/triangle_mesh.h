#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace lumorph {

/// An axis-aligned box in metres; empty while `min > max`.
struct Box {
    glm::vec3 min{1.0F};
    glm::vec3 max{-1.0F};

    [[nodiscard]] bool empty() const noexcept { return min.x > max.x; }
    [[nodiscard]] glm::vec3 size() const noexcept { return empty() ? glm::vec3(0.0F) : max - min; }
    [[nodiscard]] glm::vec3 centre() const noexcept { return 0.5F * (min + max); }
    void include(const glm::vec3& point) noexcept;
    void include(const Box& other) noexcept;
};

/// Triangles over shared vertices, counter-clockwise seen from outside; metres, +Y up.
struct TriangleMesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;

    [[nodiscard]] bool empty() const noexcept { return triangles.empty(); }
    bool operator==(const TriangleMesh&) const = default;
};

/// Box of the points; empty for none.
[[nodiscard]] Box boundingBox(std::span<const glm::vec3> points) noexcept;

/// The corners of a box, as it lies in another frame.
[[nodiscard]] std::array<glm::vec3, 8> cornersOf(const Box& box,
                                                 const glm::mat4& frameFromBox = glm::mat4(1.0F)) noexcept;

/// Enclosed volume in cubic metres, negative when the faces look inwards. Meaningful for closed meshes.
[[nodiscard]] double signedVolume(const TriangleMesh& mesh) noexcept;

/// Appends `other` to `mesh`, its indices shifted.
void append(TriangleMesh& mesh, const TriangleMesh& other);

} // namespace lumorph
