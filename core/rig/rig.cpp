#include "core/rig/rig.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/error.h"

namespace lumorph {

namespace {
glm::dvec3 rotated(const glm::dvec3& p, const glm::dvec3& o, const glm::dvec3& axis, double angle) {
    const glm::dvec3 v = p - o;
    return o + v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) + axis * glm::dot(axis, v) * (1 - std::cos(angle));
}
glm::dvec3 apply(const Deformer& d, const glm::dvec3& p, double s) {
    if (const auto* h = std::get_if<Hinge>(&d))
        return rotated(p, h->origin, h->axis, s * h->max.inRadians());
    if (const auto* m = std::get_if<Slide>(&d)) return p + glm::dvec3(m->direction) * (s * m->max);
    if (const auto* b = std::get_if<Bend>(&d)) {
        const glm::dvec3 o(b->origin), dir(b->direction), ax(b->axis);
        const double u = glm::dot(p - o, dir);
        if (u <= 0) return p;
        const glm::dvec3 n = glm::cross(ax, dir);
        const double w = glm::dot(p - o, n), a = glm::dot(p - o, ax), th = s * b->max.inRadians();
        if (std::abs(th) < 1e-9) return p;
        const double in = std::min(u, b->length), phi = th * in / b->length, R = b->length / th, rest = u - in;
        const double x = R * std::sin(phi) + rest * std::cos(phi) - w * std::sin(phi);
        const double y = R * (1 - std::cos(phi)) + rest * std::sin(phi) + w * std::cos(phi);
        return o + ax * a + dir * x + n * y;
    }
    return p;
}
} // namespace

Rig::Rig(RigParts parts) {
    auto base = std::make_shared<Base>();
    base->parts = std::move(parts);
    const auto n = base->parts.restMesh.positions.size();
    std::vector<std::vector<std::uint16_t>> dep(n);
    for (std::size_t a = 0; a < base->parts.actuators.size(); ++a)
        for (const auto& i : base->parts.actuators[a].influences) dep[i.vertex].push_back(static_cast<std::uint16_t>(a));
    for (const auto& d : dep) {
        base->dependencyStart.push_back(static_cast<std::uint32_t>(base->dependencies.size()));
        base->dependencies.insert(base->dependencies.end(), d.begin(), d.end());
    }
    base->dependencyStart.push_back(static_cast<std::uint32_t>(base->dependencies.size()));
    base->reach.resize(n);
    data_ = base;
    std::vector<glm::vec3> out(n);
    std::vector<double> st(base->parts.actuators.size());
    for (int k = 0; k < 300; ++k) {
        for (std::size_t i = 0; i < st.size(); ++i) st[i] = k < 20 ? k / 19.0 : ((k * 7919 + i * 104729) % 1000) / 999.0;
        deform(st, out);
        for (std::size_t v = 0; v < n; ++v) base->reach[v].include(out[v]);
    }
    for (const Box& b : base->reach) base->totalReach.include(b);
}

std::span<const std::uint16_t> Rig::actuatorsOf(std::uint32_t v) const noexcept {
    return std::span(data_->dependencies).subspan(data_->dependencyStart[v], data_->dependencyStart[v + 1] - data_->dependencyStart[v]);
}
void Rig::deform(std::span<const double> strokes, std::span<glm::vec3> out) const noexcept {
    std::copy(restMesh().positions.begin(), restMesh().positions.end(), out.begin());
    for (std::size_t a = 0; a < strokes.size(); ++a)
        for (const auto& i : actuators()[a].influences)
            if (strokes[a] != 0) out[i.vertex] = apply(actuators()[a].deformer, glm::dvec3(out[i.vertex]), strokes[a] * i.weight);
}
void Rig::deform(std::span<const double> strokes, std::span<const std::uint32_t> vertices, std::span<glm::vec3> out) const noexcept {
    std::vector<glm::vec3> all(restMesh().positions.size());
    deform(strokes, all);
    for (std::size_t i = 0; i < vertices.size(); ++i) out[i] = all[vertices[i]];
}
TriangleMesh deformed(const Rig& rig, std::span<const double> strokes) {
    TriangleMesh m = rig.restMesh();
    rig.deform(strokes, m.positions);
    return m;
}
std::vector<double> strokesOf(const Rig& rig, const State& state, int levels) {
    if (state.size() != rig.actuatorCount()) throw InvalidInput("state", "count", "x");
    std::vector<double> s;
    for (const Level l : state) s.push_back(strokeOf(l, levels));
    return s;
}
} // namespace lumorph
