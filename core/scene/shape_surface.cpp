#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/scene/item_surfaces.h"

namespace lumorph {
namespace {

constexpr int kAround = 48;
constexpr int kRings = 24;

class Builder {
public:
    std::uint32_t vertex(const glm::vec3& position, const glm::vec3& normal, const glm::vec2& coordinates) {
        positions_.push_back(position);
        normals_.push_back(glm::normalize(normal));
        topology_.coordinates.push_back(coordinates);
        return static_cast<std::uint32_t>(positions_.size()) - 1;
    }
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) { topology_.triangles.emplace_back(a, b, c); }

    /// A flat rectangle around `centre` with sides `u` and `v`; u x v looks outwards.
    void face(const glm::vec3& centre, const glm::vec3& u, const glm::vec3& v) {
        const glm::vec2 half = 0.5F * glm::vec2(glm::length(u), glm::length(v));
        const glm::vec3 normal = glm::cross(u, v);
        const std::uint32_t a = vertex(centre - 0.5F * u - 0.5F * v, normal, {-half.x, half.y});
        const std::uint32_t b = vertex(centre + 0.5F * u - 0.5F * v, normal, {half.x, half.y});
        const std::uint32_t c = vertex(centre + 0.5F * u + 0.5F * v, normal, {half.x, -half.y});
        const std::uint32_t d = vertex(centre - 0.5F * u + 0.5F * v, normal, {-half.x, -half.y});
        triangle(a, b, c);
        triangle(a, c, d);
    }
    /// Quads between two rings of kAround + 1 vertices each, the second above the first.
    void band(std::uint32_t lower, std::uint32_t upper) {
        for (std::uint32_t i = 0; i < kAround; ++i) {
            triangle(lower + i, upper + i, upper + i + 1);
            triangle(lower + i, upper + i + 1, lower + i + 1);
        }
    }
    ItemSurface take() {
        return {std::make_shared<const SurfaceTopology>(std::move(topology_)),
                std::make_shared<const std::vector<glm::vec3>>(std::move(positions_)),
                std::make_shared<const std::vector<glm::vec3>>(std::move(normals_))};
    }

private:
    SurfaceTopology topology_;
    std::vector<glm::vec3> positions_, normals_;
};

/// A point of the unit circle in x and z; with rising `i` it goes from +X to +Z.
glm::vec2 around(int i) {
    // The last is the first, to the bit.
    const double angle = 2.0 * std::numbers::pi * (i % kAround) / kAround;
    return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
}

void addBox(Builder& builder, const glm::vec3& size) {
    for (int axis = 0; axis < 3; ++axis) {
        glm::vec3 u(0.0F);
        glm::vec3 v(0.0F);
        glm::vec3 out(0.0F);
        out[axis] = 0.5F * size[axis];
        u[(axis + 1) % 3] = size[(axis + 1) % 3];
        v[(axis + 2) % 3] = size[(axis + 2) % 3];
        // Pictures stand upright: the face's v is the world's up where it has one.
        if (axis == 0) {
            builder.face(out, -v, u);
            builder.face(-out, v, u);
        } else if (axis == 1) {
            builder.face(out, v, -u);
            builder.face(-out, v, u);
        } else {
            builder.face(out, u, v);
            builder.face(-out, -u, v);
        }
    }
}

void addSphere(Builder& builder, const glm::vec3& size) {
    const glm::vec3 half = 0.5F * size;
    std::uint32_t below = 0;
    for (int ring = 0; ring <= kRings; ++ring) {
        const double latitude = std::numbers::pi * (static_cast<double>(ring) / kRings - 0.5);
        const auto up = static_cast<float>(std::sin(latitude));
        const float out = ring == 0 || ring == kRings ? 0.0F : static_cast<float>(std::cos(latitude));
        std::uint32_t first = 0;
        for (int i = 0; i <= kAround; ++i) {
            const glm::vec2 a = around(i);
            const glm::vec3 unit(out * a.x, up, out * a.y);
            const float length = static_cast<float>(std::numbers::pi) * size.x * static_cast<float>(i) / kAround;
            const float height =
                0.5F * static_cast<float>(std::numbers::pi) * size.y * static_cast<float>(ring) / kRings;
            const std::uint32_t vertex = builder.vertex(unit * half, unit / half, {length, -height});
            if (i == 0) first = vertex;
        }
        if (ring > 0) builder.band(below, first);
        below = first;
    }
}

void addCylinder(Builder& builder, const glm::vec3& size) {
    const glm::vec3 half = 0.5F * size;
    std::array<std::uint32_t, 2> rings{};
    for (std::size_t end = 0; end < 2; ++end) {
        const float y = end == 0 ? -half.y : half.y;
        for (int i = 0; i <= kAround; ++i) {
            const glm::vec2 a = around(i);
            const float length = static_cast<float>(std::numbers::pi) * size.x * static_cast<float>(i) / kAround;
            const std::uint32_t vertex =
                builder.vertex({half.x * a.x, y, half.z * a.y}, {a.x / half.x, 0.0F, a.y / half.z}, {length, -y});
            if (i == 0) rings[end] = vertex;
        }
    }
    builder.band(rings[0], rings[1]);
    for (const float side : {-1.0F, 1.0F}) {
        const glm::vec3 normal(0.0F, side, 0.0F);
        const std::uint32_t centre = builder.vertex({0.0F, side * half.y, 0.0F}, normal, {0.0F, 0.0F});
        for (int i = 0; i < kAround; ++i) {
            const glm::vec2 a = around(i) * glm::vec2(half.x, half.z);
            const glm::vec2 b = around(i + 1) * glm::vec2(half.x, half.z);
            const std::uint32_t first = builder.vertex({a.x, side * half.y, a.y}, normal, a);
            const std::uint32_t second = builder.vertex({b.x, side * half.y, b.y}, normal, b);
            if (side > 0.0F)
                builder.triangle(centre, second, first);
            else
                builder.triangle(centre, first, second);
        }
    }
}

} // namespace

ItemSurface shapeSurface(const ShapeItem& shape) {
    Builder builder;
    switch (shape.form) {
    case ShapeItem::Form::box:
        addBox(builder, shape.size);
        break;
    case ShapeItem::Form::sphere:
        addSphere(builder, shape.size);
        break;
    case ShapeItem::Form::cylinder:
        addCylinder(builder, shape.size);
        break;
    case ShapeItem::Form::plane:
        builder.face({0.0F, 0.0F, 0.0F}, {shape.size.x, 0.0F, 0.0F}, {0.0F, 0.0F, -shape.size.z});
        break;
    }
    return builder.take();
}

} // namespace lumorph
