#include "core/geometry/hole_filling.h"

#include <limits>

#include <glm/geometric.hpp>

#include "core/base/error.h"

namespace lumorph {
namespace {

class HoleFiller {
public:
    HoleFiller(std::span<const glm::vec3> rim, const std::function<bool(std::size_t, std::size_t)>& forbidden)
        : rim_(rim), count_(rim.size()), best_(count_ * count_), cost_(count_ * count_, 0.0),
          diagonal_(count_ * count_, 0.0) {
        for (std::size_t i = 0; i < count_; ++i) extent_ += edge(i, (i + 1) % count_);
        for (std::size_t i = 0; i < count_; ++i)
            for (std::size_t j = i + 2; j < count_; ++j)
                if (!(i == 0 && j == count_ - 1) && forbidden(i, j)) diagonal_[i * count_ + j] = penalty();
    }

    std::vector<glm::uvec3> fill() {
        for (std::size_t span = 2; span < count_; ++span)
            for (std::size_t i = 0; i + span < count_; ++i) choose(i, i + span);
        std::vector<glm::uvec3> triangles;
        std::vector<std::pair<std::size_t, std::size_t>> open{{0, count_ - 1}};
        while (!open.empty()) {
            const auto [i, j] = open.back();
            open.pop_back();
            if (j < i + 2) continue;
            const std::size_t k = best_[i * count_ + j];
            triangles.emplace_back(i, k, j);
            open.emplace_back(i, k);
            open.emplace_back(k, j);
        }
        return triangles;
    }

private:
    [[nodiscard]] double edge(std::size_t i, std::size_t j) const noexcept {
        const glm::dvec3 d = glm::dvec3(rim_[i]) - glm::dvec3(rim_[j]);
        return glm::dot(d, d);
    }

    /// More than any filling of the rim without penalties costs.
    [[nodiscard]] double penalty() const noexcept { return 10.0 * static_cast<double>(count_) * extent_; }

    /// Area, and a little for long edges, so that among equal areas the rounder triangles win.
    [[nodiscard]] double cost(std::size_t i, std::size_t k, std::size_t j) const noexcept {
        const glm::dvec3 a(rim_[i]);
        const double area = 0.5 * glm::length(glm::cross(glm::dvec3(rim_[k]) - a, glm::dvec3(rim_[j]) - a));
        const double edges = edge(i, k) + edge(k, j) + edge(j, i);
        const double flat = area <= 1e-9 * edges ? penalty() : 0.0;
        return area + 1e-4 * edges + flat;
    }

    void choose(std::size_t i, std::size_t j) {
        double least = std::numeric_limits<double>::infinity();
        std::size_t chosen = i + 1;
        for (std::size_t k = i + 1; k < j; ++k) {
            const double total = cost_[i * count_ + k] + cost_[k * count_ + j] + cost(i, k, j);
            if (total < least) {
                least = total;
                chosen = k;
            }
        }
        best_[i * count_ + j] = chosen;
        cost_[i * count_ + j] = least + diagonal_[i * count_ + j];
    }

    std::span<const glm::vec3> rim_;
    std::size_t count_;
    std::vector<std::size_t> best_;
    std::vector<double> cost_;
    std::vector<double> diagonal_;
    double extent_ = 0.0;
};

} // namespace

std::vector<glm::uvec3> fillHole(std::span<const glm::vec3> rim,
                                 const std::function<bool(std::size_t, std::size_t)>& forbidden) {
    if (rim.size() < 3 || rim.size() > kMaxHoleEdges)
        throw InvalidInput("rim of a hole", "has " + std::to_string(rim.size()) + " points",
                           "fill holes of 3 to " + std::to_string(kMaxHoleEdges) + " edges");
    return HoleFiller(rim, forbidden).fill();
}

} // namespace lumorph
