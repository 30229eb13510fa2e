#include "core/geometry/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <queue>
#include <set>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"

namespace lumorph {
namespace {

/// A sheet of `nx` x `ny` squares, each cut along one diagonal or the other, carried to where `place` says.
TriangleMesh sheet(int nx, int ny, const std::function<glm::vec3(double, double)>& place) {
    TriangleMesh mesh;
    for (int y = 0; y <= ny; ++y)
        for (int x = 0; x <= nx; ++x)
            mesh.positions.push_back(place(static_cast<double>(x) / nx, static_cast<double>(y) / ny));
    const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (nx + 1) + x); };
    for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x) {
            const std::uint32_t a = at(x, y), b = at(x + 1, y), c = at(x + 1, y + 1), d = at(x, y + 1);
            if ((x + y) % 2 == 0) {
                mesh.triangles.emplace_back(a, b, c);
                mesh.triangles.emplace_back(a, c, d);
            } else {
                mesh.triangles.emplace_back(a, b, d);
                mesh.triangles.emplace_back(b, c, d);
            }
        }
    return mesh;
}

TriangleMesh flatSheet(int n) {
    return sheet(n, n, [](double x, double y) { return glm::vec3(0.2 * x, 0.0, 0.2 * y); });
}

/// The same triangles, one of them once more from the other side of an edge: no manifold any longer.
TriangleMesh withFin(TriangleMesh mesh) {
    const glm::uvec3 last = mesh.triangles.back();
    mesh.positions.push_back(mesh.positions[last.x] + glm::vec3(0.0F, 0.01F, 0.0F));
    mesh.triangles.emplace_back(last.x, last.y, static_cast<std::uint32_t>(mesh.positions.size() - 1));
    mesh.triangles.emplace_back(last.y, last.x, static_cast<std::uint32_t>(mesh.positions.size() - 1));
    return mesh;
}

/// By the edges alone, literally: as long as any of them makes a way shorter.
std::vector<double> byEdges(const TriangleMesh& mesh, std::uint32_t from) {
    std::vector<double> far(mesh.positions.size(), 1e9);
    far[from] = 0.0;
    for (bool shorter = true; shorter;) {
        shorter = false;
        for (const glm::uvec3& t : mesh.triangles)
            for (int k = 0; k < 3; ++k)
                for (const auto& [a, b] : {std::pair(t[k], t[(k + 1) % 3]), std::pair(t[(k + 1) % 3], t[k])}) {
                    const double way =
                        far[a] + static_cast<double>(glm::distance(mesh.positions[a], mesh.positions[b]));
                    if (way < far[b] - 1e-12) far[b] = way, shorter = true;
                }
    }
    return far;
}

TEST(SurfaceDistance, OnAFlatSheetIsTheStraightLine) {
    for (const bool fin : {false, true}) {
        const TriangleMesh mesh = fin ? withFin(flatSheet(40)) : flatSheet(40);
        for (const glm::vec3& place : {glm::vec3(0.1F, 0.0F, 0.1F), glm::vec3(0.0613F, 0.0F, 0.1187F)}) {
            const SurfaceDistances distances = surfaceDistances(mesh, std::vector{place});
            EXPECT_EQ(distances.heat, !fin);
            double worst = 0.0;
            for (std::size_t v = 0; v < 41 * 41; ++v) {
                const double truth = glm::distance(mesh.positions[v], place);
                worst = std::max(worst, std::abs(distances.metres[v] - truth) / std::max(truth, 0.02));
            }
            RecordProperty(fin ? "marched" : "heat", std::to_string(worst));
            std::printf("%s: worst error %.2f %%\n", fin ? "marched" : "by heat", 100.0 * worst);
            EXPECT_LT(worst, fin ? 0.01 : 0.06);
        }
    }
}

TEST(SurfaceDistance, AroundATubeIsTheUnrolledOne) {
    constexpr double kRadius = 0.05, kLength = 0.2;
    constexpr int kAround = 96, kAlong = 60;
    TriangleMesh mesh = sheet(kAround, kAlong, [](double x, double y) {
        const double angle = 2.0 * std::numbers::pi * x;
        return glm::vec3(kRadius * std::cos(angle), kLength * y, kRadius * std::sin(angle));
    });
    // The last column is the first one, bit for bit: a seam of vertices at one place.
    for (int y = 0; y <= kAlong; ++y) mesh.positions[y * (kAround + 1) + kAround] = mesh.positions[y * (kAround + 1)];
    const std::uint32_t from = 20 * (kAround + 1) + 10;
    const auto distances = surfaceDistances(mesh, std::vector{mesh.positions[from]});
    EXPECT_TRUE(distances.heat);
    double worst = 0.0;
    for (int y = 0; y <= kAlong; ++y)
        for (int x = 0; x <= kAround; ++x) {
            const double turn = 2.0 * std::numbers::pi * std::abs(x - 10) / kAround;
            const double around = kRadius * std::min(turn, 2.0 * std::numbers::pi - turn);
            const double truth = std::hypot(around, kLength * (y - 20) / kAlong);
            worst = std::max(worst, std::abs(distances.metres[y * (kAround + 1) + x] - truth) / std::max(truth, 0.02));
        }
    std::printf("tube: worst error %.2f %%\n", 100.0 * worst);
    EXPECT_LT(worst, 0.06);
}

TEST(SurfaceDistance, IsNoLongerThanAlongEdgesAndNoShorterThanStraight) {
    // Few and long triangles, on which the heat method alone is far off.
    for (const bool fin : {false, true}) {
        const auto hills = [](double x, double y) {
            return glm::vec3(0.2 * x, 0.02 * std::sin(9.0 * x) * std::cos(7.0 * y), 0.2 * y * y);
        };
        const TriangleMesh mesh = fin ? withFin(sheet(17, 6, hills)) : sheet(17, 6, hills);
        const auto far = surfaceDistances(mesh, std::vector{mesh.positions[40]}).metres;
        const auto longest = byEdges(mesh, 40);
        for (std::size_t v = 0; v < far.size(); ++v) {
            EXPECT_LE(far[v], longest[v] + 1e-6) << v;
            EXPECT_GE(far[v], glm::distance(mesh.positions[v], mesh.positions[40]) - 2e-4F) << v;
        }
    }
}

TEST(SurfaceDistance, FromManyPlacesIsThatFromTheNearestAndOtherPiecesAreFar) {
    TriangleMesh mesh = flatSheet(30);
    const std::size_t first = mesh.positions.size();
    const TriangleMesh other = flatSheet(3);
    for (const glm::vec3& p : other.positions) mesh.positions.push_back(p + glm::vec3(0.0F, 0.1F, 0.0F));
    for (const glm::uvec3& t : other.triangles) mesh.triangles.push_back(t + static_cast<std::uint32_t>(first));
    std::vector<glm::vec3> line;
    for (int i = 0; i <= 40; ++i) line.emplace_back(0.05F, 0.0F, 0.005F * static_cast<float>(i));
    const auto far = surfaceDistances(mesh, line).metres;
    for (std::size_t v = 0; v < far.size(); ++v) {
        if (v >= first) {
            EXPECT_TRUE(std::isinf(far[v])) << "no way leads there";
        } else {
            EXPECT_NEAR(far[v], std::abs(mesh.positions[v].x - 0.05F), 0.004) << v;
        }
    }
}

TEST(SurfaceDistance, DoesNotCrossASlit) {
    // Two sheets side by side, which have an edge's places in common but not its vertices, joined at one end alone.
    TriangleMesh mesh = flatSheet(20);
    std::vector<std::uint32_t> twin(21);
    for (int y = 0; y < 20; ++y) { // the uppermost place stays joined
        twin[y] = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back(mesh.positions[y * 21 + 10] + glm::vec3(1e-5F, 0.0F, 0.0F));
    }
    twin[20] = 20 * 21 + 10;
    for (glm::uvec3& t : mesh.triangles) {
        const float x = (mesh.positions[t.x].x + mesh.positions[t.y].x + mesh.positions[t.z].x) / 3.0F;
        for (int k = 0; k < 3; ++k)
            if (x > 0.1F && t[k] % 21 == 10 && t[k] < 441) t[k] = twin[t[k] / 21];
    }
    const auto far = surfaceDistances(mesh, std::vector{glm::vec3(0.08F, 0.0F, 0.0F)}).metres;
    const double around = std::hypot(0.02, 0.2) + std::hypot(0.02, 0.2);
    EXPECT_NEAR(far[12], around, 0.02);
}

TEST(SurfaceDistance, FindsWhatLiesAcrossASheet) {
    TriangleMesh mesh = flatSheet(4);
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    const TriangleMesh above = mesh;
    for (glm::uvec3& t : mesh.triangles) std::swap(t.x, t.y); // the upper side looks up
    for (const glm::vec3& p : above.positions) mesh.positions.push_back(p - glm::vec3(0.0F, 0.003F, 0.0F));
    for (const glm::uvec3& t : above.triangles) mesh.triangles.push_back(t + count);
    const std::vector<glm::vec3> point{{0.07F, 0.02F, 0.03F}};
    const auto both = placesOnBothSides(mesh, point, 0.01);
    ASSERT_EQ(both.size(), 2U);
    EXPECT_LT(glm::distance(both[0], glm::vec3(0.07F, 0.0F, 0.03F)), 1e-6F);
    EXPECT_LT(glm::distance(both[1], glm::vec3(0.07F, -0.003F, 0.03F)), 1e-6F);
    EXPECT_EQ(placesOnBothSides(mesh, point, 0.002).size(), 1U) << "it is thicker than that";
}

TEST(SurfaceDistance, NamesWhatIsWrong) {
    const TriangleMesh mesh = flatSheet(2);
    EXPECT_THROW((void)surfaceDistances(mesh, {}), InvalidInput);
    EXPECT_THROW((void)surfaceDistances(mesh, std::vector{glm::vec3(NAN, 0.0F, 0.0F)}), InvalidInput);
    EXPECT_THROW((void)surfaceDistances({}, std::vector{glm::vec3(0.0F)}), InvalidInput);
    TriangleMesh flat = mesh;
    for (glm::vec3& p : flat.positions) p.z = 0.0F;
    EXPECT_THROW((void)surfaceDistances(flat, std::vector{glm::vec3(0.0F)}), InvalidInput) << "no area";
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW((void)surfaceDistances(mesh, std::vector{glm::vec3(0.0F)}, Progress({}, stop.get_token())), Cancelled);
}

} // namespace
} // namespace lumorph
