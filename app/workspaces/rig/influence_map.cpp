#include "app/workspaces/rig/influence_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <QLinearGradient>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/studio/look/palette.h"

namespace lumorph::studio {

namespace {

constexpr float kCover = 0.9F;       // of the surface's own colour
constexpr float kFadesBelow = 0.04F; // of the ramp: so little is blended in, so that there is no hard edge

const std::array<glm::vec3, 5> kRamp{glm::vec3(0.22F, 0.10F, 0.52F), glm::vec3(0.52F, 0.08F, 0.60F),
                                     glm::vec3(0.82F, 0.26F, 0.44F), glm::vec3(0.96F, 0.55F, 0.26F),
                                     glm::vec3(0.98F, 0.92F, 0.30F)};

glm::vec3 rampAt(float share) {
    const float at = std::clamp(share, 0.0F, 1.0F) * static_cast<float>(kRamp.size() - 1);
    const auto lower = std::min(static_cast<std::size_t>(at), kRamp.size() - 2);
    return glm::mix(kRamp[lower], kRamp[lower + 1], at - static_cast<float>(lower));
}

} // namespace

std::vector<float> waysOf(const Rig& rig, std::size_t actuator) {
    constexpr int kSteps = 4; // what turns may come back
    const auto vertices = rig.verticesOf(actuator);
    std::vector<double> strokes(rig.actuatorCount(), 0.0);
    std::vector<glm::vec3> rest(vertices.size()), now(vertices.size());
    rig.deform(strokes, vertices, rest);
    std::vector<float> ways(rig.restMesh().positions.size(), 0.0F);
    for (int step = 1; step <= kSteps; ++step) {
        strokes[actuator] = static_cast<double>(step) / kSteps;
        rig.deform(strokes, vertices, now);
        for (std::size_t v = 0; v < now.size(); ++v)
            ways[vertices[v]] = std::max(ways[vertices[v]], glm::distance(now[v], rest[v]));
    }
    return ways;
}

QColor heatColor(double share) {
    const glm::vec3 color = rampAt(static_cast<float>(share));
    return QColor::fromRgbF(color.r, color.g, color.b);
}

std::shared_ptr<const std::vector<glm::u8vec4>> heatColors(std::span<const float> values, float most) {
    constexpr int kTones = 256;
    std::array<glm::u8vec4, kTones> tones{};
    for (int i = 0; i < kTones; ++i) {
        const float share = static_cast<float>(i) / (kTones - 1);
        tones[i] = glm::u8vec4(glm::vec4(rampAt(share), kCover * std::min(1.0F, share / kFadesBelow)) * 255.0F + 0.5F);
    }
    auto colors = std::make_shared<std::vector<glm::u8vec4>>();
    colors->reserve(values.size());
    const float scale = most > 0.0F ? (kTones - 1) / most : 0.0F;
    for (const float value : values)
        colors->push_back(tones[std::clamp(static_cast<int>(value * scale + 0.5F), 0, kTones - 1)]);
    return colors;
}

void paintHeatLegend(QPainter& painter, const QSize& view, const HeatLegend& legend) {
    constexpr int kWidth = 180, kHeight = 10, kMargin = 20;
    const Palette& colors = currentPalette();
    const QRectF bar(view.width() - kWidth - kMargin, view.height() - 2.2 * kMargin, kWidth, kHeight);
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    QLinearGradient ramp(bar.topLeft(), bar.topRight());
    for (int i = 0; i <= 8; ++i) ramp.setColorAt(i / 8.0, heatColor(i / 8.0));
    painter.setPen(Qt::NoPen);
    painter.setBrush(ramp);
    painter.drawRoundedRect(bar, 3, 3);
    painter.setPen(colors.text);
    const QFontMetricsF metrics(painter.font());
    painter.drawText(QPointF(bar.left(), bar.top() - 0.4 * metrics.height()), legend.title);
    painter.setPen(colors.textMuted);
    const double below = bar.bottom() + metrics.height();
    painter.drawText(QPointF(bar.left(), below), "0");
    painter.drawText(QPointF(bar.right() - metrics.horizontalAdvance(legend.most), below), legend.most);
    painter.restore();
}

} // namespace lumorph::studio
