#include "app/workspaces/rig/sheet_painter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <QPolygonF>
#include <QtMath>

#include <glm/geometric.hpp>

#include "app/studio/look/palette.h"
#include "app/studio/widgets/plot_axes.h"

namespace lumorph::studio {

namespace {

using Kind = SheetPart::Kind;

constexpr double kHandle = 4.5; ///< pixels, half a handle's side
constexpr double kFinest = 9.0; ///< pixels between lines of a grid that one can aim at

class PagePainter {
public:
    PagePainter(QPainter& painter, const PageView& view, const QRect& area)
        : painter_(painter), view_(view), area_(area) {}

    void paint() {
        painter_.fillRect(area_, colors_.sunken);
        drawGrid();
        drawRulers();
    }

private:
    void drawGrid() {
        const double fine = gridSpacing(view_);
        drawGridLines(fine, blend(colors_.sunken, colors_.line, 0.55));
        drawGridLines(labelSpacing(fine),
                      blend(colors_.sunken, colors_.line, currentTheme() == Theme::dark ? 1.4 : 1.0));
    }

    /// Between two labels of a ruler: a whole number of fine steps, and nice itself.
    [[nodiscard]] double labelSpacing(double fine) const {
        constexpr double kLeast = 56.0; // pixels
        const double decade = std::pow(10.0, std::floor(std::log10(fine) + 1e-9));
        for (const double step : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0}) {
            const double steps = step * decade / fine;
            if (step * decade * view_.scale >= kLeast && std::abs(steps - std::round(steps)) < 1e-6)
                return step * decade;
        }
        return 100.0 * decade;
    }

    void drawGridLines(double spacing, const QColor& color) {
        painter_.setPen(QPen(color, 1.0));
        const QRectF area = area_;
        const glm::dvec2 low = view_.place(area.topLeft()), high = view_.place(area.bottomRight());
        for (double x = spacing * std::ceil(low.x / spacing); x < high.x; x += spacing) {
            const double at = std::round(view_.pixel({x, 0.0}).x());
            painter_.drawLine(QPointF(at, area.top()), QPointF(at, area.bottom()));
        }
        for (double y = spacing * std::ceil(low.y / spacing); y < high.y; y += spacing) {
            const double at = std::round(view_.pixel({0.0, y}).y());
            painter_.drawLine(QPointF(area.left(), at), QPointF(area.right(), at));
        }
    }

    void drawRulers() {
        const QRectF area = area_;
        painter_.setPen(Qt::NoPen);
        painter_.setBrush(colors_.panel);
        painter_.drawRect(QRectF(area.left(), area.top(), area.width(), kRulerWidth));
        painter_.drawRect(QRectF(area.left(), area.top(), kRulerWidth, area.height()));
        painter_.setFont(plotFont(painter_.font()));
        drawTicks(true);
        drawTicks(false);
        painter_.setPen(QPen(colors_.line, 1.0));
        painter_.drawLine(QPointF(area.left(), kRulerWidth), QPointF(area.right(), kRulerWidth));
        painter_.drawLine(QPointF(kRulerWidth, area.top()), QPointF(kRulerWidth, area.bottom()));
        painter_.setPen(Qt::NoPen);
        painter_.setBrush(colors_.panel);
        painter_.drawRect(QRectF(area.left(), area.top(), kRulerWidth - 1, kRulerWidth - 1));
        painter_.setPen(colors_.textMuted);
        painter_.drawText(QRectF(area.left(), area.top(), kRulerWidth, kRulerWidth), Qt::AlignCenter, "cm");
    }

    void drawTicks(bool across) {
        const double fine = gridSpacing(view_);
        const double labelled = labelSpacing(fine);
        const long every = std::lround(labelled / fine);
        const glm::dvec2 low = view_.place(area_.topLeft());
        const glm::dvec2 high = view_.place(area_.bottomRight());
        const int axis = across ? 0 : 1;
        const int decimals = labelled < 0.0099 ? 1 : 0;
        const auto first = static_cast<long>(std::ceil(low[axis] / fine));
        const auto last = static_cast<long>(std::floor(high[axis] / fine));
        for (long k = first; k <= last; ++k) {
            glm::dvec2 place(0.0);
            place[axis] = static_cast<double>(k) * fine;
            const QPointF pixel = view_.pixel(place);
            const double at = std::round(across ? pixel.x() : pixel.y());
            const bool major = k % every == 0;
            const double length = major ? 8.0 : 4.0;
            painter_.setPen(QPen(major ? colors_.textMuted : colors_.border, 1.0));
            if (across)
                painter_.drawLine(QPointF(at, kRulerWidth - length), QPointF(at, kRulerWidth));
            else
                painter_.drawLine(QPointF(kRulerWidth - length, at), QPointF(kRulerWidth, at));
            if (!major) continue;
            const QString text = QString::number(100.0 * place[axis] + 0.0, 'f', decimals);
            painter_.save();
            painter_.translate(across ? QPointF(at, 7.0) : QPointF(8.0, at));
            if (!across) painter_.rotate(-90.0);
            painter_.drawText(QRectF(-30.0, -7.0, 60.0, 14.0), Qt::AlignCenter, text);
            painter_.restore();
        }
    }

    QPainter& painter_;
    const PageView& view_;
    const QRect& area_;
    const Palette& colors_ = currentPalette();
};

class SheetPainter {
public:
    SheetPainter(QPainter& painter, const SheetPage& picture, const QPixmap& page)
        : painter_(painter), picture_(picture), page_(page) {}

    void paint() {
        painter_.drawPixmap(picture_.area.topLeft(), page_);
        drawSheet();
        painter_.setRenderHint(QPainter::Antialiasing);
        drawFlaps();
        drawOutline();
        drawMiddle();
        for (std::size_t k = 0; k < picture_.device.bends.size(); ++k) drawLine(k);
        drawBegun();
        drawPointer();
        drawRulers();
        drawReadout();
    }

private:
    [[nodiscard]] QPolygonF polygon(const std::vector<glm::dvec2>& points) const {
        QPolygonF polygon;
        for (const glm::dvec2& p : points) polygon << picture_.view.pixel(p);
        return polygon;
    }

    void drawSheet() {
        QColor fill = blend(colors_.raised, colors_.text, currentTheme() == Theme::dark ? 0.10 : 0.04);
        fill.setAlphaF(0.72); // the grid goes on under it
        painter_.setPen(Qt::NoPen);
        painter_.setBrush(fill);
        painter_.drawPolygon(polygon(picture_.device.outline));
    }

    void drawFlaps() {
        if (!picture_.plan) return;
        for (std::size_t k = 0; k < picture_.plan->flaps.size(); ++k) {
            const auto& actuator = picture_.plan->actuators[k];
            if (!actuator || picture_.plan->flaps[k].empty()) continue;
            QColor color = flapColor(*actuator);
            painter_.setPen(QPen(color, 1.2));
            color.setAlphaF(isChosen(k) ? 0.5 : 0.3);
            painter_.setBrush(color);
            painter_.drawPolygon(polygon(picture_.plan->flaps[k]));
        }
    }

    [[nodiscard]] bool isChosen(std::size_t line) const {
        return picture_.chosen.isLine() && picture_.chosen.index == line;
    }
    [[nodiscard]] bool isHovered(std::size_t line) const {
        return picture_.hovered.isLine() && picture_.hovered.index == line;
    }
    [[nodiscard]] const SheetRefusal* refusalOf(std::optional<std::size_t> line) const {
        if (!picture_.plan || picture_.plan->flaps.size() != picture_.device.bends.size()) return nullptr;
        const auto found = std::ranges::find(picture_.plan->refusals, line, &SheetRefusal::line);
        return found == picture_.plan->refusals.end() ? nullptr : &*found;
    }

    void drawOutline() {
        const std::vector<glm::dvec2>& outline = picture_.device.outline;
        if (outline.empty()) return;
        const bool wrong = refusalOf(std::nullopt) != nullptr;
        painter_.setBrush(Qt::NoBrush);
        painter_.setPen(QPen(wrong ? colors_.danger : colors_.text, wrong ? 2.4 : 1.6));
        painter_.drawPolygon(polygon(outline));
        if (picture_.hovered.kind == Kind::edge && picture_.hovered.index < outline.size()) drawEdge(picture_.hovered);
        if (picture_.chosen.kind == Kind::edge && picture_.chosen.index < outline.size()) drawEdge(picture_.chosen);
        for (const std::size_t k : outlineCorners(outline)) {
            const SheetPart corner{Kind::corner, k};
            drawHandle(outline[k], colors_.text, corner == picture_.chosen, corner == picture_.hovered);
        }
    }

    void drawEdge(const SheetPart& edge) {
        const std::vector<glm::dvec2>& outline = picture_.device.outline;
        painter_.setPen(QPen(colors_.accent, 3.0, Qt::SolidLine, Qt::RoundCap));
        painter_.drawLine(picture_.view.pixel(outline[edge.index]),
                          picture_.view.pixel(outline[(edge.index + 1) % outline.size()]));
    }

    void drawHandle(const glm::dvec2& place, const QColor& color, bool chosen, bool hovered) {
        const QPointF at = picture_.view.pixel(place);
        const double half = kHandle + (hovered ? 1.5 : 0.0);
        painter_.setPen(QPen(chosen || hovered ? colors_.accent : color, 1.5));
        painter_.setBrush(chosen ? colors_.accent : colors_.sunken);
        painter_.drawRect(QRectF(at.x() - half, at.y() - half, 2.0 * half, 2.0 * half));
    }

    /// The drawing's middle, which copies go around and about which is mirrored.
    void drawMiddle() {
        constexpr double kArm = 8.0;
        const QPointF at = picture_.view.pixel({0.0, 0.0});
        painter_.setPen(QPen(colors_.accentText, 1.2));
        painter_.drawLine(at - QPointF(kArm, 0.0), at + QPointF(kArm, 0.0));
        painter_.drawLine(at - QPointF(0.0, kArm), at + QPointF(0.0, kArm));
        painter_.setBrush(Qt::NoBrush);
        painter_.drawEllipse(at, 3.5, 3.5);
    }

    [[nodiscard]] QColor lineColor(std::size_t k) const {
        if (refusalOf(k) != nullptr) return colors_.danger;
        if (isChosen(k)) return colors_.accent;
        if (picture_.plan && k < picture_.plan->actuators.size() && picture_.plan->actuators[k])
            return flapColor(*picture_.plan->actuators[k]);
        return colors_.textMuted;
    }

    void drawLine(std::size_t k) {
        const BendLine& bend = picture_.device.bends[k];
        const QPointF from = picture_.view.pixel(bend.from), to = picture_.view.pixel(bend.to);
        const QColor color = lineColor(k);
        const bool wrong = refusalOf(k) != nullptr;
        const bool strong = wrong || isChosen(k) || isHovered(k);
        painter_.setPen(QPen(color, strong ? 3.0 : 2.0, wrong ? Qt::DashLine : Qt::SolidLine, Qt::RoundCap));
        painter_.drawLine(from, to);
        if (!wrong) drawSide(k, color);
        drawName(k, color);
        if (!isChosen(k) && !isHovered(k)) return;
        drawEnd(bend.from, color, picture_.hovered == SheetPart{Kind::lineFrom, k});
        drawEnd(bend.to, color, picture_.hovered == SheetPart{Kind::lineTo, k});
    }

    void drawEnd(const glm::dvec2& place, const QColor& color, bool hovered) {
        painter_.setPen(QPen(color, 2.0));
        painter_.setBrush(hovered ? color : colors_.sunken);
        painter_.drawEllipse(picture_.view.pixel(place), kHandle + (hovered ? 1.5 : 0.5),
                             kHandle + (hovered ? 1.5 : 0.5));
    }

    /// Away from the middle of a line to where its flap lies, one pixel long; none without a flap.
    [[nodiscard]] std::optional<QPointF> sideOf(std::size_t k) const {
        if (!picture_.plan || k >= picture_.plan->flaps.size() || picture_.plan->flaps[k].empty()) return std::nullopt;
        const BendLine& bend = picture_.device.bends[k];
        const glm::dvec2 along = bend.to - bend.from;
        double across = 0.0;
        for (const glm::dvec2& p : picture_.plan->flaps[k])
            across += along.x * (p.y - bend.from.y) - along.y * (p.x - bend.from.x);
        const double length = glm::length(along);
        if (length < 1e-9) return std::nullopt;
        const double sign = across < 0.0 ? -1.0 : 1.0;
        return QPointF(-sign * along.y / length, sign * along.x / length);
    }

    /// An arrow from the line's middle into its flap.
    void drawSide(std::size_t k, const QColor& color) {
        const auto side = sideOf(k);
        if (!side) return;
        const BendLine& bend = picture_.device.bends[k];
        const QPointF foot = picture_.view.pixel(0.5 * (bend.from + bend.to));
        const QPointF tip = foot + 18.0 * *side;
        const QPointF along(-side->y(), side->x());
        painter_.setPen(QPen(color, 2.0, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
        painter_.drawLine(foot, tip);
        painter_.setBrush(Qt::NoBrush);
        painter_.drawPolyline(QPolygonF({tip - 5.0 * *side + 4.0 * along, tip, tip - 5.0 * *side - 4.0 * along}));
    }

    void drawName(std::size_t k, const QColor& color) {
        const BendLine& bend = picture_.device.bends[k];
        const QString name = QString::fromStdString(bend.name);
        const QPointF middle = picture_.view.pixel(0.5 * (bend.from + bend.to));
        const QPointF way = sideOf(k).value_or(QPointF(0.0, -1.0));
        const QFontMetricsF metrics(painter_.font());
        QRectF box = metrics.boundingRect(name).adjusted(-5.0, -2.0, 5.0, 2.0);
        // In the flap, clear of the arrow's tip.
        const double away = 26.0 + 0.5 * (std::abs(way.x()) * box.width() + std::abs(way.y()) * box.height());
        box.moveCenter(middle + away * way);
        painter_.setPen(Qt::NoPen);
        QColor plate = colors_.panel;
        plate.setAlphaF(0.85);
        painter_.setBrush(plate);
        painter_.drawRoundedRect(box, 4.0, 4.0);
        painter_.setPen(isChosen(k) || refusalOf(k) != nullptr ? color : colors_.text);
        painter_.drawText(box, Qt::AlignCenter, name);
    }

    void drawBegun() {
        painter_.setBrush(Qt::NoBrush);
        painter_.setPen(QPen(colors_.accent, 2.0));
        if (picture_.lineBegun) {
            painter_.drawLine(picture_.view.pixel(picture_.lineBegun->first),
                              picture_.view.pixel(picture_.lineBegun->second));
            drawEnd(picture_.lineBegun->first, colors_.accent, true);
            drawEnd(picture_.lineBegun->second, colors_.accent, true);
        }
        if (picture_.outlineBegun.empty()) return;
        const QPolygonF shape = polygon(picture_.outlineBegun);
        QColor fill = colors_.accent;
        fill.setAlphaF(0.14);
        painter_.setPen(Qt::NoPen);
        painter_.setBrush(fill);
        if (shape.size() > 2) painter_.drawPolygon(shape);
        painter_.setBrush(Qt::NoBrush);
        painter_.setPen(QPen(colors_.accent, 2.0));
        if (picture_.outlineCloses) {
            painter_.drawPolygon(shape);
            return;
        }
        painter_.drawPolyline(shape);
        for (std::size_t k = 0; k < picture_.outlineBegun.size(); ++k)
            drawHandle(picture_.outlineBegun[k], colors_.accent, k == 0, false);
    }

    void drawPointer() {
        if (!picture_.pointer) return;
        const QPointF at = picture_.view.pixel(picture_.pointer->point);
        painter_.setPen(QPen(colors_.accent, 1.5));
        painter_.setBrush(Qt::NoBrush);
        using To = SnappedPoint::To;
        if (picture_.pointer->to == To::grid || picture_.pointer->to == To::nothing) {
            painter_.drawLine(at - QPointF(5.0, 0.0), at + QPointF(5.0, 0.0));
            painter_.drawLine(at - QPointF(0.0, 5.0), at + QPointF(0.0, 5.0));
        } else {
            painter_.drawEllipse(at, 6.0, 6.0);
        }
    }

    void drawRulers() {
        const double ratio = page_.devicePixelRatio();
        const QRectF across(0.0, 0.0, picture_.area.width(), kRulerWidth + 1.0);
        const QRectF down(0.0, 0.0, kRulerWidth + 1.0, picture_.area.height());
        for (const QRectF& strip : {across, down})
            painter_.drawPixmap(strip, page_, QRectF(strip.topLeft() * ratio, strip.size() * ratio));
        if (!picture_.pointer) return;
        const QPointF at = picture_.view.pixel(picture_.pointer->point);
        painter_.setPen(QPen(colors_.accent, 2.0));
        painter_.drawLine(QPointF(at.x(), 0.0), QPointF(at.x(), kRulerWidth));
        painter_.drawLine(QPointF(0.0, at.y()), QPointF(kRulerWidth, at.y()));
    }

    void drawReadout() {
        if (picture_.readout.isEmpty() || !picture_.pointer) return;
        const QFontMetricsF metrics(painter_.font());
        QRectF box = metrics.boundingRect(picture_.readout).adjusted(-8.0, -4.0, 8.0, 4.0);
        box.moveTopLeft(picture_.view.pixel(picture_.pointer->point) + QPointF(16.0, 16.0));
        const QRectF area = QRectF(picture_.area).adjusted(4.0, 4.0, -4.0, -4.0);
        if (box.right() > area.right()) box.moveRight(area.right());
        if (box.bottom() > area.bottom()) box.moveBottom(area.bottom());
        painter_.setPen(QPen(colors_.border, 1.0));
        painter_.setBrush(colors_.raised);
        painter_.drawRoundedRect(box, 4.0, 4.0);
        painter_.setPen(colors_.text);
        painter_.drawText(box, Qt::AlignCenter, picture_.readout);
    }

    QPainter& painter_;
    const SheetPage& picture_;
    const QPixmap& page_;
    const Palette& colors_ = currentPalette();
};

} // namespace

QColor flapColor(std::size_t actuator) {
    constexpr double kGoldenShare = 0.618033988749895; // of the circle of hues: neighbours are always far apart
    const double hue = 0.47 + kGoldenShare * static_cast<double>(actuator);
    return QColor::fromHslF(static_cast<float>(hue - std::floor(hue)), 0.6F,
                            currentTheme() == Theme::dark ? 0.62F : 0.40F);
}

double gridSpacing(const PageView& view) {
    const double least = kFinest / view.scale;
    double spacing = std::pow(10.0, std::floor(std::log10(least)));
    for (const double step : {2.0, 5.0, 10.0})
        if (spacing < least) spacing = step * std::pow(10.0, std::floor(std::log10(least)));
    return std::max(spacing, 0.001);
}

void paintPage(QPainter& painter, const PageView& view, const QRect& area) { PagePainter(painter, view, area).paint(); }

void paintSheet(QPainter& painter, const SheetPage& picture, const QPixmap& page) {
    SheetPainter(painter, picture, page).paint();
}

} // namespace lumorph::studio
