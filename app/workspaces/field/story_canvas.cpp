#include "app/workspaces/field/story_canvas.h"

#include <algorithm>
#include <cmath>

#include <QHelpEvent>
#include <QToolTip>

namespace lumorph::studio {

namespace {

constexpr int kCanvasMargin = 8;
constexpr int kWheelNotch = 120; ///< eighths of a degree

} // namespace

StoryCanvas::StoryCanvas(QWidget* parent) : QWidget(parent), colors_(currentPalette()) {
    setObjectName("story.canvas");
    setAccessibleName(tr("A cut through the field"));
}

void StoryCanvas::setPicture(const StoryPicture& picture) {
    picture_ = picture;
    painted_ = {};
    const StoryWords words = wordsOf(picture);
    setAccessibleDescription(words.title + ". " + words.text);
    update();
}

void StoryCanvas::setColors(const Palette& colors) {
    colors_ = colors;
    painted_ = {};
    update();
}

QRectF StoryCanvas::area() const {
    return QRectF(rect()).adjusted(kCanvasMargin, kCanvasMargin, -kCanvasMargin, -kCanvasMargin);
}

StoryLayout StoryCanvas::layoutNow() const { return layoutOf(*picture_, area(), 1.0); }

std::optional<glm::ivec2> StoryCanvas::voxelAt(const QPointF& place) const {
    const StoryLayout layout = layoutNow();
    for (const QRectF& plane : {layout.section, layout.second})
        if (plane.contains(place))
            return glm::ivec2(static_cast<int>(std::floor((place.x() - plane.left()) / layout.voxel)),
                              static_cast<int>(std::floor((plane.bottom() - place.y()) / layout.voxel)));
    return std::nullopt;
}

bool StoryCanvas::event(QEvent* event) {
    if (event->type() != QEvent::ToolTip || !picture_ || !canBeTold(*picture_)) return QWidget::event(event);
    const auto* help = static_cast<QHelpEvent*>(event);
    if (const auto voxel = voxelAt(help->pos()))
        QToolTip::showText(help->globalPos(), voxelText(*picture_, *voxel), this);
    else
        QToolTip::hideText();
    return true;
}

void StoryCanvas::paintEvent(QPaintEvent* /*event*/) {
    if (!picture_) return;
    if (painted_.isNull() || painted_.deviceIndependentSize().toSize() != size()) {
        painted_ = QPixmap(size() * devicePixelRatio());
        painted_.setDevicePixelRatio(devicePixelRatio());
        painted_.fill(Qt::transparent);
        QPainter painter(&painted_);
        painter.setFont(font());
        paintSection(painter, *picture_, area(), 1.0, colors_);
    }
    QPainter(this).drawPixmap(0, 0, painted_);
}

void StoryCanvas::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton || !picture_ || !canBeTold(*picture_)) return;
    const StoryLayout layout = layoutNow();
    const auto under = [&](const QRectF& part) { return part.contains(event->position()); };
    if (const auto chart = std::ranges::find_if(layout.charts, under); chart != layout.charts.end())
        emit actuatorChosen(static_cast<int>(chart - layout.charts.begin()));
    if (const auto state = std::ranges::find_if(layout.states, under); state != layout.states.end())
        emit levelChosen(layout.stateLevels[static_cast<std::size_t>(state - layout.states.begin())]);
}

void StoryCanvas::wheelEvent(QWheelEvent* event) {
    wheel_ += event->angleDelta().y();
    const int notches = wheel_ / kWheelNotch;
    wheel_ -= notches * kWheelNotch;
    if (notches != 0) emit planeMoved(notches);
    event->accept();
}

} // namespace lumorph::studio
