#include "app/workspaces/levels/level_painter.h"

#include <algorithm>
#include <cmath>

#include <QPainterPath>
#include <QPixmap>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

using labyrinth::Level;
using labyrinth::LevelCell;
using labyrinth::PickUp;
using labyrinth::Tile;
using labyrinth::Way;

// As the board itself: wood that is lighter the higher it lies, and brick. The same in both themes.
const QColor kLowFloor(148, 112, 74), kHighFloor(246, 226, 184), kWall(96, 62, 52), kWallEdge(136, 92, 76);
const QColor kDark(30, 22, 18), kBall(255, 150, 66), kGoal(60, 214, 110), kMark(255, 255, 255);

QColor floorColor(int height) {
    return blend(kLowFloor, kHighFloor, static_cast<double>(height) / labyrinth::kMaxHeight);
}

QColor gemColor(PickUp pickUp) {
    switch (pickUp) {
    case PickUp::red:
        return {242, 41, 36};
    case PickUp::green:
        return {30, 170, 70};
    case PickUp::blue:
        return {36, 107, 242};
    case PickUp::yellow:
        return {252, 204, 26};
    default:
        return {184, 66, 235};
    }
}

/// Turned so that uphill is to the right.
void turn(QPainter& painter, const QRectF& box, Way way) {
    painter.translate(box.center());
    painter.rotate(90.0 * static_cast<int>(way));
    painter.translate(-box.center());
}

void paintArrow(QPainter& painter, const QRectF& box) {
    const double s = box.width();
    QPainterPath arrow(box.center() + QPointF(-0.16 * s, -0.24 * s));
    arrow.lineTo(box.center() + QPointF(0.16 * s, 0.0));
    arrow.lineTo(box.center() + QPointF(-0.16 * s, 0.24 * s));
    painter.setPen(QPen(kDark, std::max(1.5, 0.09 * s), Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    painter.setBrush(Qt::NoBrush);
    painter.drawPath(arrow);
}

void paintSlope(QPainter& painter, const QRectF& box, const LevelCell& cell) {
    painter.save();
    turn(painter, box, cell.way);
    QLinearGradient rise(box.topLeft(), box.topRight());
    rise.setColorAt(0.0, floorColor(cell.height).darker(118));
    rise.setColorAt(1.0, floorColor(std::min(cell.height + 2, labyrinth::kMaxHeight)));
    painter.fillRect(box, rise);
    if (cell.tile == Tile::stairs) {
        painter.setPen(QPen(kDark, std::max(1.0, 0.05 * box.width())));
        for (const double at : {0.1, 0.36, 0.64, 0.9})
            painter.drawLine(QPointF(box.left() + at * box.width(), box.top()),
                             QPointF(box.left() + at * box.width(), box.bottom()));
    }
    paintArrow(painter, box);
    painter.restore();
}

void paintBridge(QPainter& painter, const QRectF& box, const LevelCell& cell) {
    painter.fillRect(box, floorColor(cell.height).darker(135));
    painter.save();
    turn(painter, box, cell.way);
    const QRectF deck = box.adjusted(0.0, 0.16 * box.height(), 0.0, -0.16 * box.height());
    painter.fillRect(deck, floorColor(6));
    painter.setPen(QPen(kLowFloor.darker(130), std::max(1.0, 0.04 * box.width())));
    for (const double at : {0.25, 0.5, 0.75})
        painter.drawLine(QPointF(box.left() + at * box.width(), deck.top()),
                         QPointF(box.left() + at * box.width(), deck.bottom()));
    painter.setPen(QPen(kDark, std::max(1.5, 0.09 * box.width())));
    painter.drawLine(deck.topLeft(), deck.topRight());
    painter.drawLine(deck.bottomLeft(), deck.bottomRight());
    painter.restore();
}

void paintWall(QPainter& painter, const QRectF& box) {
    painter.fillRect(box, kWall);
    painter.setPen(QPen(kWallEdge, std::max(1.0, 0.05 * box.width()), Qt::SolidLine, Qt::FlatCap));
    const double middle = box.center().y();
    painter.drawLine(QPointF(box.left(), middle), QPointF(box.right(), middle));
    painter.drawLine(QPointF(box.left() + 0.3 * box.width(), box.top()),
                     QPointF(box.left() + 0.3 * box.width(), middle));
    painter.drawLine(QPointF(box.left() + 0.7 * box.width(), middle),
                     QPointF(box.left() + 0.7 * box.width(), box.bottom()));
}

void paintGem(QPainter& painter, const QRectF& box, PickUp pickUp) {
    const double reach = 0.28 * box.width();
    QPolygonF gem;
    for (const QPointF& corner : {QPointF(0, -reach), QPointF(reach, 0), QPointF(0, reach), QPointF(-reach, 0)})
        gem << box.center() + corner;
    painter.setPen(QPen(kDark, std::max(1.0, 0.05 * box.width())));
    painter.setBrush(gemColor(pickUp));
    painter.drawPolygon(gem);
}

void paintCell(QPainter& painter, const QRectF& box, const LevelCell& cell) {
    switch (cell.tile) {
    case Tile::wall:
        return paintWall(painter, box);
    case Tile::ramp:
    case Tile::stairs:
        return paintSlope(painter, box, cell);
    case Tile::bridge:
        return paintBridge(painter, box, cell);
    default:
        painter.fillRect(box, floorColor(cell.height));
    }
    if (cell.tile == Tile::hole) {
        painter.setPen(Qt::NoPen);
        painter.setBrush(kDark);
        painter.drawEllipse(box.center(), 0.4 * box.width(), 0.4 * box.width());
    }
    if (cell.pickUp != PickUp::none) paintGem(painter, box, cell.pickUp);
}

void paintStart(QPainter& painter, const QRectF& box) {
    painter.setPen(QPen(kDark, std::max(1.0, 0.05 * box.width())));
    painter.setBrush(kBall);
    painter.drawEllipse(box.center(), 0.32 * box.width(), 0.32 * box.width());
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor(255, 236, 214));
    painter.drawEllipse(box.center() - QPointF(0.1, 0.1) * box.width(), 0.08 * box.width(), 0.08 * box.width());
}

void paintGoal(QPainter& painter, const QRectF& box) {
    painter.setPen(QPen(kDark, std::max(1.0, 0.05 * box.width())));
    painter.setBrush(kGoal);
    painter.drawEllipse(box.center(), 0.38 * box.width(), 0.38 * box.width());
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(kDark, std::max(1.5, 0.08 * box.width())));
    painter.drawEllipse(box.center(), 0.18 * box.width(), 0.18 * box.width());
}

/// How high floor lies, where there is room for it.
void paintHeight(QPainter& painter, const QRectF& box, const LevelCell& cell) {
    if (cell.tile == Tile::wall || cell.height == 0 || box.width() < 18.0) return;
    QFont font = painter.font();
    font.setPixelSize(std::max(9, static_cast<int>(0.3 * box.width())));
    painter.setFont(font);
    painter.setPen(kDark);
    painter.drawText(box.adjusted(0.0, 0.0, -0.08 * box.width(), -0.02 * box.height()),
                     Qt::AlignRight | Qt::AlignBottom, QString::number(cell.height));
}

void paintWay(QPainter& painter, const LevelView& view, const std::vector<glm::ivec2>& way) {
    if (way.size() < 2) return;
    QPainterPath path(view.boxOf(way.front()).center());
    for (const glm::ivec2 cell : way) path.lineTo(view.boxOf(cell).center());
    painter.setBrush(Qt::NoBrush);
    QPen pen(QColor(40, 110, 60, 200), std::max(1.5, 0.07 * view.side), Qt::DotLine, Qt::RoundCap, Qt::RoundJoin);
    painter.setPen(pen);
    painter.drawPath(path);
}

void paintFrame(QPainter& painter, const QRectF& box, const QColor& color) {
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(kDark, 4.0));
    painter.drawRect(box.adjusted(1, 1, -1, -1));
    painter.setPen(QPen(color, 2.0));
    painter.drawRect(box.adjusted(1, 1, -1, -1));
}

} // namespace

glm::ivec2 LevelView::cellAt(const QPointF& at) const {
    return {static_cast<int>(std::floor((at.x() - origin.x()) / side)),
            static_cast<int>(std::floor((at.y() - origin.y()) / side))};
}

LevelView LevelView::fitted(const Level& level, const QRectF& page) {
    LevelView view;
    view.side = std::max(4.0, std::floor(std::min(page.width() / level.columns, page.height() / level.rows)));
    view.origin = page.center() - 0.5 * view.side * QPointF(level.columns, level.rows);
    view.origin = {std::round(view.origin.x()), std::round(view.origin.y())};
    return view;
}

void paintLevel(QPainter& painter, const Level& level, const LevelView& view, const LevelMarks& marks) {
    painter.setRenderHint(QPainter::Antialiasing);
    for (int row = 0; row < level.rows; ++row)
        for (int column = 0; column < level.columns; ++column)
            paintCell(painter, view.boxOf({column, row}), level.at({column, row}));
    painter.setPen(QPen(QColor(0, 0, 0, 60), 1.0));
    const QRectF all(view.origin, view.side * QSizeF(level.columns, level.rows));
    for (int column = 1; column < level.columns; ++column)
        painter.drawLine(QPointF(all.left() + column * view.side, all.top()),
                         QPointF(all.left() + column * view.side, all.bottom()));
    for (int row = 1; row < level.rows; ++row)
        painter.drawLine(QPointF(all.left(), all.top() + row * view.side),
                         QPointF(all.right(), all.top() + row * view.side));
    paintWay(painter, view, marks.way);
    paintGoal(painter, view.boxOf(level.goal));
    paintStart(painter, view.boxOf(level.start));
    for (int row = 0; row < level.rows; ++row)
        for (int column = 0; column < level.columns; ++column)
            paintHeight(painter, view.boxOf({column, row}), level.at({column, row}));
    if (marks.wrong) paintFrame(painter, view.boxOf(*marks.wrong), QColor(255, 92, 80));
    if (marks.cursor) paintFrame(painter, view.boxOf(*marks.cursor), kMark);
}

QIcon pieceIcon(const LevelPiece& piece) {
    constexpr int kSide = 56; // of a picture that is shown at half of it
    QPixmap picture(kSide, kSide);
    picture.fill(Qt::transparent);
    QPainter painter(&picture);
    painter.setRenderHint(QPainter::Antialiasing);
    const QRectF box(0, 0, kSide, kSide);
    QPainterPath round;
    round.addRoundedRect(box, 8, 8);
    painter.setClipPath(round);
    LevelCell cell;
    cell.height = 3;
    cell.way = piece.way;
    if (piece.kind == LevelPiece::Kind::wall) cell.tile = Tile::wall;
    if (piece.kind == LevelPiece::Kind::hole) cell.tile = Tile::hole;
    if (piece.kind == LevelPiece::Kind::ramp) cell.tile = Tile::ramp;
    if (piece.kind == LevelPiece::Kind::stairs) cell.tile = Tile::stairs;
    if (piece.kind == LevelPiece::Kind::bridge) cell.tile = Tile::bridge;
    if (piece.kind == LevelPiece::Kind::pickUp) cell.pickUp = piece.color;
    paintCell(painter, box, cell);
    if (piece.kind == LevelPiece::Kind::start) paintStart(painter, box);
    if (piece.kind == LevelPiece::Kind::goal) paintGoal(painter, box);
    return QIcon(picture);
}

} // namespace lumorph::studio
