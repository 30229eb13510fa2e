#include "app/applications/ambient/forms.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include <glm/geometric.hpp>

namespace lumorph::ambient {
namespace {

constexpr float kFullTurn = 2.0F * std::numbers::pi_v<float>;

std::uint32_t addVertex(Primitive& to, const glm::vec3& position, const glm::vec3& normal, const glm::vec2& at) {
    to.positions.push_back(position);
    to.normals.push_back(normal);
    to.texcoords.push_back(at);
    return static_cast<std::uint32_t>(to.positions.size() - 1);
}

/// Joins rings of `around` + 1 vertices each that begin at `first`, from below to above, counterclockwise from outside.
void joinRings(Primitive& to, std::uint32_t first, int rings, int around) {
    const auto stride = static_cast<std::uint32_t>(around + 1);
    for (int ring = 0; ring + 1 < rings; ++ring) {
        for (int k = 0; k < around; ++k) {
            const std::uint32_t a = first + static_cast<std::uint32_t>(ring) * stride + static_cast<std::uint32_t>(k);
            to.triangles.emplace_back(a, a + stride, a + 1);
            to.triangles.emplace_back(a + 1, a + stride, a + stride + 1);
        }
    }
}

/// A value for a corner of the noise's lattice, [0, 1].
double cornerValue(int x, int y, std::uint32_t seed, int period) noexcept {
    const auto wrapped = [period](int i) { return period > 0 ? ((i % period) + period) % period : i; };
    auto hash = static_cast<std::uint32_t>(wrapped(x)) * 0x9E3779B1U ^
                static_cast<std::uint32_t>(wrapped(y)) * 0x85EBCA77U ^ seed * 0xC2B2AE3DU;
    hash = (hash ^ (hash >> 15U)) * 0x2C1B3C6DU;
    hash = (hash ^ (hash >> 12U)) * 0x297A2D39U;
    hash ^= hash >> 15U;
    return static_cast<double>(hash) * 0x1p-32;
}

} // namespace

void addBall(Primitive& to, const glm::vec3& centre, const glm::vec3& radii, int around) {
    const int rings = around / 2 + 1;
    const auto first = static_cast<std::uint32_t>(to.positions.size());
    for (int ring = 0; ring < rings; ++ring) {
        const float up = std::numbers::pi_v<float> * (static_cast<float>(ring) / static_cast<float>(rings - 1) - 0.5F);
        for (int k = 0; k <= around; ++k) {
            const float turn = kFullTurn * static_cast<float>(k) / static_cast<float>(around);
            const glm::vec3 unit(std::cos(up) * std::cos(turn), std::sin(up), std::cos(up) * std::sin(turn));
            addVertex(to, centre + radii * unit, glm::normalize(unit / radii), {turn, up});
        }
    }
    joinRings(to, first, rings, around);
}

void addTurned(Primitive& to, const glm::vec3& foot, std::span<const glm::vec2> profile, int around) {
    for (std::size_t p = 0; p + 1 < profile.size(); ++p) {
        const auto first = static_cast<std::uint32_t>(to.positions.size());
        const glm::vec2 along = profile[p + 1] - profile[p];
        const glm::vec2 out = glm::normalize(glm::vec2(along.y, -along.x));
        for (const std::size_t end : {p, p + 1}) {
            for (int k = 0; k <= around; ++k) {
                const float turn = kFullTurn * static_cast<float>(k) / static_cast<float>(around);
                const glm::vec3 side(std::cos(turn), 0.0F, std::sin(turn));
                addVertex(to, foot + profile[end].x * side + glm::vec3(0.0F, profile[end].y, 0.0F),
                          out.x * side + glm::vec3(0.0F, out.y, 0.0F), {turn, profile[end].y});
            }
        }
        joinRings(to, first, 2, around);
    }
}

void addFace(Primitive& to, std::span<const glm::vec3> corners) {
    const glm::vec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    const auto first = static_cast<std::uint32_t>(to.positions.size());
    for (const glm::vec3& corner : corners) addVertex(to, corner, normal, {corner.x, corner.z});
    for (std::uint32_t k = 1; k + 1 < corners.size(); ++k) to.triangles.emplace_back(first, first + k, first + k + 1);
}

Primitive flatRing(double inner, int around) {
    Primitive ring;
    for (int k = 0; k <= around; ++k) {
        const float turn = kFullTurn * static_cast<float>(k) / static_cast<float>(around);
        const glm::vec3 side(std::cos(turn), 0.0F, std::sin(turn));
        addVertex(ring, static_cast<float>(inner) * side, {0.0F, 1.0F, 0.0F}, {turn, 0.0F});
        addVertex(ring, side, {0.0F, 1.0F, 0.0F}, {turn, 1.0F});
    }
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(around); ++k) {
        ring.triangles.emplace_back(2 * k, 2 * k + 2, 2 * k + 1);
        ring.triangles.emplace_back(2 * k + 1, 2 * k + 2, 2 * k + 3);
    }
    return ring;
}

Primitive strip(float far, float narrow, float wide, int pieces) {
    Primitive made;
    for (int k = 0; k <= pieces; ++k) {
        const float share = static_cast<float>(k) / static_cast<float>(pieces);
        const float half = glm::mix(narrow, wide, share);
        for (const float side : {-1.0F, 1.0F})
            addVertex(made, {far * share, 0.0F, half * side}, {0.0F, 1.0F, 0.0F},
                      {0.5F + 0.5F * share, 0.5F + 0.5F * side});
    }
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(pieces); ++k) {
        made.triangles.emplace_back(2 * k, 2 * k + 1, 2 * k + 2);
        made.triangles.emplace_back(2 * k + 2, 2 * k + 1, 2 * k + 3);
    }
    return made;
}

namespace {

/// Walls below the rim of a terrain: its vertices in order, counterclockwise seen from above.
void addRimWalls(Primitive& to, std::span<const std::uint32_t> rim, float floor) {
    for (std::size_t k = 0; k < rim.size(); ++k) {
        const glm::vec3 a = to.positions[rim[k]], b = to.positions[rim[(k + 1) % rim.size()]];
        const glm::vec3 lowA(a.x, std::min(floor, a.y), a.z), lowB(b.x, std::min(floor, b.y), b.z);
        if (glm::length(glm::cross(lowB - a, b - a)) > 1e-12F) addFace(to, std::array{a, lowA, lowB, b});
    }
}

} // namespace

Primitive terrain(const glm::vec2& min, const glm::vec2& max, const glm::ivec2& quads, float floor,
                  const std::function<float(float, float)>& height) {
    Primitive land;
    const glm::vec2 step = (max - min) / glm::vec2(quads);
    for (int j = 0; j <= quads.y; ++j) {
        for (int i = 0; i <= quads.x; ++i) {
            const glm::vec2 at = min + step * glm::vec2(i, j);
            const float h = 0.25F * step.x;
            const glm::vec3 normal(height(at.x - h, at.y) - height(at.x + h, at.y), 2.0F * h,
                                   height(at.x, at.y - h) - height(at.x, at.y + h));
            addVertex(land, {at.x, height(at.x, at.y), at.y}, glm::normalize(normal),
                      glm::vec2(i, j) / glm::vec2(quads));
        }
    }
    const auto index = [&](int i, int j) { return static_cast<std::uint32_t>(j * (quads.x + 1) + i); };
    for (int j = 0; j < quads.y; ++j) {
        for (int i = 0; i < quads.x; ++i) {
            land.triangles.emplace_back(index(i, j), index(i, j + 1), index(i + 1, j));
            land.triangles.emplace_back(index(i + 1, j), index(i, j + 1), index(i + 1, j + 1));
        }
    }
    std::vector<std::uint32_t> rim;
    for (int i = 0; i < quads.x; ++i) rim.push_back(index(i, quads.y));
    for (int j = quads.y; j > 0; --j) rim.push_back(index(quads.x, j));
    for (int i = quads.x; i > 0; --i) rim.push_back(index(i, 0));
    for (int j = 0; j < quads.y; ++j) rim.push_back(index(0, j));
    addRimWalls(land, rim, floor);
    return land;
}

std::shared_ptr<const SceneModel> modelOf(std::string name, std::vector<Primitive> parts,
                                          std::vector<Material> materials) {
    auto made = std::make_shared<SceneModel>();
    made->materials = std::move(materials);
    made->materials.resize(std::max(made->materials.size(), parts.size()));
    Model& model = made->model;
    model.name = name;
    for (const Material& material : made->materials) model.materials.emplace_back().name = material.name;
    for (std::size_t k = 0; k < parts.size(); ++k) parts[k].material = static_cast<int>(k);
    Model::Mesh mesh;
    mesh.primitives = std::move(parts);
    model.meshes.push_back(std::move(mesh));
    Model::Node node;
    node.name = std::move(name);
    node.mesh = 0;
    model.nodes.push_back(std::move(node));
    model.roots = {0};
    return made;
}

double noiseAt(const glm::dvec2& at, std::uint32_t seed, int period) noexcept {
    const glm::dvec2 cell(std::floor(at.x), std::floor(at.y));
    const auto x = static_cast<int>(cell.x), y = static_cast<int>(cell.y);
    const auto smooth = [](double t) { return t * t * (3.0 - 2.0 * t); };
    const double u = smooth(at.x - cell.x), v = smooth(at.y - cell.y);
    const double low = std::lerp(cornerValue(x, y, seed, period), cornerValue(x + 1, y, seed, period), u);
    const double high = std::lerp(cornerValue(x, y + 1, seed, period), cornerValue(x + 1, y + 1, seed, period), u);
    return std::lerp(low, high, v);
}

std::shared_ptr<const Image> glowPicture(const glm::ivec2& size) {
    auto picture = std::make_shared<Image>(size);
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const glm::vec2 off = glm::abs(2.0F * (glm::vec2(x, y) + 0.5F) / glm::vec2(size) - 1.0F);
            const float along = (1.0F - off.x) * (1.0F - off.x), across = std::exp(-3.5F * off.y * off.y);
            const float rim = std::clamp(4.0F * (1.0F - off.y), 0.0F, 1.0F);
            picture->at(x, y) = {255, 255, 255, static_cast<std::uint8_t>(255.0F * along * across * rim)};
        }
    }
    return picture;
}

std::shared_ptr<const Image> lacePicture(int side, int bubbles, std::uint32_t seed) {
    /// How much farther the second nearest of scattered middles is than the nearest: nothing on the seam between two.
    const auto fromSeam = [&](const glm::dvec2& at) {
        double nearest = 9.0, second = 9.0;
        const int column = static_cast<int>(std::floor(at.x)), row = static_cast<int>(std::floor(at.y));
        for (int j = row - 1; j <= row + 1; ++j) {
            for (int i = column - 1; i <= column + 1; ++i) {
                const glm::dvec2 middle(i + cornerValue(i, j, seed, bubbles),
                                        j + cornerValue(i, j, seed + 1U, bubbles));
                const double away = glm::distance(at, middle);
                second = std::min(second, std::max(nearest, away));
                nearest = std::min(nearest, away);
            }
        }
        return second - nearest;
    };
    auto picture = std::make_shared<Image>(glm::ivec2(side));
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const glm::dvec2 at = static_cast<double>(bubbles) / side * glm::dvec2(x, y);
            const double grain = 0.25 * (noiseAt(4.0 * at, seed + 2U, 4 * bubbles) - 0.5);
            const double lace = std::clamp(1.0 - (fromSeam(at) + grain) / 0.55, 0.0, 1.0);
            picture->at(x, y) = {255, 255, 255, static_cast<std::uint8_t>(255.0 * lace * lace)};
        }
    }
    return picture;
}

std::shared_ptr<const Image> coverPicture(int side, int cells, std::uint32_t seed) {
    std::vector<double> values;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const glm::dvec2 at = static_cast<double>(cells) / side * glm::dvec2(x, y);
            double value = 0.0;
            for (int octave = 0; octave < 4; ++octave)
                value += noiseAt(static_cast<double>(1 << octave) * at, seed + static_cast<std::uint32_t>(octave),
                                 cells << octave) /
                         (1 << octave);
            values.push_back(value);
        }
    }
    // By rank: a threshold then covers just that share.
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t k) { return values[k]; });
    auto picture = std::make_shared<Image>(glm::ivec2(side));
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
        const auto grey = static_cast<std::uint8_t>(rank * 256 / order.size());
        picture->pixels()[order[rank]] = {grey, grey, grey, 255};
    }
    return picture;
}

} // namespace lumorph::ambient
