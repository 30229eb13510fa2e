#pragma once

#include <QPointF>

#include <glm/vec2.hpp>

namespace lumorph::studio {

/// What of a drawing's page a widget shows. Places are (x, z) in metres, z down the page.
struct PageView {
    glm::dvec2 middle{0.0}; ///< the place at `centre`
    double scale = 2000.0;  ///< pixels a metre
    QPointF centre;         ///< pixels
    bool operator==(const PageView&) const = default;

    [[nodiscard]] QPointF pixel(const glm::dvec2& place) const {
        return centre + scale * QPointF(place.x - middle.x, place.y - middle.y);
    }
    [[nodiscard]] glm::dvec2 place(const QPointF& pixel) const {
        const QPointF off = (pixel - centre) / scale;
        return middle + glm::dvec2(off.x(), off.y());
    }
};

} // namespace lumorph::studio
