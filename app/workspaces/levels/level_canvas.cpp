#include "app/workspaces/levels/level_canvas.h"

#include <algorithm>
#include <cstdlib>

#include <QKeyEvent>
#include <QMouseEvent>

#include <glm/common.hpp>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

const LevelPiece kFloorPiece{LevelPiece::Kind::floor};

QString nameOf(const LevelPiece& piece) {
    const auto found = std::ranges::find(offeredPieces(), piece, &OfferedPiece::piece);
    return found == offeredPieces().end() ? QString() : QObject::tr(found->name);
}

/// What lies in a cell, as a piece.
LevelPiece pieceAt(const labyrinth::Level& level, glm::ivec2 cell) {
    if (cell == level.start) return {LevelPiece::Kind::start};
    if (cell == level.goal) return {LevelPiece::Kind::goal};
    const labyrinth::LevelCell& here = level.at(cell);
    if (here.pickUp != labyrinth::PickUp::none) return {LevelPiece::Kind::pickUp, labyrinth::Way::right, here.pickUp};
    switch (here.tile) {
    case labyrinth::Tile::wall:
        return {LevelPiece::Kind::wall};
    case labyrinth::Tile::hole:
        return {LevelPiece::Kind::hole};
    case labyrinth::Tile::ramp:
        return {LevelPiece::Kind::ramp, here.way};
    case labyrinth::Tile::stairs:
        return {LevelPiece::Kind::stairs, here.way};
    case labyrinth::Tile::bridge:
        return {LevelPiece::Kind::bridge, here.way};
    default:
        return kFloorPiece;
    }
}

} // namespace

LevelCanvas::LevelCanvas(LevelDraft& draft, QWidget* parent) : QWidget(parent), draft_(draft) {
    setObjectName("levels.canvas");
    setAccessibleName(tr("The level"));
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    setMinimumSize(420, 300);
    setCursor(Qt::CrossCursor);
}

void LevelCanvas::setPiece(const LevelPiece& piece) {
    if (piece_ == piece) return;
    piece_ = piece;
    emit pieceChanged();
}

void LevelCanvas::setPieceHeight(int steps) {
    const int height = std::clamp(steps, 0, labyrinth::kMaxHeight);
    if (height_ == height) return;
    height_ = height;
    emit heightChanged();
}

LevelView LevelCanvas::view() const {
    constexpr double kMargin = 8.0;
    return LevelView::fitted(draft_.level(), QRectF(rect()).adjusted(kMargin, kMargin, -kMargin, -kMargin));
}

QString LevelCanvas::cursorText() const {
    const labyrinth::Level& level = draft_.level();
    const QString height =
        level.at(cursor_).height > 0 ? tr(", %1 steps high").arg(level.at(cursor_).height) : QString();
    return tr("Column %1, row %2: %3%4")
        .arg(cursor_.x + 1)
        .arg(cursor_.y + 1)
        .arg(nameOf(pieceAt(level, cursor_)).toLower(), height);
}

void LevelCanvas::refresh() {
    const labyrinth::Level& level = draft_.level();
    cursor_ = glm::clamp(cursor_, glm::ivec2(0), glm::ivec2(level.columns - 1, level.rows - 1));
    setAccessibleDescription(cursorText());
    emit cursorChanged();
    update();
}

void LevelCanvas::paintEvent(QPaintEvent* /*event*/) {
    QPainter painter(this);
    painter.fillRect(rect(), currentPalette().sunken);
    LevelMarks marks;
    if (hasFocus() || over_) marks.cursor = cursor_;
    if (const LevelFinding* finding = draft_.firstFinding()) marks.wrong = finding->cell;
    marks.way = draft_.way();
    paintLevel(painter, draft_.level(), view(), marks);
}

void LevelCanvas::begin(const LevelPiece& piece) {
    drawn_ = piece;
    draft_.beginStroke((piece == kFloorPiece ? tr("Clear") : nameOf(piece)).toStdString());
}

void LevelCanvas::drawTo(glm::ivec2 cell) {
    if (!drawn_) return;
    // A fast hand leaves out cells: all on the straight way there are meant.
    const glm::ivec2 way = cell - last_;
    const int steps = std::max({std::abs(way.x), std::abs(way.y), 1});
    for (int k = 1; k <= steps; ++k) {
        const glm::dvec2 at = glm::dvec2(last_) + glm::dvec2(way) * (static_cast<double>(k) / steps);
        draft_.put(*drawn_, glm::ivec2(glm::round(at)), height_);
    }
    last_ = cell;
    emit edited();
    refresh();
}

void LevelCanvas::moveCursor(glm::ivec2 cell) {
    const labyrinth::Level& level = draft_.level();
    cursor_ = glm::clamp(cell, glm::ivec2(0), glm::ivec2(level.columns - 1, level.rows - 1));
    refresh();
}

void LevelCanvas::mousePressEvent(QMouseEvent* event) {
    const glm::ivec2 cell = view().cellAt(event->position());
    if (!draft_.level().holds(cell)) return;
    begin(event->button() == Qt::LeftButton ? piece_ : kFloorPiece);
    last_ = cell;
    moveCursor(cell);
    drawTo(cell);
}

void LevelCanvas::mouseMoveEvent(QMouseEvent* event) {
    over_ = true;
    const glm::ivec2 cell = view().cellAt(event->position());
    if (cell == cursor_ && !drawn_) return;
    if (draft_.level().holds(cell)) moveCursor(cell);
    if (drawn_ && cell != last_) drawTo(cell);
}

void LevelCanvas::mouseReleaseEvent(QMouseEvent* /*event*/) { drawn_.reset(); }

void LevelCanvas::leaveEvent(QEvent* event) {
    over_ = false;
    update();
    QWidget::leaveEvent(event);
}

void LevelCanvas::focusInEvent(QFocusEvent* event) {
    update();
    QWidget::focusInEvent(event);
}

void LevelCanvas::focusOutEvent(QFocusEvent* event) {
    drawn_.reset();
    update();
    QWidget::focusOutEvent(event);
}

bool LevelCanvas::step(int key, Qt::KeyboardModifiers modifiers) {
    glm::ivec2 way(0);
    if (key == Qt::Key_Left) way = {-1, 0};
    if (key == Qt::Key_Right) way = {1, 0};
    if (key == Qt::Key_Up) way = {0, -1};
    if (key == Qt::Key_Down) way = {0, 1};
    if (way == glm::ivec2(0)) return false;
    const glm::ivec2 from = cursor_;
    moveCursor(cursor_ + way);
    if (!(modifiers & Qt::ShiftModifier)) return true;
    begin(piece_);
    last_ = from;
    draft_.put(piece_, from, height_);
    drawTo(cursor_);
    drawn_.reset();
    return true;
}

/// By the sign that the level's text has for it, or a height.
bool LevelCanvas::choose(const QString& text) {
    if (text.size() != 1) return false;
    const char sign = text[0].toLatin1();
    if (sign >= '0' && sign <= '9') {
        setPieceHeight(sign - '0');
        return true;
    }
    if (sign == '[' || sign == ']') {
        setPieceHeight(height_ + (sign == ']' ? 1 : -1));
        return true;
    }
    const auto found = std::ranges::find(offeredPieces(), sign, &OfferedPiece::sign);
    if (sign == 0 || found == offeredPieces().end()) return false;
    setPiece(found->piece);
    return true;
}

void LevelCanvas::keyPressEvent(QKeyEvent* event) {
    const bool puts = event->key() == Qt::Key_Space || event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter;
    const bool clears = event->key() == Qt::Key_Delete || event->key() == Qt::Key_Backspace;
    if (puts || clears) {
        begin(puts ? piece_ : kFloorPiece);
        last_ = cursor_;
        drawTo(cursor_);
        drawn_.reset();
    } else if (!step(event->key(), event->modifiers()) && !choose(event->text())) {
        QWidget::keyPressEvent(event);
    }
}

} // namespace lumorph::studio
