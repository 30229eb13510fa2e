#include "app/applications/ice/koi_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/ice/fracture.h"

namespace lumorph::ice {
namespace {

using Primitive = Model::Primitive;

constexpr int kRings = 15, kRingSides = 8;

/// Half its width at a share of its length from the nose.
double girth(double share) { return 0.115 * std::pow(std::sin(std::numbers::pi * std::pow(share, 0.62)), 0.8) + 0.012; }

/// Sideways bend of the spine: the tail swings most.
double bendAt(double share, double phase) { return 0.10 * (0.15 + share * share) * std::sin(phase - 3.6 * share); }

glm::dvec2 pictured(double share, double across) { return {share, 0.5 + 2.2 * across}; }

void add(Primitive& koi, const glm::dvec3& place, const glm::dvec3& normal, const glm::dvec2& picture) {
    koi.positions.emplace_back(place);
    koi.normals.emplace_back(glm::normalize(normal));
    koi.texcoords.emplace_back(picture);
}

void addBody(Primitive& koi, double phase) {
    for (int ring = 0; ring < kRings; ++ring) {
        const double share = 0.86 * ring / (kRings - 1);
        const double wide = ring == 0 ? 0.004 : girth(share / 0.86);
        const double bend = bendAt(share, phase);
        for (int k = 0; k < kRingSides; ++k) {
            const double angle = 2.0 * std::numbers::pi * k / kRingSides;
            const glm::dvec3 out(0.0, std::cos(angle), std::sin(angle));
            add(koi, {0.5 - share, 0.9 * wide * out.y, bend + wide * out.z},
                out + glm::dvec3(ring < 3 ? 0.6 : 0.0, 0.0, 0.0), pictured(share, wide * out.z));
        }
    }
    for (std::uint32_t ring = 0; ring + 1 < kRings; ++ring)
        for (std::uint32_t k = 0; k < kRingSides; ++k) {
            const std::uint32_t a = ring * kRingSides + k, b = ring * kRingSides + (k + 1) % kRingSides;
            koi.triangles.emplace_back(a, a + kRingSides, b);
            koi.triangles.emplace_back(b, a + kRingSides, b + kRingSides);
        }
}

/// A thin fin, seen from above and from below.
void addFin(Primitive& koi, const std::array<glm::dvec3, 3>& corners) {
    for (const double side : {1.0, -1.0}) {
        const auto first = static_cast<std::uint32_t>(koi.positions.size());
        for (const glm::dvec3& corner : corners)
            add(koi, corner + glm::dvec3(0.0, 0.002 * side, 0.0), {0.0, side, 0.0}, {0.97, 0.5});
        const double up = glm::cross(corners[1] - corners[0], corners[2] - corners[0]).y;
        if ((up > 0.0) == (side > 0.0))
            koi.triangles.emplace_back(first, first + 1, first + 2);
        else
            koi.triangles.emplace_back(first, first + 2, first + 1);
    }
}

void addFins(Primitive& koi, double phase) {
    const auto spine = [&](double share) { return glm::dvec3(0.5 - share, 0.0, bendAt(share, phase)); };
    const double sway = 0.10 * std::sin(phase - 4.2);
    for (const double side : {1.0, -1.0}) {
        addFin(koi, {spine(0.80), spine(1.02) + glm::dvec3(0.0, 0.012, 0.085 * side + sway), spine(0.92)});
        addFin(koi, {spine(0.26) + glm::dvec3(0.0, 0.0, 0.09 * side), spine(0.42) + glm::dvec3(0.0, -0.01, 0.21 * side),
                     spine(0.37) + glm::dvec3(0.0, 0.0, 0.09 * side)});
        addFin(koi, {spine(0.55) + glm::dvec3(0.0, 0.0, 0.07 * side), spine(0.66) + glm::dvec3(0.0, -0.01, 0.13 * side),
                     spine(0.62) + glm::dvec3(0.0, 0.0, 0.06 * side)});
    }
}

} // namespace

SceneModel koiModel(int pose) {
    const double phase = 2.0 * std::numbers::pi * pose / kKoiPoses;
    Primitive koi;
    addBody(koi, phase);
    addFins(koi, phase);
    Model::Mesh mesh;
    mesh.name = "Koi";
    mesh.primitives.push_back(std::move(koi));
    SceneModel made;
    made.model.name = "Koi";
    made.model.meshes.push_back(std::move(mesh));
    Model::Node node;
    node.name = "Koi";
    node.mesh = 0;
    made.model.nodes.push_back(std::move(node));
    made.model.roots = {0};
    return made;
}

Image koiPicture(int number) {
    std::mt19937_64 random(static_cast<std::uint64_t>(number) * 7919 + 11);
    struct Patch {
        glm::dvec2 place;
        glm::dvec2 size;
    };
    std::vector<Patch> patches;
    const double share = chance(random);
    for (int k = 0; k < 6; ++k) {
        const double x = (k + chance(random)) / 6.0, y = 0.35 + 0.3 * chance(random);
        patches.push_back({{x, y}, {0.05 + 0.10 * chance(random), 0.14 + 0.22 * chance(random)}});
    }
    const bool golden = number % 3 == 2;
    Image picture({96, 48});
    for (int j = 0; j < 48; ++j)
        for (int i = 0; i < 96; ++i) {
            const glm::dvec2 at(i / 95.0, j / 47.0);
            double red = number % 3 == 0 ? 1.0 : 0.0;
            for (const Patch& patch : patches) {
                const glm::dvec2 from = (at - patch.place) / patch.size;
                red = std::max(red, std::clamp(4.0 * (1.0 - glm::length(from) +
                                                      0.15 * std::sin(31.0 * at.x + 19.0 * at.y + 7.0 * share)),
                                               0.0, 1.0));
            }
            const glm::dvec3 scales(golden ? glm::dvec3(1.0, 0.72, 0.22) : glm::dvec3(1.0, 0.24, 0.05));
            const glm::dvec3 white(0.98, 0.95, 0.90);
            const double edge = 1.0 - 0.25 * std::pow(std::abs(2.0 * at.y - 1.0), 2.0);
            glm::dvec3 color = glm::mix(white, scales, red) * edge;
            if (at.x > 0.9) color = glm::mix(color, glm::dvec3(1.0, 0.62, 0.42), 0.6); // fins
            picture.at(i, j) = {static_cast<std::uint8_t>(255.0 * color.x), static_cast<std::uint8_t>(255.0 * color.y),
                                static_cast<std::uint8_t>(255.0 * color.z), 255};
        }
    return picture;
}

} // namespace lumorph::ice
