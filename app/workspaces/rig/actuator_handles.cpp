#include "app/workspaces/rig/actuator_handles.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <QCoreApplication>
#include <QPainterPath>
#include <glm/geometric.hpp>

#include "app/studio/look/palette.h"
#include "app/studio/viewport/gizmo_shape.h"
#include "app/studio/viewport/view_marks.h"

namespace lumorph::studio {

namespace {

using Motion = ActuatorRange::Motion;

constexpr float kGrabReach = 11.0F; // pixels
constexpr double kLeastTurn = std::numbers::pi / 180.0;
constexpr double kLeastMove = 0.001; // metres, of a range
constexpr double kMostMove = 1.0;
constexpr double kLeastBend = 0.001; // metres of arc
constexpr float kLeastLine = 0.004;  // metres between the ends
// As near to where the device stands the pointer of the stroke is taken for that.
constexpr double kStrokeCatch = 0.02;
constexpr int kArcSteps = 64;

glm::vec2 toVec(const QPointF& at) { return {static_cast<float>(at.x()), static_cast<float>(at.y())}; }
QPointF toPoint(const glm::vec2& at) { return {static_cast<double>(at.x), static_cast<double>(at.y)}; }

double snapped(double value, double step, bool coarse) { return coarse ? step * std::round(value / step) : value; }

QString tr(const char* words) { return QCoreApplication::translate("ActuatorHandles", words); }

/// "45°", "12.5 mm" or "60 %": a value of a range.
QString valueText(const ActuatorRange& range, double value) {
    switch (range.motion) {
    case Motion::turning:
        return QString("%1°").arg(std::round(Angle::radians(value).inDegrees()) + 0.0);
    case Motion::moving:
        return QString("%1 mm").arg(1000.0 * value, 0, 'f', 1);
    default:
        return QString("%1 %").arg(std::round(100.0 * value));
    }
}

/// The direction in the sheet at whole steps of 15 degrees from the sheet's x (its z where it stands across x).
glm::vec3 squared(const glm::vec3& direction, const glm::vec3& normal) {
    const glm::vec3 n = glm::normalize(normal);
    const glm::vec3 along = std::abs(n.x) < 0.9F ? glm::vec3(1.0F, 0.0F, 0.0F) : glm::vec3(0.0F, 0.0F, 1.0F);
    const glm::vec3 u = glm::normalize(along - glm::dot(along, n) * n);
    const glm::vec3 v = glm::cross(n, u);
    const double angle = snapped(std::atan2(glm::dot(direction, v), glm::dot(direction, u)), kCoarseTurn, true);
    return static_cast<float>(std::cos(angle)) * u + static_cast<float>(std::sin(angle)) * v;
}

/// A direction at whole steps of 15 degrees about and above the table.
glm::vec3 squaredInRoom(const glm::vec3& direction) {
    const double up = snapped(std::asin(std::clamp(direction.y, -1.0F, 1.0F)), kCoarseTurn, true);
    const double around = snapped(std::atan2(direction.x, direction.z), kCoarseTurn, true);
    return {std::cos(up) * std::sin(around), std::sin(up), std::cos(up) * std::cos(around)};
}

ActuatorRange limited(ActuatorRange range, RigHandle handle, double value) {
    const bool turns = range.motion == Motion::turning;
    const double least = turns ? kLeastTurn : kLeastMove;
    const double most = turns ? 2.0 * std::numbers::pi : kMostMove;
    if (handle == RigHandle::to)
        range.max = std::clamp(value, range.min + least, range.min + most);
    else
        range.min = std::clamp(value, range.max - most, range.max - least);
    return range;
}

/// Paints a guide in the view; every line lies on a darker one, so that it is seen on any ground.
class GuidePainter {
public:
    GuidePainter(QPainter& painter, const ViewCamera& camera, const QSize& size)
        : painter_(painter), camera_(camera),
          size_(static_cast<float>(size.width()), static_cast<float>(size.height())), colors_(currentPalette()) {}

    void paint(const ActuatorGuide& guide, double stroke, std::optional<RigHandle> hot) {
        if (guide.range.motion == Motion::turning)
            paintArc(guide, stroke, hot);
        else
            paintWay(guide, hot);
        if (guide.hasLine) paintLine(guide);
        for (const SeenHandle& seen : seenHandles(guide, stroke, camera_, size_)) paintHandle(seen, seen.handle == hot);
    }

private:
    [[nodiscard]] std::optional<QPointF> at(const glm::vec3& place) const {
        const auto pixel = pixelOf(camera_, place, size_);
        return pixel ? std::optional(toPoint(*pixel)) : std::nullopt;
    }
    void stroke(const QPainterPath& path, const QColor& color, double width, Qt::PenStyle style = Qt::SolidLine) {
        QColor below = colors_.window;
        below.setAlpha(150);
        painter_.setBrush(Qt::NoBrush);
        painter_.setPen(QPen(below, width + 2.5, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
        painter_.drawPath(path);
        painter_.setPen(QPen(color, width, style, Qt::RoundCap, Qt::RoundJoin));
        painter_.drawPath(path);
    }
    void line(const glm::vec3& from, const glm::vec3& to, const QColor& color, double width,
              Qt::PenStyle style = Qt::SolidLine) {
        const auto a = at(from), b = at(to);
        if (!a || !b) return;
        QPainterPath path(*a);
        path.lineTo(*b);
        stroke(path, color, width, style);
    }
    void text(const QPointF& middle, const QString& words) {
        const QFontMetricsF metrics(painter_.font());
        QPainterPath path;
        path.addText(middle - QPointF(0.5 * metrics.horizontalAdvance(words), -0.35 * metrics.height()),
                     painter_.font(), words);
        painter_.setPen(QPen(colors_.window, 3.5, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
        painter_.drawPath(path);
        painter_.fillPath(path, colors_.text);
    }
    [[nodiscard]] QPainterPath arcPath(const ActuatorGuide& guide, float radius) const {
        QPainterPath path;
        for (int i = 0; i <= kArcSteps; ++i) {
            const double value = std::lerp(guide.range.min, guide.range.max, static_cast<double>(i) / kArcSteps);
            const auto p = at(placeOf(guide, value, radius));
            if (!p) continue;
            path.elementCount() == 0 ? path.moveTo(*p) : path.lineTo(*p);
        }
        return path;
    }
    void paintArc(const ActuatorGuide& guide, double stroke01, std::optional<RigHandle> hot) {
        const float radius = arcRadius(guide, camera_, size_);
        const auto pivot = at(guide.pivot);
        const QPainterPath arc = arcPath(guide, radius);
        if (!pivot || arc.elementCount() < 2) return;
        QPainterPath wedge = arc;
        wedge.lineTo(*pivot);
        wedge.closeSubpath();
        QColor shade = colors_.accent;
        shade.setAlpha(30);
        painter_.fillPath(wedge, shade);
        for (const double end : {guide.range.min, guide.range.max})
            line(guide.pivot, placeOf(guide, end, radius), colors_.textMuted, 1.0, Qt::DotLine);
        stroke(arc, colors_.text, 2.0);
        const double value = std::lerp(guide.range.min, guide.range.max, stroke01);
        const float inside = radius - 18.0F * metresPerPixel(camera_, guide.pivot, size_);
        line(guide.pivot, placeOf(guide, value, inside), colors_.accent, hot == RigHandle::stroke ? 3.0 : 2.0);
        const float outside = radius + 22.0F * metresPerPixel(camera_, guide.pivot, size_);
        paintLimits(guide, outside);
    }
    void paintLimits(const ActuatorGuide& guide, float radius) {
        for (const double end : {guide.range.min, guide.range.max})
            if (const auto p = at(placeOf(guide, end, radius))) text(*p, valueText(guide.range, end));
    }
    void paintWay(const ActuatorGuide& guide, std::optional<RigHandle> hot) {
        const glm::vec3 from = placeOf(guide, guide.range.min, 0.0F), to = placeOf(guide, guide.range.max, 0.0F);
        line(from, to, colors_.text, 2.0);
        if (guide.hasWay)
            line(to, to + kDirectionAhead * metresPerPixel(camera_, to, size_) * guide.axis,
                 hot == RigHandle::direction ? colors_.accent : kLineColor, 2.0, Qt::DashLine);
        const auto a = at(from), b = at(to);
        if (!a || !b) return;
        const QLineF way(*a, *b);
        const QPointF beside = way.length() > 1.0 ? QPointF(-way.dy(), way.dx()) / way.length() : QPointF(1.0, 0.0);
        text(*a + 34.0 * beside, valueText(guide.range, guide.range.min));
        text(*b + 34.0 * beside, valueText(guide.range, guide.range.max));
    }
    void paintLine(const ActuatorGuide& guide) {
        const auto ends = endsOf(guide);
        line(ends[0], ends[1], kLineColor, 2.5);
        if (!guide.bendLength) return;
        const glm::vec3 by = static_cast<float>(*guide.bendLength) * guide.arm;
        line(ends[0] + by, ends[1] + by, kLineColor, 1.5, Qt::DashLine);
    }
    void paintHandle(const SeenHandle& seen, bool hot) {
        const bool ofRange = seen.handle == RigHandle::from || seen.handle == RigHandle::to;
        const bool pointer = seen.handle == RigHandle::stroke;
        const QColor color = pointer ? colors_.accent : ofRange ? colors_.text : kLineColor;
        const double radius = (pointer ? 7.0 : 5.5) + (hot ? 1.5 : 0.0);
        painter_.setPen(QPen(pointer ? colors_.onAccent : color, 2.0));
        painter_.setBrush(hot || pointer ? color : colors_.window);
        painter_.drawEllipse(toPoint(seen.pixel), radius, radius);
    }

    static inline const QColor kLineColor{240, 199, 89};
    QPainter& painter_;
    const ViewCamera& camera_;
    glm::vec2 size_;
    const Palette& colors_;
};

} // namespace

ActuatorHandles::ActuatorHandles(StudioDocument& document, RigSelection& selection, std::function<ViewCamera()> camera)
    : document_(document), selection_(selection), camera_(std::move(camera)), preview_(document) {}

void ActuatorHandles::follow(std::optional<std::size_t> actuator, std::span<const std::uint32_t> vertices) {
    if (grip_ && actuator == actuator_) return; // the drag leads
    if (grip_) cancel();
    const auto& parts = document_.state().rig.parts;
    actuator_ = actuator;
    guide_ = parts && actuator ? guideOf(*parts, *actuator, vertices) : std::nullopt;
    if (!guide_) hot_.reset();
}

void ActuatorHandles::setStrokes(const std::vector<double>& shown, const std::vector<double>& device) {
    shown_ = shown;
    device_ = device;
}

double ActuatorHandles::stroke() const { return actuator_ && *actuator_ < shown_.size() ? shown_[*actuator_] : 0.0; }

void ActuatorHandles::paint(QPainter& painter, const QSize& size) {
    if (legend_) paintHeatLegend(painter, size, *legend_);
    if (!guide_) return;
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    const ViewCamera camera = camera_();
    GuidePainter(painter, camera, size).paint(*guide_, stroke(), grip_ ? grip_->handle : hot_);
    painter.restore();
    if (grip_ && !grip_->label.isEmpty()) paintChip(painter, size, grip_->pointer, grip_->label, currentPalette());
}

bool ActuatorHandles::hover(const QPointF& at, const QSize& size) {
    if (grip_) return false;
    std::optional<RigHandle> found;
    float least = kGrabReach;
    if (guide_)
        for (const SeenHandle& seen :
             seenHandles(*guide_, stroke(), camera_(), toVec({double(size.width()), double(size.height())})))
            if (const float far = glm::distance(seen.pixel, toVec(at)); far < least) least = far, found = seen.handle;
    return std::exchange(hot_, found) != found;
}

bool ActuatorHandles::press(const QPointF& at, const QSize& size, Qt::KeyboardModifiers /*modifiers*/) {
    hover(at, size);
    if (!hot_ || document_.previewing()) return false;
    const ActuatorRange& range = guide_->range;
    const glm::vec2 pixels(static_cast<float>(size.width()), static_cast<float>(size.height()));
    grip_ = Grip{*hot_, *guide_, selection_.rehearsed(), 0.0, glm::vec2(0.0F), at, {}};
    for (const SeenHandle& seen : seenHandles(*guide_, stroke(), camera_(), pixels))
        if (seen.handle == *hot_) grip_->offset = seen.pixel - toVec(at);
    grip_->value = *hot_ == RigHandle::to     ? range.max
                   : *hot_ == RigHandle::from ? range.min
                                              : std::lerp(range.min, range.max, stroke());
    return true;
}

void ActuatorHandles::drag(const QPointF& to, const QSize& size, Qt::KeyboardModifiers modifiers) {
    if (!grip_ || !actuator_) return;
    const bool coarse = modifiers.testFlag(Qt::ControlModifier);
    const glm::vec2 pixel = toVec(to) + grip_->offset;
    const glm::vec2 pixels(static_cast<float>(size.width()), static_cast<float>(size.height()));
    grip_->pointer = to;
    switch (grip_->handle) {
    case RigHandle::from:
    case RigHandle::to:
        return dragLimit(pixel, pixels, coarse);
    case RigHandle::stroke:
        return dragStroke(pixel, pixels, coarse);
    case RigHandle::lineStart:
    case RigHandle::lineEnd:
        return dragEnd(pixel, pixels, coarse);
    case RigHandle::bendEnd:
        return dragBend(pixel, pixels, coarse);
    case RigHandle::direction:
        return dragDirection(pixel, pixels, coarse);
    }
}

void ActuatorHandles::dragLimit(glm::vec2 pixel, glm::vec2 size, bool coarse) {
    grip_->value = valueAt(grip_->start, camera_(), pixel, size, grip_->value);
    const bool turns = grip_->start.range.motion == Motion::turning;
    const double value = snapped(grip_->value, turns ? kCoarseTurn : kCoarseMove, coarse);
    guide_ = grip_->start; // its rest too: what is dragged follows the pointer
    guide_->range = limited(grip_->start.range, grip_->handle, value);
    const ActuatorRange range = guide_->range;
    preview_.show(*actuator_, [range](Actuator& actuator) { setRange(actuator, range.min, range.max); });
    const bool end = grip_->handle == RigHandle::to;
    grip_->label = (end ? tr("to %1") : tr("from %1")).arg(valueText(range, end ? range.max : range.min));
    rehearse(end ? 1.0 : 0.0);
}

void ActuatorHandles::dragStroke(glm::vec2 pixel, glm::vec2 size, bool coarse) {
    const ActuatorRange& range = grip_->start.range;
    grip_->value = valueAt(grip_->start, camera_(), pixel, size, grip_->value);
    double stroke = (grip_->value - range.min) / (range.max - range.min);
    stroke = std::clamp(snapped(stroke, kCoarseShare, coarse), 0.0, 1.0);
    if (*actuator_ < device_.size() && std::abs(stroke - device_[*actuator_]) < kStrokeCatch)
        stroke = device_[*actuator_];
    grip_->label = valueText(range, std::lerp(range.min, range.max, stroke));
    rehearse(stroke);
}

void ActuatorHandles::dragEnd(glm::vec2 pixel, glm::vec2 size, bool coarse) {
    const ActuatorGuide& start = grip_->start;
    const std::size_t moved = grip_->handle == RigHandle::lineEnd ? 1 : 0;
    auto ends = endsOf(start);
    const glm::vec3 fixed = ends[1 - moved];
    glm::vec3 to = onSheet(start, camera_(), pixel, size);
    const glm::vec3 normal = glm::cross(start.axis, start.arm);
    const float length = glm::distance(to, fixed);
    if (length < kLeastLine) return;
    if (coarse) to = fixed + length * squared((to - fixed) / length, normal);
    ends[moved] = to;
    guide_ = start;
    guide_->pivot = 0.5F * (ends[0] + ends[1]);
    guide_->half = 0.5F * glm::distance(ends[0], ends[1]);
    guide_->axis = glm::normalize(ends[1] - ends[0]);
    guide_->arm = glm::cross(normal, guide_->axis);
    preview_.show(*actuator_, [&start, &ends](Actuator& actuator) { setLine(actuator, start, ends); });
    const double turned = std::acos(std::clamp(glm::dot(guide_->axis, start.axis), -1.0F, 1.0F));
    grip_->label = tr("turned by %1°").arg(Angle::radians(turned).inDegrees(), 0, 'f', 1);
}

void ActuatorHandles::dragBend(glm::vec2 pixel, glm::vec2 size, bool coarse) {
    const ActuatorGuide& start = grip_->start;
    const glm::vec3 to = onSheet(start, camera_(), pixel, size);
    const double length =
        std::max<double>(snapped(glm::dot(to - start.pivot, start.arm), kCoarseMove, coarse), kLeastBend);
    guide_ = start;
    guide_->bendLength = length;
    preview_.show(*actuator_, [length](Actuator& actuator) {
        if (auto* bend = std::get_if<Bend>(&actuator.deformer)) bend->length = length;
    });
    grip_->label = tr("bends over %1 mm").arg(1000.0 * length, 0, 'f', 1);
}

void ActuatorHandles::dragDirection(glm::vec2 pixel, glm::vec2 size, bool coarse) {
    const ActuatorGuide& start = grip_->start;
    const ViewCamera camera = camera_();
    // In the plane of the picture through where the handle was.
    const auto handle = placeOf(start, start.range.max, 0.0F);
    const Ray ray = rayThrough(camera, pixel, size);
    const glm::vec3 back = pictureAxes(camera).back;
    const glm::vec3 tip = handle + kDirectionAhead * metresPerPixel(camera, handle, size) * start.axis;
    const glm::vec3 to = ray.origin + glm::dot(tip - ray.origin, back) / glm::dot(ray.direction, back) * ray.direction;
    if (glm::distance(to, start.pivot) < kLeastLine) return;
    glm::vec3 direction = glm::normalize(to - start.pivot);
    if (coarse) direction = squaredInRoom(direction);
    guide_ = start;
    guide_->axis = direction;
    preview_.show(*actuator_, [direction](Actuator& actuator) {
        if (auto* slide = std::get_if<Slide>(&actuator.deformer)) slide->direction = direction;
    });
    const double upright = std::acos(std::clamp(direction.y, -1.0F, 1.0F));
    grip_->label = tr("%1° from upright").arg(Angle::radians(upright).inDegrees(), 0, 'f', 1);
    rehearse(1.0);
}

/// The chosen actuator at this stroke, the others as they were shown when the drag began.
void ActuatorHandles::rehearse(double stroke) {
    std::vector<double> strokes = grip_->rehearsed.size() == device_.size() ? grip_->rehearsed : device_;
    if (*actuator_ >= strokes.size()) return;
    strokes[*actuator_] = stroke;
    if (strokes == device_) strokes.clear();
    shown_ = strokes.empty() ? device_ : strokes;
    selection_.rehearse(std::move(strokes), false);
}

QString ActuatorHandles::stepOf(RigHandle handle) const {
    switch (handle) {
    case RigHandle::lineStart:
    case RigHandle::lineEnd:
        return guide_->bendLength ? tr("Turn the bend line of %1") : tr("Turn the axis of %1");
    case RigHandle::bendEnd:
        return tr("Change the bend of %1");
    case RigHandle::direction:
        return tr("Turn the way of %1");
    default:
        return tr("Change the range of %1");
    }
}

void ActuatorHandles::release() {
    if (!grip_) return;
    const QString step = stepOf(grip_->handle);
    const Grip ended = *std::exchange(grip_, std::nullopt);
    if (ended.handle == RigHandle::stroke) return;
    const auto& parts = document_.state().rig.parts;
    if (document_.previewing() && parts && *actuator_ < parts->actuators.size())
        document_.commitPreview(step.arg(QString::fromStdString(parts->actuators[*actuator_].name)));
    selection_.rehearse(ended.rehearsed);
}

void ActuatorHandles::cancel() {
    if (!grip_) return;
    const Grip ended = *std::exchange(grip_, std::nullopt);
    guide_ = ended.start;
    if (ended.handle != RigHandle::stroke && document_.previewing()) document_.cancelPreview();
    selection_.rehearse(ended.rehearsed, ended.handle != RigHandle::stroke);
}

} // namespace lumorph::studio
