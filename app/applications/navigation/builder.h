#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/applications/navigation/map.h"
#include "app/applications/navigation/noise.h"
#include "app/applications/navigation/valley_plan.h"

namespace lumorph::navigation {

/// How a quarter is built over: from closed rows in a town's middle to farms in gardens.
struct Quarter {
    glm::dvec2 middle{0.0};
    double reach = 480.0;  ///< metres from the middle to where houses end
    double closed = 0.55;  ///< share of the reach within which houses stand wall to wall
    std::size_t most = 99; ///< houses
};

/// Builds on what is there, and remembers where there is no room any more.
class Builder {
public:
    using Line = std::vector<glm::dvec2>;

    Builder(Map& map, const ValleyPlan& plan, std::uint64_t seed) : map_(map), plan_(plan), seed_(seed) {}

    [[nodiscard]] Map& map() noexcept { return map_; }
    [[nodiscard]] const ValleyPlan& plan() const noexcept { return plan_; }
    [[nodiscard]] std::uint64_t seed() const noexcept { return seed_; }
    [[nodiscard]] const std::vector<Road>& streets() const noexcept { return streets_; }

    [[nodiscard]] double chance() { return chanceOf({++drawn_, 0}, seed_ + 77); }
    template <typename T, std::size_t N> const T& oneOf(const T (&choices)[N]) {
        return choices[std::min(N - 1, static_cast<std::size_t>(chance() * static_cast<double>(N)))];
    }
    [[nodiscard]] double ground(const glm::dvec2& place) const { return map_.heights.at(place, 0.0); }
    /// Follows the shore: metres along it from the town's middle, and inland from the water.
    [[nodiscard]] glm::dvec2 inTown(double along, double inland) const;
    /// On dry ground, `gap` metres from all roads, over nothing else that stands.
    [[nodiscard]] bool free(const Line& outline, double gap) const;

    /// A place that nothing else may take.
    void take(Line outline) { taken_.push_back(std::move(outline)); }
    Building& add(Line outline, double height, double roof, Building::Roof kind);
    /// One of plaster and tiles where there is room for it; its ridge runs along `along`.
    bool house(const glm::dvec2& at, const glm::dvec2& along, double length, double depth, double storeys);
    /// Both sides of a street: its houses, the wings in their courts, gardens and trees.
    void housesAlong(const Line& street, double width, const Quarter& quarter);
    void road(const Line& through, double width, const glm::vec3& color);
    /// Trees along a road where there is room for them, one after `step` metres.
    void avenue(const Road& road, double step);
    void tree(const glm::dvec2& at, double height);
    /// A nave with its choir and a tower with a pointed helmet.
    void church(const glm::dvec2& at, const glm::dvec2& along, double size);

private:
    struct Plot {
        glm::dvec2 at, along, out; ///< of the street, along it and away from it
        double width, front, gap;
    };
    void plot(const Plot& plot, const Quarter& quarter);
    void garden(const Plot& plot, double begins);
    void bridge(const Line& road, double width);

    Map& map_;
    const ValleyPlan& plan_;
    std::uint64_t seed_;
    int drawn_ = 0;
    std::vector<Line> taken_;
    std::vector<Road> streets_;
};

/// Fields in strips on flat ground, with hedges, and trees in them.
void layFields(Builder& builder);

} // namespace lumorph::navigation
