#include "app/workspaces/rig/sheet_canvas.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QWheelEvent>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/studio/look/palette.h"
#include "core/rig/templates/sheet_outline.h"

namespace lumorph::studio {

namespace {

using Kind = SheetPart::Kind;

constexpr double kLeastDrag = 0.003; ///< metres: a shorter drag was a click
const Angle kTurnStep = Angle::degrees(15.0);

/// The same away from `from` in both directions, for squares and circles.
glm::dvec2 squared(const glm::dvec2& from, const glm::dvec2& to) {
    const glm::dvec2 way = to - from;
    const double side = std::max(std::abs(way.x), std::abs(way.y));
    return from + side * glm::dvec2(way.x < 0.0 ? -1.0 : 1.0, way.y < 0.0 ? -1.0 : 1.0);
}

QString centimetres(double metres) { return QString::number(100.0 * metres, 'f', 1); }

} // namespace

SheetCanvas::SheetCanvas(QWidget* parent) : QWidget(parent) {
    setObjectName("sheet.canvas");
    setAccessibleName(tr("The page"));
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    setMinimumSize(320, 240);
    setCursor(Qt::ArrowCursor);
}

void SheetCanvas::show(const SheetDevice& device) {
    device_ = device;
    if (chosen_.isLine() && chosen_.index >= device_.bends.size()) choose({});
    if (!chosen_.isLine() && chosen_.index >= std::max<std::size_t>(1, device_.outline.size())) choose({});
    hovered_ = {};
    changed();
}

void SheetCanvas::setPlan(std::shared_ptr<const SheetPlan> plan) {
    plan_ = std::move(plan);
    changed();
}

void SheetCanvas::setTool(SheetTool tool) {
    if (tool_ == tool) return;
    tool_ = tool;
    begun_.reset();
    polygon_.clear();
    hovered_ = {};
    setCursor(tool == SheetTool::select ? Qt::ArrowCursor : Qt::CrossCursor);
    emit toolChanged();
    changed();
}

void SheetCanvas::choose(const SheetPart& part) {
    if (chosen_ == part) return;
    chosen_ = part;
    emit chosenChanged();
    changed();
}

std::optional<std::size_t> SheetCanvas::chosenLine() const {
    return chosen_.isLine() ? std::optional(chosen_.index) : std::nullopt;
}

void SheetCanvas::setSnapping(bool on) { snapping_ = on; }

void SheetCanvas::changed() {
    update();
    emit hintChanged();
}

void SheetCanvas::showAll() {
    constexpr double kMargin = 0.02;    // metres around it
    constexpr double kEmptyPage = 0.32; // metres of an empty page
    OutlineBox box = boxOf(device_.outline);
    if (device_.outline.empty()) box = {glm::dvec2(-0.5 * kEmptyPage), glm::dvec2(0.5 * kEmptyPage)};
    for (const BendLine& bend : device_.bends)
        for (const glm::dvec2& p : {bend.from, bend.to}) {
            box.low = glm::min(box.low, p);
            box.high = glm::max(box.high, p);
        }
    view_.centre = QPointF(0.5 * (width() + kRulerWidth), 0.5 * (height() + kRulerWidth));
    view_.middle = box.middle();
    const glm::dvec2 size = glm::max(box.size() + 2.0 * kMargin, glm::dvec2(0.1));
    view_.scale = std::min((width() - kRulerWidth) / size.x, (height() - kRulerWidth) / size.y);
    fitted_ = true;
    update();
}

SnapRules SheetCanvas::rules(const SheetPart& without) const { return {gridSpacing(view_), reach(), without}; }

SnappedPoint SheetCanvas::snap(const QPointF& pixel, Qt::KeyboardModifiers modifiers, const SheetPart& without,
                               std::optional<glm::dvec2> from) const {
    const glm::dvec2 at = view_.place(pixel);
    if ((modifiers & Qt::ControlModifier) || !snapping_) return {at, SnappedPoint::To::nothing};
    if ((modifiers & Qt::ShiftModifier) && from) return snappedTurn(device_, *from, at, kTurnStep, rules(without));
    return snapped(device_, at, rules(without));
}

void SheetCanvas::mousePressEvent(QMouseEvent* event) {
    setFocus(Qt::MouseFocusReason);
    if (event->button() != Qt::LeftButton) {
        panned_ = event->position();
        return;
    }
    if (tool_ == SheetTool::select) return beginSelect(event);
    const SnappedPoint point = snap(event->position(), event->modifiers(), {});
    pointer_ = point;
    if (tool_ == SheetTool::polygon) return pressPolygon(point);
    begun_ = Begun{point.point, point.point};
    changed();
}

void SheetCanvas::beginSelect(QMouseEvent* event) {
    const glm::dvec2 at = view_.place(event->position());
    const SheetPart part = partAt(device_, at, reach(), chosenLine());
    choose(part);
    if (part.kind == Kind::none) {
        panned_ = event->position();
        return;
    }
    glm::dvec2 anchor = at;
    if (part.kind == Kind::line || part.kind == Kind::lineFrom) anchor = device_.bends[part.index].from;
    if (part.kind == Kind::lineTo) anchor = device_.bends[part.index].to;
    if (part.kind == Kind::corner || part.kind == Kind::edge) anchor = device_.outline[part.index];
    drag_ = Drag{part, at, anchor, device_};
}

void SheetCanvas::pressPolygon(const SnappedPoint& point) {
    if (polygon_.size() >= 3 && glm::distance(point.point, polygon_.front()) < reach()) return closePolygon();
    if (polygon_.empty() || glm::distance(point.point, polygon_.back()) > kLeastDrag) polygon_.push_back(point.point);
    changed();
}

void SheetCanvas::closePolygon() {
    if (polygon_.size() < 3) return;
    const SheetDevice next = withOutline(device_, std::exchange(polygon_, {}));
    setTool(SheetTool::line);
    emit edited(next, tr("Draw the outline"));
}

void SheetCanvas::mouseMoveEvent(QMouseEvent* event) {
    if (panned_) {
        const QPointF way = event->position() - *panned_;
        view_.middle -= glm::dvec2(way.x(), way.y()) / view_.scale;
        panned_ = event->position();
        fitted_ = true;
        update();
    } else if (drag_) {
        dragTo(event);
    } else {
        hover(event);
    }
}

void SheetCanvas::dragTo(QMouseEvent* event) {
    constexpr double kStart = 3.0; // pixels: a hand that clicks moves a little
    const glm::dvec2 at = view_.place(event->position());
    if (!drag_->moved && glm::distance(at, drag_->held) * view_.scale < kStart) return;
    drag_->moved = true;
    const SheetPart& part = drag_->part;
    std::optional<glm::dvec2> fixed; // what angles are measured from
    if (part.kind == Kind::lineFrom) fixed = drag_->before.bends[part.index].to;
    if (part.kind == Kind::lineTo) fixed = drag_->before.bends[part.index].from;
    const QPointF aim = view_.pixel(drag_->anchor + at - drag_->held);
    pointer_ = snap(aim, event->modifiers(), part, fixed);
    device_ = withMoved(drag_->before, part, drag_->anchor, pointer_->point);
    emit previewed(device_);
    changed();
}

void SheetCanvas::hover(QMouseEvent* event) {
    if (tool_ == SheetTool::select) {
        pointer_.reset();
        const SheetPart part = partAt(device_, view_.place(event->position()), reach(), chosenLine());
        if (std::exchange(hovered_, part) != part) update();
        setCursor(part.kind == Kind::none ? Qt::ArrowCursor : Qt::SizeAllCursor);
        return;
    }
    const bool line = tool_ == SheetTool::line;
    pointer_ =
        snap(event->position(), event->modifiers(), {}, begun_ && line ? std::optional(begun_->from) : std::nullopt);
    if (begun_) {
        begun_->to = pointer_->point;
        if (!line && (event->modifiers() & Qt::ShiftModifier)) begun_->to = squared(begun_->from, begun_->to);
    }
    changed();
}

void SheetCanvas::mouseReleaseEvent(QMouseEvent* event) {
    if (panned_) {
        panned_.reset();
        return;
    }
    if (event->button() != Qt::LeftButton) return;
    if (begun_) {
        hover(event);
        endShape();
    } else if (drag_) {
        endDrag();
    }
}

void SheetCanvas::endDrag() {
    const Drag drag = *std::exchange(drag_, std::nullopt);
    pointer_.reset();
    if (!drag.moved) return;
    const QString step = drag.part.isLine()               ? tr("Move a bend line")
                         : drag.part.kind == Kind::corner ? tr("Move a corner")
                                                          : tr("Move an edge");
    emit edited(device_, step);
    changed();
}

std::vector<glm::dvec2> SheetCanvas::shapeBegun() const {
    if (!begun_ || tool_ == SheetTool::line) return {};
    const glm::dvec2 size = glm::abs(begun_->to - begun_->from);
    std::vector<glm::dvec2> outline =
        tool_ == SheetTool::ellipse ? ellipseOutline(size.x, size.y) : rectangleOutline(size.x, size.y);
    for (glm::dvec2& p : outline) p += 0.5 * (begun_->from + begun_->to);
    return outline;
}

void SheetCanvas::endShape() {
    std::vector<glm::dvec2> outline = shapeBegun();
    const Begun shape = *std::exchange(begun_, std::nullopt);
    const glm::dvec2 size = glm::abs(shape.to - shape.from);
    if (tool_ == SheetTool::line) {
        if (glm::length(size) >= kLeastDrag) {
            const std::size_t line = device_.bends.size();
            emit edited(withLine(device_, shape.from, shape.to), tr("Draw a bend line"));
            if (line < device_.bends.size()) choose({Kind::line, line});
        }
    } else if (std::min(size.x, size.y) >= kLeastDrag) {
        const SheetDevice next = withOutline(device_, std::move(outline));
        setTool(SheetTool::line);
        emit edited(next, tr("Draw the outline"));
    }
    changed();
}

void SheetCanvas::mouseDoubleClickEvent(QMouseEvent* event) {
    if (tool_ == SheetTool::select && event->button() == Qt::LeftButton) {
        const glm::dvec2 at = view_.place(event->position());
        const SheetPart part = partAt(device_, at, reach());
        if (part.kind == Kind::edge) {
            const SheetPart corner{Kind::corner, part.index + 1};
            emit edited(withCorner(device_, part.index, snap(event->position(), event->modifiers(), {}).point),
                        tr("Add a corner"));
            return choose(corner);
        }
    }
    mousePressEvent(event);
}

void SheetCanvas::wheelEvent(QWheelEvent* event) {
    constexpr double kNotch = 120.0, kLeastScale = 200.0, kMostScale = 40'000.0;
    const glm::dvec2 held = view_.place(event->position());
    const double factor = std::pow(1.15, event->angleDelta().y() / kNotch);
    view_.scale = std::clamp(view_.scale * factor, kLeastScale, kMostScale);
    view_.middle += held - view_.place(event->position());
    fitted_ = true;
    update();
    event->accept();
}

void SheetCanvas::keyPressEvent(QKeyEvent* event) {
    static constexpr std::pair<Qt::Key, SheetTool> kTools[] = {{Qt::Key_V, SheetTool::select},
                                                               {Qt::Key_B, SheetTool::line},
                                                               {Qt::Key_R, SheetTool::rectangle},
                                                               {Qt::Key_E, SheetTool::ellipse},
                                                               {Qt::Key_P, SheetTool::polygon}};
    const bool plain = (event->modifiers() & ~Qt::ShiftModifier) == Qt::NoModifier;
    for (const auto& [key, tool] : kTools)
        if (plain && event->key() == key) return setTool(tool);
    switch (event->key()) {
    case Qt::Key_Escape:
        if (leave()) return;
        break;
    case Qt::Key_Home:
        return showAll();
    case Qt::Key_Delete:
        return removeChosen();
    case Qt::Key_Backspace:
        if (polygon_.empty()) return removeChosen();
        polygon_.pop_back();
        return changed();
    case Qt::Key_Return:
    case Qt::Key_Enter: // never the window's button: one who closes an outline has not finished the device
        return closePolygon();
    default:
        break;
    }
    QWidget::keyPressEvent(event);
}

bool SheetCanvas::leave() {
    if (drag_) {
        device_ = std::exchange(drag_, std::nullopt)->before;
        emit reverted();
    } else if (begun_ || !polygon_.empty()) {
        begun_.reset();
        polygon_.clear();
    } else if (chosen_.kind != Kind::none) {
        choose({});
    } else if (tool_ != SheetTool::select) {
        setTool(SheetTool::select);
    } else {
        return false;
    }
    pointer_.reset();
    changed();
    return true;
}

void SheetCanvas::removeChosen() {
    const SheetPart part = chosen_;
    if (drag_ || begun_) return;
    if (part.isLine()) {
        choose({});
        emit edited(withoutLine(device_, part.index), tr("Delete a bend line"));
    } else if (part.kind == Kind::corner && device_.outline.size() > 3) {
        choose({});
        emit edited(withoutCorner(device_, part.index), tr("Delete a corner"));
    }
}

void SheetCanvas::leaveEvent(QEvent*) {
    hovered_ = {};
    if (!drag_ && !begun_) pointer_.reset();
    changed();
}

void SheetCanvas::resizeEvent(QResizeEvent*) {
    if (!fitted_ || view_.centre.isNull()) {
        showAll();
        fitted_ = false; // until one has moved it
    } else {
        view_.centre = QPointF(0.5 * (width() + kRulerWidth), 0.5 * (height() + kRulerWidth));
    }
}

QString SheetCanvas::readout() const {
    if (begun_ && tool_ == SheetTool::line) {
        const glm::dvec2 way = begun_->to - begun_->from;
        const double degrees = std::atan2(-way.y, way.x) * 180.0 / std::numbers::pi; // up is positive, as in a drawing
        return tr("%1 cm, %2°").arg(centimetres(glm::length(way))).arg(std::round(degrees));
    }
    if (begun_) {
        const glm::dvec2 size = glm::abs(begun_->to - begun_->from);
        return tr("%1 × %2 cm").arg(centimetres(size.x), centimetres(size.y));
    }
    if ((drag_ && drag_->moved) || tool_ != SheetTool::select)
        return pointer_ ? tr("%1, %2 cm").arg(centimetres(pointer_->point.x), centimetres(pointer_->point.y))
                        : QString();
    return {};
}

const QPixmap& SheetCanvas::page() {
    const double ratio = devicePixelRatioF();
    const QSize pixels = (QSizeF(size()) * ratio).toSize();
    if (page_.size() == pixels && pageView_ == view_ && pageTheme_ == currentTheme()) return page_;
    page_ = QPixmap(pixels);
    page_.setDevicePixelRatio(ratio);
    pageView_ = view_;
    pageTheme_ = currentTheme();
    QPainter painter(&page_);
    painter.setFont(font());
    paintPage(painter, view_, rect());
    return page_;
}

void SheetCanvas::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    SheetPage picture{device_, plan_, view_, rect(), chosen_, hovered_, shapeBegun(), true, {}, pointer_, readout()};
    if (!polygon_.empty()) {
        picture.outlineBegun = polygon_;
        if (pointer_) picture.outlineBegun.push_back(pointer_->point);
        picture.outlineCloses = false;
    }
    if (begun_ && tool_ == SheetTool::line) picture.lineBegun = {begun_->from, begun_->to};
    paintSheet(painter, picture, page());
}

bool SheetCanvas::chosenRefused() const {
    return plan_ && chosenLine() && plan_->flaps.size() == device_.bends.size() && !plan_->actuators[*chosenLine()];
}

QString SheetCanvas::hint() const {
    const bool empty = device_.outline.empty();
    switch (tool_) {
    case SheetTool::rectangle:
    case SheetTool::ellipse:
        return tool_ == SheetTool::rectangle
                   ? tr("Press where a corner of the sheet is to be, drag to the opposite one, let go. Shift: a "
                        "square.")
                   : tr("Press where the sheet is to begin, drag across it, let go. Shift: a circle.");
    case SheetTool::polygon:
        if (polygon_.empty()) return tr("Click where the first corner of the sheet is to be.");
        if (polygon_.size() < 3) return tr("Click the next corner. Backspace takes the last one back.");
        return tr("Click the next corner, or the first one again to close the outline (Enter does it too).");
    case SheetTool::line:
        if (empty) return tr("A bend line needs a sheet: choose Rectangle, Ellipse or Polygon first.");
        if (begun_) return tr("Drag to where the bend line ends, and let go. Shift: steps of 15°. Ctrl: no snapping.");
        if (device_.bends.empty())
            return tr("Now draw where the sheet bends: press at one edge, drag across to another, let go.");
        if (chosenRefused())
            return tr("The red line has no flap. Delete takes it away; with Select (V) you can move it.");
        if (chosenLine())
            return tr("Draw the next bend line, or copy this one with Mirror or Around. Esc lets go of it: then they "
                      "copy the whole sheet.");
        return tr("Rehearse it on the right, draw another bend line, or make the device. Mirror and Around now copy "
                  "the whole sheet.");
    case SheetTool::select:
        break;
    }
    if (empty)
        return tr("Begin with the sheet's outline: choose Rectangle, Ellipse or Polygon above, or import a drawing.");
    switch (chosen_.kind) {
    case Kind::line:
    case Kind::lineFrom:
    case Kind::lineTo:
        if (chosenRefused()) return tr("The red line has no flap. Drag it or its ends elsewhere, or press Delete.");
        return tr("Drag the bend line, or one of its ends. Delete removes it; its angle and side are on the right.");
    case Kind::corner:
        return tr("Drag the corner to where it is to be. Delete removes it.");
    case Kind::edge:
        return tr("Drag the edge. A double click on it adds a corner.");
    case Kind::none:
        break;
    }
    return device_.bends.empty() ? tr("Choose Bend line and draw where the sheet bends.")
                                 : tr("Click a bend line, a corner or an edge to change it; drag beside them to move "
                                      "the page.");
}

} // namespace lumorph::studio
