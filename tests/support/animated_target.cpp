#include "tests/support/animated_target.h"

#include <cmath>
#include <numbers>

namespace lumorph::test {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

glm::vec3 pointAt(double polar, double around) {
    const double radius = 1.0 + 0.07 * std::sin(5.0 * around) * std::sin(polar) * std::sin(4.0 * polar);
    return {radius * std::sin(polar) * std::cos(around), 0.3 * radius * std::cos(polar),
            0.8 * radius * std::sin(polar) * std::sin(around)};
}

TriangleMesh ellipsoid(std::uint32_t around, std::uint32_t rings) {
    TriangleMesh mesh;
    mesh.positions.push_back(pointAt(0.0, 0.0));
    for (std::uint32_t ring = 1; ring <= rings; ++ring)
        for (std::uint32_t k = 0; k < around; ++k)
            mesh.positions.push_back(pointAt(std::numbers::pi * ring / (rings + 1), kTurn * k / around));
    mesh.positions.push_back(pointAt(std::numbers::pi, 0.0));
    const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
    const auto at = [&](std::uint32_t ring, std::uint32_t k) { return 1 + ring * around + k % around; };
    for (std::uint32_t k = 0; k < around; ++k) {
        mesh.triangles.emplace_back(0, at(0, k + 1), at(0, k));
        mesh.triangles.emplace_back(last, at(rings - 1, k), at(rings - 1, k + 1));
        for (std::uint32_t ring = 0; ring + 1 < rings; ++ring) {
            mesh.triangles.emplace_back(at(ring, k), at(ring, k + 1), at(ring + 1, k));
            mesh.triangles.emplace_back(at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k));
        }
    }
    return mesh;
}

} // namespace

Model animatedEllipsoid(std::uint32_t around, std::uint32_t rings) {
    Model model = modelOf(ellipsoid(around, rings), "ellipsoid");
    Model::Primitive& primitive = model.meshes.front().primitives.front();
    std::vector<glm::vec3> bent;
    std::vector<glm::vec3> swollen;
    for (const glm::vec3& p : primitive.positions) {
        bent.emplace_back(0.0F, 0.5F * p.x * p.x, 0.0F);
        swollen.push_back(0.4F * std::exp(-4.0F * (p.x - 0.4F) * (p.x - 0.4F)) * p);
    }
    primitive.morphTargets = {bent, swollen};
    model.meshes.front().targetNames = {"bend", "swell"};
    using Path = Model::Path;
    constexpr auto kLinear = Model::Interpolation::linear;
    const float half = std::sqrt(0.5F);
    model.animations = {
        {"swim",
         {{0, Path::weights, kLinear, {0.0F, 0.7F, 1.4F, 2.0F}, {0, 0, 1, 0.2F, 0.1F, 1, 0, 0}},
          {0, Path::rotation, kLinear, {0.0F, 1.0F, 2.0F}, {0, 0, 0, 1, 0, half, 0, half, 0, 0, 0, 1}}}}};
    return model;
}

} // namespace lumorph::test
