#pragma once

#include <memory>
#include <span>
#include <vector>

#include <QColor>
#include <QPainter>
#include <QSize>
#include <QString>
#include <glm/gtc/type_precision.hpp>

#include "core/rig/rig.h"

namespace lumorph::studio {

/// Metres that each vertex of the rest mesh goes, at most, while an actuator alone goes through its stroke.
[[nodiscard]] std::vector<float> waysOf(const Rig& rig, std::size_t actuator);

/// From dark violet (0) over red to yellow (1), each lighter than the one before, so that it is read without seeing
/// colours too.
[[nodiscard]] QColor heatColor(double share);
/// A colour for each value over that of the surface, `most` at the ramp's end; what is 0 stays as it is.
[[nodiscard]] std::shared_ptr<const std::vector<glm::u8vec4>> heatColors(std::span<const float> values, float most);

/// What the colours say.
struct HeatLegend {
    QString title;
    QString most; ///< at the ramp's end; at its beginning stands 0
};
/// In the lower right corner of a view.
void paintHeatLegend(QPainter& painter, const QSize& view, const HeatLegend& legend);

} // namespace lumorph::studio
