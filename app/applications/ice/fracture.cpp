#include "app/applications/ice/fracture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <glm/geometric.hpp>

#include "core/base/error.h"

namespace lumorph::ice {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using Delaunay = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase>>;

constexpr int kLloydRounds = 2;

/// Of which sites each one's cell is bounded: its neighbours in the Delaunay triangulation, ascending, so that the
/// order in which CGAL goes round does not matter. A site at the place of an earlier one is its own neighbour alone.
std::vector<std::vector<std::uint32_t>> neighboursOf(std::span<const glm::dvec2> sites) {
    Delaunay delaunay;
    std::vector<std::vector<std::uint32_t>> neighbours(sites.size());
    for (std::uint32_t k = 0; k < sites.size(); ++k) {
        if (!std::isfinite(sites[k].x) || !std::isfinite(sites[k].y))
            throw InvalidInput("site " + std::to_string(k), "it is not finite", "give finite metres");
        const std::size_t before = delaunay.number_of_vertices();
        const auto vertex = delaunay.insert(Kernel::Point_2(sites[k].x, sites[k].y));
        if (delaunay.number_of_vertices() == before)
            neighbours[k] = {k};
        else
            vertex->info() = k;
    }
    if (delaunay.number_of_vertices() < 2) return neighbours;
    for (const auto vertex : delaunay.finite_vertex_handles()) {
        auto around = delaunay.incident_vertices(vertex);
        const auto first = around;
        std::vector<std::uint32_t>& own = neighbours[vertex->info()];
        do
            if (!delaunay.is_infinite(around)) own.push_back(around->info());
        while (++around != first);
        std::ranges::sort(own);
        own.erase(std::ranges::unique(own).begin(), own.end());
    }
    return neighbours;
}

/// Where it is nearer to the first site than to the second. Seen from either side it is the same line, to the bit.
HalfPlane nearerTo(const glm::dvec2& site, const glm::dvec2& other) {
    const glm::dvec2 middle = 0.5 * (site + other);
    const glm::dvec2 normal = glm::normalize(other - site);
    return {normal, glm::dot(normal, middle)};
}

/// `count` sites on a circle, each somewhat aside.
void addRing(std::vector<glm::dvec2>& sites, const glm::dvec2& place, int count, double radius, double aside,
             std::mt19937_64& random) {
    const double first = chance(random);
    for (int k = 0; k < count; ++k) {
        const double angle = 2.0 * std::numbers::pi * (first + k + aside * (chance(random) - 0.5)) / count;
        const double far = radius * (1.0 + aside * (chance(random) - 0.5));
        sites.push_back(place + far * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
}

} // namespace

double chance(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }

std::vector<Polygon> voronoiCells(const Polygon& piece, std::span<const glm::dvec2> sites) {
    const auto neighbours = neighboursOf(sites);
    std::vector<Polygon> cells(sites.size());
    for (std::uint32_t k = 0; k < sites.size(); ++k) {
        if (neighbours[k] == std::vector{k}) continue;
        cells[k] = piece;
        for (const std::uint32_t other : neighbours[k]) cells[k] = clipped(cells[k], nearerTo(sites[k], sites[other]));
    }
    return cells;
}

std::vector<glm::dvec2> evenSites(const Polygon& piece, int count, std::mt19937_64& random) {
    glm::dvec2 min(piece.front()), max(min);
    for (const glm::dvec2& corner : piece) {
        min = glm::min(min, corner);
        max = glm::max(max, corner);
    }
    std::vector<glm::dvec2> sites;
    while (std::ssize(sites) < count) {
        const double x = chance(random), z = chance(random);
        const glm::dvec2 site = min + (max - min) * glm::dvec2(x, z);
        if (holds(piece, site)) sites.push_back(site);
    }
    for (int round = 0; round < kLloydRounds; ++round) {
        const std::vector<Polygon> cells = voronoiCells(piece, sites);
        for (std::size_t k = 0; k < sites.size(); ++k)
            if (!cells[k].empty()) sites[k] = centreOf(cells[k]);
    }
    return sites;
}

std::vector<glm::dvec2> holeSites(const glm::dvec2& place, std::mt19937_64& random) {
    std::vector<glm::dvec2> sites{place};
    addRing(sites, place, 11, 0.0032, 0.15, random);
    addRing(sites, place, 9, 0.020, 0.4, random);
    return sites;
}

std::vector<glm::dvec2> starSites(const glm::dvec2& place, std::mt19937_64& random) {
    std::vector<glm::dvec2> sites;
    addRing(sites, place, 6, 0.010, 0.12, random);
    addRing(sites, place, 9, 0.028, 0.4, random);
    return sites;
}

} // namespace lumorph::ice
