#include "app/workspaces/field/story_painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include <QPainterPath>

#include "app/workspaces/field/vote_table.h"
#include "core/geometry/plane_section.h"
#include "core/mdf/field_view.h"

namespace lumorph::studio {

namespace {

constexpr double kStoryGap = 12.0;    ///< between parts, of a usual window's pixels
constexpr double kLine = 18.0;        ///< height of a line of text there
constexpr double kStatesShare = 0.22; ///< of the height, for the states one by one
constexpr double kChartsShare = 0.40; ///< for the vote charts
constexpr double kLevelsShare = 0.19; ///< for the levels of both ways
constexpr int kStatesShown = 5;
constexpr double kGridFrom = 5.0; ///< pixels a voxel, from which gaps between voxels are drawn

QColor levelColorOf(const Palette& colors, int level, int levels) {
    return blend(colors.levelLow, colors.levelHigh, levels > 1 ? static_cast<double>(level) / (levels - 1) : 0.0);
}

QColor bodyColor(const Palette& colors) { return blend(colors.sunken, colors.textMuted, 0.45); }

QFont fontOf(const QPainter& painter, double pixels, bool bold = false) {
    QFont font = painter.font();
    font.setPixelSize(std::max(8, static_cast<int>(std::lround(pixels))));
    font.setBold(bold);
    return font;
}

const glm::ivec3& dimensionsOf(const StoryPicture& picture) { return picture.story->field->field.frame.dimensions; }

/// The largest whole number of pixels a voxel (halves below two) at which the plane fits.
double voxelFor(const glm::ivec2& extent, const QSizeF& room) {
    const double most = std::min(room.width() / extent.x, room.height() / extent.y);
    return most >= 2.0 ? std::floor(most) : most;
}

QRectF planeIn(const glm::ivec2& extent, double voxel, const QRectF& room) {
    const QSizeF size(voxel * extent.x, voxel * extent.y);
    const QPointF corner(room.center().x() - size.width() / 2.0, room.center().y() - size.height() / 2.0);
    return {QPointF(std::round(corner.x()), std::round(corner.y())), size};
}

/// Cells of nearly this shape side by side in a box.
std::vector<QRectF> cellsIn(const QRectF& box, std::size_t count, double ratio, double gap) {
    std::vector<QRectF> cells;
    if (count == 0) return cells;
    std::size_t columns = 1;
    double best = 0.0;
    for (std::size_t c = 1; c <= count; ++c) {
        const std::size_t rows = (count + c - 1) / c;
        const double width = (box.width() + gap) / static_cast<double>(c) - gap;
        const double height = (box.height() + gap) / static_cast<double>(rows) - gap;
        const double fit = std::min(width, height * ratio);
        if (fit > best) {
            best = fit;
            columns = c;
        }
    }
    const std::size_t rows = (count + columns - 1) / columns;
    const QSizeF size((box.width() + gap) / static_cast<double>(columns) - gap,
                      (box.height() + gap) / static_cast<double>(rows) - gap);
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t row = k / columns;
        const std::size_t column = k % columns;
        cells.emplace_back(QPointF(box.left() + static_cast<double>(column) * (size.width() + gap),
                                   box.top() + static_cast<double>(row) * (size.height() + gap)),
                           size);
    }
    return cells;
}

/// Paints one picture; lives as long as that takes.
class SectionPainter {
public:
    SectionPainter(QPainter& painter, const StoryPicture& picture, const QRectF& area, double unit,
                   const Palette& colors)
        : painter_(painter), picture_(picture), story_(*picture.story), view_(picture.view),
          field_(picture.story->field->field), unit_(unit), colors_(colors), layout_(layoutOf(picture, area, unit)) {}

    void paint() {
        painter_.save();
        switch (view_.step) {
        case StoryStep::states:
            return end(&SectionPainter::paintStates);
        case StoryStep::field:
            return end(&SectionPainter::paintField);
        case StoryStep::all:
            return end(&SectionPainter::paintAll);
        case StoryStep::target:
            return end(&SectionPainter::paintTarget);
        case StoryStep::votes:
            return end(&SectionPainter::paintVotes);
        case StoryStep::fit:
            return end(&SectionPainter::paintFit);
        }
    }

private:
    /// Colour of a voxel; invalid leaves it empty.
    using CellColor = std::function<QColor(const glm::ivec3&)>;
    struct Entry {
        QColor color;
        QString text;
        bool line = false;
    };

    void end(void (SectionPainter::*part)()) {
        if (canBeTold(picture_)) (this->*part)();
        painter_.restore();
    }

    void paintStates() {
        paintState(layout_.section, view_.level, true);
        for (std::size_t k = 0; k < layout_.states.size(); ++k) {
            const QRectF& cell = layout_.states[k];
            const int level = layout_.stateLevels[k];
            const QRectF plane = planeIn(extent(), voxelFor(extent(), {cell.width(), cell.height() - kLine * unit_}),
                                         cell.adjusted(0, 0, 0, -kLine * unit_));
            paintState(plane, level, false);
            painter_.setFont(fontOf(painter_, 12.0 * unit_));
            painter_.setPen(level == nearestState() ? colors_.text : colors_.textMuted);
            painter_.drawText(QRectF(cell.left(), cell.bottom() - kLine * unit_, cell.width(), kLine * unit_),
                              Qt::AlignCenter, QObject::tr("level %1").arg(level));
        }
        paintLegend({{bodyColor(colors_), QObject::tr("device at rest"), false},
                     {levelColorOf(colors_, view_.level, field_.levels),
                      QObject::tr("covered at level %1").arg(view_.level), false},
                     {colors_.text, QObject::tr("its true outline"), true}});
    }

    [[nodiscard]] int nearestState() const {
        return *std::ranges::min_element(layout_.stateLevels, {}, [&](int l) { return std::abs(l - view_.level); });
    }

    void paintState(const QRectF& plane, int level, bool large) {
        const State state = stateOf(story_, view_.actuator, level);
        const BitColumns covered = coveredBy(story_, state);
        const QColor color = levelColorOf(colors_, level, field_.levels);
        paintCells(plane, [&](const glm::ivec3& v) {
            if (inBody(v)) return bodyColor(colors_);
            return covered.test(v.x, v.y, v.z) ? color : QColor();
        });
        paintOutline(plane, positionsAt(story_, state), story_.rig->restMesh().triangles, colors_.text,
                     large ? 1.8 : 1.2);
    }

    void paintField() {
        const std::vector<std::uint8_t> levels = firstLevels(field_, view_.actuator);
        paintCells(layout_.section, [&](const glm::ivec3& v) {
            const int level = levels[field_.voxelIndex(v.x, v.y, v.z)];
            if (inBody(v)) return bodyColor(colors_);
            return level <= view_.level ? levelColorOf(colors_, level, field_.levels) : QColor();
        });
        paintOutline(layout_.section, positionsAt(story_, stateOf(story_, view_.actuator, view_.level)),
                     story_.rig->restMesh().triangles, colors_.text, 1.8);
        paintLegend({{bodyColor(colors_), QObject::tr("device at rest"), false},
                     {colors_.text, QObject::tr("device at level %1").arg(view_.level), true}},
                    true);
    }

    void paintAll() {
        const std::vector<std::uint8_t> levels = firstLevels(field_, std::nullopt);
        paintCells(layout_.section, [&](const glm::ivec3& v) {
            if (inBody(v)) return bodyColor(colors_);
            if (picture_.reach && picture_.reach->together.test(v.x, v.y, v.z)) return colors_.overfilled;
            const int level = levels[field_.voxelIndex(v.x, v.y, v.z)];
            return level != kUnchanged ? levelColorOf(colors_, level, field_.levels) : QColor();
        });
        paintOutline(layout_.section, story_.rig->restMesh().positions, story_.rig->restMesh().triangles, colors_.text,
                     1.8);
        std::vector<Entry> entries{{bodyColor(colors_), QObject::tr("device at rest"), false}};
        if (picture_.reach && !picture_.reach->pairs.empty())
            entries.push_back({colors_.overfilled, QObject::tr("only two together"), false});
        paintLegend(entries, true);
    }

    void paintTarget() {
        paintCells(layout_.section, [&](const glm::ivec3& v) {
            if (inBody(v)) return bodyColor(colors_);
            const bool reached = story_.reachable.test(v.x, v.y, v.z);
            if (wanted(v)) return reached ? colors_.accent : colors_.unmatched;
            return reached ? blend(colors_.sunken, colors_.levelHigh, 0.5) : QColor();
        });
        paintTargetOutline(layout_.section);
        std::vector<Entry> entries{{colors_.accent, QObject::tr("voxels of the target"), false}};
        if (story_.unreachable > 0) entries.push_back({colors_.unmatched, QObject::tr("out of reach"), false});
        entries.push_back({blend(colors_.sunken, colors_.levelHigh, 0.5), QObject::tr("the field"), false});
        entries.push_back({bodyColor(colors_), QObject::tr("device at rest"), false});
        entries.push_back({colors_.text, QObject::tr("its true outline"), true});
        paintLegend(entries);
    }

    void paintVotes() {
        const std::vector<std::uint8_t> levels = firstLevels(field_, view_.actuator);
        paintCells(layout_.section, [&](const glm::ivec3& v) {
            if (inBody(v)) return bodyColor(colors_);
            const int level = levels[field_.voxelIndex(v.x, v.y, v.z)];
            if (!wanted(v)) return level != kUnchanged ? blend(colors_.sunken, colors_.levelHigh, 0.4) : QColor();
            return level != kUnchanged ? levelColorOf(colors_, level, field_.levels)
                                       : blend(colors_.sunken, colors_.accent, 0.40);
        });
        paintTargetOutline(layout_.section);
        for (std::size_t a = 0; a < layout_.charts.size(); ++a) paintVote(layout_.charts[a], a);
        paintLegend({{blend(colors_.sunken, colors_.accent, 0.40), QObject::tr("rest of the target"), false},
                     {colors_.warning, QObject::tr("error by Eq. 1"), true},
                     {colors_.accent, QObject::tr("level voted"), true}},
                    true);
    }

    /// Bars: how many voxels speak for each level. Line: the error of Eq. 1. Mark: the level with the least.
    void paintVote(const QRectF& cell, std::size_t actuator) {
        const ActuatorVote& vote = story_.match->votes.actuators[actuator];
        const QRectF plot = paintChart(
            cell, actuator, vote.reached ? QObject::tr("level %1").arg(vote.level.index) : QObject::tr("rests"));
        const std::vector<std::size_t> counts = candidateCounts(field_, actuator, story_.match->target);
        const auto most = static_cast<double>(std::max<std::size_t>(1, *std::ranges::max_element(counts)));
        const double width = plot.width() / static_cast<double>(counts.size());
        painter_.setPen(Qt::NoPen);
        for (std::size_t level = 0; level < counts.size(); ++level) {
            const double height = plot.height() * static_cast<double>(counts[level]) / most;
            painter_.setBrush(levelColorOf(colors_, static_cast<int>(level), field_.levels));
            painter_.drawRect(QRectF(plot.left() + width * static_cast<double>(level), plot.bottom() - height,
                                     std::max(1.0, width - 1.0), height));
        }
        painter_.setBrush(Qt::NoBrush);
        painter_.setRenderHint(QPainter::Antialiasing);
        if (!vote.reached) return;
        const double x = plot.left() + width * (vote.level.index + 0.5);
        painter_.setPen(QPen(colors_.accent, 2.0 * unit_));
        painter_.drawLine(QPointF(x, plot.top()), QPointF(x, plot.bottom()));
        paintErrors(plot, errorCurve(vote));
    }

    void paintErrors(const QRectF& plot, const std::vector<double>& curve) {
        double low = INFINITY, high = -INFINITY;
        for (const double error : curve)
            if (std::isfinite(error)) {
                low = std::min(low, error);
                high = std::max(high, error);
            }
        QPolygonF run;
        painter_.setPen(QPen(colors_.warning, 1.6 * unit_));
        for (std::size_t level = 0; level <= curve.size(); ++level) {
            if (level < curve.size() && std::isfinite(curve[level])) {
                const double share = high > low ? (curve[level] - low) / (high - low) : 0.5;
                run << QPointF(plot.left() + plot.width() * (static_cast<double>(level) + 0.5) /
                                                 static_cast<double>(curve.size()),
                               plot.bottom() - (0.08 + 0.84 * share) * plot.height());
            } else {
                painter_.drawPolyline(std::exchange(run, {}));
            }
        }
    }

    void paintFit() {
        paintFitOf(layout_.section, story_.match->voting, QObject::tr("Voting"), colors_.warning);
        paintFitOf(layout_.second, story_.match->refined, QObject::tr("Refined"), colors_.accent);
        for (std::size_t a = 0; a < layout_.charts.size(); ++a) paintLevels(layout_.charts[a], a);
        paintLegend({{colors_.success, QObject::tr("target and device"), false},
                     {colors_.unmatched, QObject::tr("left out"), false},
                     {colors_.overfilled, QObject::tr("too much"), false},
                     {bodyColor(colors_), QObject::tr("device at rest"), false},
                     {colors_.text, QObject::tr("device"), true},
                     {colors_.accentText, QObject::tr("target"), true}});
    }

    void paintFitOf(const QRectF& plane, const StoryMatch::Fit& fit, const QString& name, const QColor& mark) {
        paintCells(plane, [&](const glm::ivec3& v) {
            if (inBody(v)) return bodyColor(colors_);
            const bool covered = fit.covered.test(v.x, v.y, v.z);
            if (covered && wanted(v)) return colors_.success;
            if (covered) return colors_.overfilled;
            return wanted(v) ? colors_.unmatched : QColor();
        });
        paintTargetOutline(plane, colors_.accentText);
        paintOutline(plane, positionsAt(story_, fit.state), story_.rig->restMesh().triangles, colors_.text, 1.8);
        // The mark's colour is that of its levels below.
        const QRectF line(plane.left(), plane.top() - 1.4 * kLine * unit_, plane.width(), 1.4 * kLine * unit_);
        const double side = 11.0 * unit_;
        painter_.fillRect(QRectF(line.left(), line.center().y() - side / 2.0, side, side), mark);
        painter_.setFont(fontOf(painter_, 14.0 * unit_, true));
        painter_.setPen(colors_.text);
        painter_.drawText(line.adjusted(side + 6.0 * unit_, 0, 0, 0), Qt::AlignLeft | Qt::AlignVCenter,
                          QObject::tr("%1: IoU %2 %").arg(name).arg(100.0 * fit.quality.iou(), 0, 'f', 1));
    }

    /// Level of both ways, one above the other.
    void paintLevels(const QRectF& cell, std::size_t actuator) {
        const int voted = story_.match->voting.state[actuator].index;
        const int refined = story_.match->refined.state[actuator].index;
        const QRectF plot =
            paintChart(cell, actuator,
                       voted == refined ? QString::number(refined) : QObject::tr("%1 → %2").arg(voted).arg(refined));
        painter_.setPen(Qt::NoPen);
        const double height = std::min(8.0 * unit_, 0.4 * plot.height());
        const std::array<std::pair<int, QColor>, 2> bars{std::pair{voted, colors_.warning},
                                                         std::pair{refined, colors_.accent}};
        double top = plot.top();
        for (const auto& [level, color] : bars) {
            painter_.fillRect(QRectF(plot.left(), top, plot.width(), height), blend(colors_.sunken, colors_.line, 0.8));
            painter_.fillRect(QRectF(plot.left(), top, plot.width() * level / (field_.levels - 1), height), color);
            top += height + 2.0 * unit_;
        }
    }

    /// Name at the left, a word at the right, the chosen actuator framed; gives what is left for the plot.
    QRectF paintChart(const QRectF& cell, std::size_t actuator, const QString& word) {
        const bool chosen = actuator == view_.actuator && view_.step == StoryStep::votes;
        painter_.setRenderHint(QPainter::Antialiasing);
        painter_.setPen(QPen(chosen ? colors_.accent : colors_.line, chosen ? 2.0 * unit_ : unit_));
        painter_.setBrush(colors_.sunken);
        painter_.drawRoundedRect(cell.adjusted(0.5, 0.5, -0.5, -0.5), 4.0 * unit_, 4.0 * unit_);
        painter_.setRenderHint(QPainter::Antialiasing, false);
        const QRectF inner = cell.adjusted(6 * unit_, 2 * unit_, -6 * unit_, -5 * unit_);
        const QRectF line(inner.left(), inner.top(), inner.width(), kLine * unit_);
        painter_.setFont(fontOf(painter_, 12.0 * unit_));
        const QFontMetricsF metrics(painter_.font());
        const double wide = metrics.horizontalAdvance(word) + 4.0 * unit_;
        painter_.setPen(colors_.text);
        painter_.drawText(line, Qt::AlignRight | Qt::AlignVCenter, word);
        painter_.setPen(colors_.textMuted);
        painter_.drawText(line, Qt::AlignLeft | Qt::AlignVCenter,
                          metrics.elidedText(QString::fromStdString(field_.actuators[actuator].name), Qt::ElideRight,
                                             std::max(0.0, line.width() - wide)));
        return inner.adjusted(0, kLine * unit_ + 2.0 * unit_, 0, 0);
    }

    void paintCells(const QRectF& plane, const CellColor& colorOf) {
        const glm::ivec2 size = extent();
        QImage image(size.x, size.y, QImage::Format_ARGB32_Premultiplied);
        image.fill(Qt::transparent);
        for (int up = 0; up < size.y; ++up)
            for (int across = 0; across < size.x; ++across) {
                const QColor color = colorOf(voxelOf(view_.plane, dimensionsOf(picture_), {across, up}));
                if (color.isValid()) image.setPixelColor(across, size.y - 1 - up, color);
            }
        painter_.setRenderHint(QPainter::SmoothPixmapTransform, false);
        painter_.setRenderHint(QPainter::Antialiasing, false);
        painter_.fillRect(plane, colors_.sunken);
        painter_.drawImage(plane, image);
        const double voxel = plane.width() / size.x;
        if (voxel >= kGridFrom * std::min(unit_, 1.0)) paintGrid(plane, voxel);
        painter_.setPen(QPen(colors_.line, 1));
        painter_.setBrush(Qt::NoBrush);
        painter_.drawRect(plane.adjusted(-1, -1, 0, 0));
    }

    /// Gaps, so that every voxel is seen for itself.
    void paintGrid(const QRectF& plane, double voxel) {
        const double gap = std::max(1.0, std::floor(voxel / 12.0));
        const glm::ivec2 size = extent();
        for (int x = 0; x < size.x; ++x)
            painter_.fillRect(QRectF(plane.left() + voxel * x, plane.top(), gap, plane.height()), colors_.sunken);
        for (int y = 0; y < size.y; ++y)
            painter_.fillRect(QRectF(plane.left(), plane.top() + voxel * y, plane.width(), gap), colors_.sunken);
    }

    void paintTargetOutline(const QRectF& plane, std::optional<QColor> color = std::nullopt) {
        std::vector<glm::vec3> standing;
        placePoints(*story_.targetPositions, story_.deviceFromTarget, standing);
        paintOutline(plane, standing, story_.target->solid.mesh.triangles, color.value_or(colors_.text), 1.8);
    }

    /// Where a surface goes through the middle of the plane.
    void paintOutline(const QRectF& plane, std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                      const QColor& color, double width) {
        const VoxelFrame& frame = field_.frame;
        const double voxel = plane.width() / extent().x;
        const auto pixel = [&](const glm::vec3& point) {
            const glm::dvec2 place = placeIn(view_.plane, frame, glm::dvec3(point));
            return QPointF(plane.left() + voxel * place.x, plane.bottom() - voxel * place.y);
        };
        QPainterPath path;
        const auto middle = static_cast<float>(middleOf(view_.plane, frame));
        for (const auto& [from, to] : planeSection(positions, triangles, view_.plane.axis, middle)) {
            path.moveTo(pixel(from));
            path.lineTo(pixel(to));
        }
        painter_.save();
        painter_.setClipRect(plane.adjusted(-2, -2, 2, 2));
        painter_.setRenderHint(QPainter::Antialiasing);
        painter_.setBrush(Qt::NoBrush);
        painter_.setPen(QPen(colors_.sunken, (width + 1.8) * unit_, Qt::SolidLine, Qt::RoundCap));
        painter_.drawPath(path);
        painter_.setPen(QPen(color, width * unit_, Qt::SolidLine, Qt::RoundCap));
        painter_.drawPath(path);
        painter_.restore();
    }

    void paintLegend(const std::vector<Entry>& entries, bool levels = false) {
        painter_.setFont(fontOf(painter_, 13.0 * unit_));
        painter_.setRenderHint(QPainter::Antialiasing);
        const QFontMetricsF metrics(painter_.font());
        const double side = 11.0 * unit_;
        const double middle = layout_.legend.center().y();
        double x = layout_.legend.left();
        const auto text = [&](const QString& words, const QColor& color) {
            const double wide = metrics.horizontalAdvance(words) + 2.0;
            painter_.setPen(color);
            painter_.drawText(QRectF(x, layout_.legend.top(), wide, layout_.legend.height()),
                              Qt::AlignLeft | Qt::AlignVCenter, words);
            x += wide + 6.0 * unit_;
        };
        if (levels) {
            text(QObject::tr("level 0"), colors_.textMuted);
            const QRectF bar(x, middle - side / 2.0, 120.0 * unit_, side);
            QLinearGradient gradient(bar.topLeft(), bar.topRight());
            gradient.setColorAt(0.0, colors_.levelLow);
            gradient.setColorAt(1.0, colors_.levelHigh);
            painter_.fillRect(bar, gradient);
            x = bar.right() + 6.0 * unit_;
            text(QString::number(field_.levels - 1), colors_.textMuted);
            x += kStoryGap * unit_;
        }
        for (const Entry& entry : entries) {
            if (entry.line) {
                painter_.setPen(QPen(entry.color, 2.0 * unit_));
                painter_.drawLine(QPointF(x, middle), QPointF(x + 1.4 * side, middle));
                x += 1.4 * side + 6.0 * unit_;
            } else {
                painter_.fillRect(QRectF(x, middle - side / 2.0, side, side), entry.color);
                x += side + 6.0 * unit_;
            }
            text(entry.text, colors_.text);
            x += kStoryGap * unit_;
        }
    }

    [[nodiscard]] bool inBody(const glm::ivec3& v) const { return field_.body.test(v.x, v.y, v.z); }
    [[nodiscard]] bool wanted(const glm::ivec3& v) const { return story_.match->target.test(v.x, v.y, v.z); }
    [[nodiscard]] glm::ivec2 extent() const { return sizeOf(view_.plane, dimensionsOf(picture_)); }

    QPainter& painter_;
    const StoryPicture& picture_;
    const Story& story_;
    const StoryView& view_;
    const Field& field_;
    double unit_;
    const Palette& colors_;
    StoryLayout layout_;
};

/// Two planes as large as they can be, beside or below each other, with a line of words above each.
void layFit(StoryLayout& layout, const glm::ivec2& extent, const QRectF& room, double unit) {
    const double words = 1.4 * kLine * unit;
    const QSizeF beside((room.width() - kStoryGap * unit) / 2.0, room.height() - words);
    const QSizeF below(room.width(), (room.height() - kStoryGap * unit) / 2.0 - words);
    const bool isBeside = voxelFor(extent, beside) >= voxelFor(extent, below);
    const QSizeF size = isBeside ? beside : below;
    layout.voxel = voxelFor(extent, size);
    QRectF first(room.topLeft() + QPointF(0, words), size);
    layout.section = planeIn(extent, layout.voxel, first);
    first.translate(isBeside ? size.width() + kStoryGap * unit : 0.0,
                    isBeside ? 0.0 : size.height() + words + kStoryGap * unit);
    layout.second = planeIn(extent, layout.voxel, first);
}

} // namespace

StoryLayout layoutOf(const StoryPicture& picture, const QRectF& area, double unit) {
    StoryLayout layout;
    const glm::ivec2 extent = sizeOf(picture.view.plane, dimensionsOf(picture));
    const StoryStep step = picture.view.step;
    const double gap = kStoryGap * unit;
    QRectF room = area;
    layout.legend = QRectF(room.left(), room.bottom() - 1.3 * kLine * unit, room.width(), 1.3 * kLine * unit);
    room.setBottom(layout.legend.top() - gap);
    const double share = step == StoryStep::states  ? kStatesShare
                         : step == StoryStep::votes ? kChartsShare
                         : step == StoryStep::fit   ? kLevelsShare
                                                    : 0.0;
    if (share > 0.0) {
        const QRectF strip(room.left(), room.bottom() - share * room.height(), room.width(), share * room.height());
        room.setBottom(strip.top() - gap);
        if (step == StoryStep::states) {
            const int last = picture.story->field->field.levels - 1;
            for (int k = 0; k < kStatesShown; ++k) {
                const int level = static_cast<int>(std::lround(static_cast<double>(last) * k / (kStatesShown - 1)));
                if (layout.stateLevels.empty() || layout.stateLevels.back() != level)
                    layout.stateLevels.push_back(level);
            }
            const auto count = static_cast<double>(layout.stateLevels.size());
            const double width = (strip.width() + gap) / count - gap;
            for (std::size_t k = 0; k < layout.stateLevels.size(); ++k)
                layout.states.emplace_back(strip.left() + static_cast<double>(k) * (width + gap), strip.top(), width,
                                           strip.height());
        } else {
            layout.charts =
                cellsIn(strip, picture.story->rig->actuatorCount(), step == StoryStep::fit ? 3.5 : 2.2, 0.5 * gap);
        }
    }
    if (step == StoryStep::fit) {
        layFit(layout, extent, room, unit);
        return layout;
    }
    layout.voxel = voxelFor(extent, room.size());
    layout.section = planeIn(extent, layout.voxel, room);
    return layout;
}

void paintSection(QPainter& painter, const StoryPicture& picture, const QRectF& area, double unit,
                  const Palette& colors) {
    SectionPainter(painter, picture, area, unit, colors).paint();
}

namespace {

/// What one pixel of a usual window is on a page of this size.
double unitOf(const QSize& size) { return std::max(0.4, std::min(size.width() / 1280.0, size.height() / 720.0)); }

} // namespace

QRect viewOnPage(const QSize& size) {
    const double unit = unitOf(size);
    const auto top = static_cast<int>(110.0 * unit), margin = static_cast<int>(24.0 * unit);
    const int left = static_cast<int>(size.width() * 0.62);
    return {left, top, size.width() - left - margin, size.height() - top - margin};
}

void paintPage(QPainter& painter, const StoryPicture& picture, const QImage& view, const QSize& size,
               const Palette& colors) {
    const double unit = unitOf(size);
    const double margin = 24.0 * unit;
    const QRect beside = viewOnPage(size);
    painter.fillRect(QRect(QPoint(0, 0), size), colors.panel);
    const StoryWords words = wordsOf(picture);
    painter.setPen(colors.text);
    painter.setFont(fontOf(painter, 26.0 * unit, true));
    painter.drawText(QRectF(margin, 14.0 * unit, size.width() - 2.0 * margin, 38.0 * unit),
                     Qt::AlignLeft | Qt::AlignVCenter,
                     QObject::tr("%1  %2").arg(static_cast<int>(picture.view.step) + 1).arg(words.title));
    painter.setFont(fontOf(painter, 15.0 * unit));
    painter.setPen(colors.textMuted);
    painter.drawText(QRectF(margin, 54.0 * unit, size.width() - 2.0 * margin, 48.0 * unit),
                     Qt::AlignLeft | Qt::AlignTop | Qt::TextWordWrap, words.text);
    if (!view.isNull()) {
        painter.setRenderHint(QPainter::SmoothPixmapTransform);
        painter.drawImage(beside, view);
    }
    paintSection(painter, picture, QRectF(margin, beside.top(), beside.left() - 2.0 * margin, beside.height()), unit,
                 colors);
}

QString voxelText(const StoryPicture& picture, const glm::ivec2& at) {
    const Story& story = *picture.story;
    const Field& field = story.field->field;
    const glm::ivec3 v = voxelOf(picture.view.plane, field.frame.dimensions, at);
    const QString name = QObject::tr("Voxel %1, %2, %3").arg(v.x).arg(v.y).arg(v.z);
    if (field.body.test(v.x, v.y, v.z)) return name + QObject::tr(": inside the device at rest");
    QStringList facts;
    for (std::size_t a = 0; a < field.actuators.size(); ++a) {
        const std::vector<std::uint8_t> levels = firstLevels(field, a);
        const int level = levels[field.voxelIndex(v.x, v.y, v.z)];
        if (level != kUnchanged)
            facts += QObject::tr("%1 from level %2").arg(QString::fromStdString(field.actuators[a].name)).arg(level);
    }
    if (facts.isEmpty()) facts += QObject::tr("no actuator reaches it");
    if (picture.reach && picture.reach->together.test(v.x, v.y, v.z))
        facts += QObject::tr("only two actuators together reach it");
    if (story.match && story.match->target.test(v.x, v.y, v.z)) facts += QObject::tr("part of the target");
    return name + "\n" + facts.join("\n");
}

} // namespace lumorph::studio
