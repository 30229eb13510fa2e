#include "calibration/registration/dwells.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "core/base/statistics.h"

namespace lumorph {

namespace {

glm::dvec3 middleOf(std::span<const TimedPlace> places) {
    glm::dvec3 middle;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> values;
        for (const TimedPlace& at : places) values.push_back(at.place[axis]);
        middle[axis] = median(std::move(values));
    }
    return middle;
}

/// The mean of those that are not far from the middle: steadier than the median alone.
glm::dvec3 restOf(std::span<const TimedPlace> places, double radius) {
    const glm::dvec3 middle = middleOf(places);
    std::vector<double> from;
    for (const TimedPlace& at : places) from.push_back(glm::distance(at.place, middle));
    const double near = std::min(radius, std::max(1e-6, 2.0 * median(from)));
    glm::dvec3 sum(0.0);
    double count = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (from[i] <= near) {
            sum += places[i].place;
            count += 1.0;
        }
    return count > 0.0 ? sum / count : middle;
}

bool rests(std::span<const TimedPlace> places, double radius) {
    const glm::dvec3 middle = middleOf(places);
    return std::ranges::all_of(places, [&](const TimedPlace& at) { return glm::distance(at.place, middle) <= radius; });
}

} // namespace

std::vector<Dwell> findDwells(std::span<const TimedPlace> places, double shortest, double radius) {
    std::vector<Dwell> dwells;
    for (std::size_t i = 0; i < places.size();) {
        std::size_t end = i;
        while (end < places.size() && places[end].seconds - places[i].seconds < shortest) ++end;
        if (end == places.size()) break;
        if (!rests(places.subspan(i, end + 1 - i), radius)) {
            ++i;
            continue;
        }
        // On as long as what comes is near the middle of what was.
        const glm::dvec3 middle = middleOf(places.subspan(i, end + 1 - i));
        while (end + 1 < places.size() && glm::distance(places[end + 1].place, middle) <= radius) ++end;
        const auto there = places.subspan(i, end + 1 - i);
        dwells.push_back({there.front().seconds, there.back().seconds, restOf(there, radius), there.size(), i});
        i = end + 1;
    }
    return dwells;
}

} // namespace lumorph
