#include "core/render/gl/pixel_region.h"

#include <cmath>

#include <glm/common.hpp>

#include "core/render/gl/few_areas.h"

namespace lumorph {
namespace {

constexpr std::size_t kMostParts = 6;

} // namespace

PixelRectangle united(const PixelRectangle& a, const PixelRectangle& b) {
    if (a.empty() || b.empty()) return a.empty() ? b : a;
    return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

PixelRectangle common(const PixelRectangle& a, const PixelRectangle& b) {
    return {glm::max(a.low, b.low), glm::min(a.high, b.high)};
}

std::array<PixelRectangle, 4> around(const PixelRectangle& area, const PixelRectangle& whole) {
    const PixelRectangle inner{glm::clamp(area.low, whole.low, whole.high),
                               glm::clamp(area.high, whole.low, whole.high)};
    if (inner.empty()) return {{whole, {}, {}, {}}};
    return {{{whole.low, {whole.high.x, inner.low.y}},
             {{whole.low.x, inner.high.y}, whole.high},
             {{whole.low.x, inner.low.y}, {inner.low.x, inner.high.y}},
             {{inner.high.x, inner.low.y}, {whole.high.x, inner.high.y}}}};
}

PixelRectangle pixelRectangle(const glm::dvec2& low, const glm::dvec2& high, glm::ivec2 size) {
    const glm::dvec2 whole(size);
    const glm::dvec2 least = glm::clamp(low, glm::dvec2(0.0), whole);
    const glm::dvec2 most = glm::clamp(high, glm::dvec2(0.0), whole);
    return {{static_cast<int>(least.x), static_cast<int>(whole.y - most.y)},
            {static_cast<int>(std::ceil(most.x)), static_cast<int>(std::ceil(whole.y - least.y))}};
}

void PixelRegion::include(const PixelRectangle& part) {
    if (!part.empty()) addToFew(parts_, part, kMostParts, united, [](const PixelRectangle& one) { return one.size(); });
}

void PixelRegion::include(const PixelRegion& other) {
    for (const PixelRectangle& part : other.parts_) include(part);
}

PixelRectangle PixelRegion::bounds() const {
    PixelRectangle all;
    for (const PixelRectangle& part : parts_) all = united(all, part);
    return all;
}

} // namespace lumorph
