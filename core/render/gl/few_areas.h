#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

/// Private to core/render.
namespace lumorph {

/// Adds an area to few others, each of which costs a drawing of its own: they become one where that costs nothing, or
/// there would be more than `most`. `united(a, b)` holds both; `size(a)` is what an area costs.
template <class Area, class United, class Size>
void addToFew(std::vector<Area>& areas, Area area, std::size_t most, United united, Size size) {
    while (!areas.empty()) {
        const auto growth = [&](const Area& other) { return size(united(area, other)) - size(other); };
        const auto nearest = std::ranges::min_element(areas, {}, growth);
        if (growth(*nearest) > size(area) && areas.size() < most) break;
        area = united(area, *nearest);
        areas.erase(nearest);
    }
    areas.push_back(area);
}

} // namespace lumorph
