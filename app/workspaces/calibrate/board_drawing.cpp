#include "app/workspaces/calibrate/board_drawing.h"

#include <algorithm>

#include <QPainter>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

constexpr int kMostSquares = 60; // along a side: more could not be seen
constexpr double kDot = 1.8;

} // namespace

BoardDrawing::BoardDrawing(QWidget* parent) : QWidget(parent) {
    setObjectName("calibrate.board.drawing");
    setAccessibleName("Drawing of the board");
    setToolTip("Dots mark the points that are counted; the bar marks what is measured in millimetres");
    setMinimumHeight(110);
}

void BoardDrawing::show(const CalibrationBoard& board) {
    if (board == board_) return;
    board_ = board;
    update();
}

void BoardDrawing::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const int columns = std::clamp(board_.columns, 1, kMostSquares);
    const int rows = std::clamp(board_.rows, 1, kMostSquares);
    const bool circles = board_.kind == CalibrationBoard::Kind::circles;
    const bool chess = board_.kind == CalibrationBoard::Kind::chess;
    // In squares: a chessboard has one more than inner corners; asymmetric circles lie on every second place.
    const double wide = circles ? 2.0 * columns + 1.0 : columns + (chess ? 1 : 0);
    const double high = circles ? rows + 1.0 : rows + (chess ? 1 : 0);
    const double side = std::min((width() - 8.0) / wide, (height() - 22.0) / high);
    const QPointF origin((width() - wide * side) / 2.0, 2.0);
    painter.fillRect(QRectF(origin, QSizeF(wide * side, high * side)), Qt::white);
    const auto place = [&](double x, double y) { return origin + QPointF(x * side, y * side); };
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor(30, 30, 32));
    if (circles) {
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x)
                painter.drawEllipse(place(2.0 * x + 1.0 + y % 2, y + 1.0), 0.35 * side, 0.35 * side);
    } else {
        for (int y = 0; y < static_cast<int>(high); ++y)
            for (int x = 0; x < static_cast<int>(wide); ++x) {
                if ((x + y) % 2 == 0) {
                    painter.drawRect(QRectF(place(x, y), QSizeF(side, side)));
                } else if (!chess) { // a marker in the white square
                    const double edge = std::clamp(board_.marker / std::max(1e-9, board_.spacing), 0.1, 1.0) * side;
                    const QPointF middle = place(x + 0.5, y + 0.5);
                    painter.drawRect(QRectF(middle.x() - edge / 2, middle.y() - edge / 2, edge, edge));
                    painter.setBrush(Qt::white);
                    painter.drawRect(QRectF(middle.x() - edge / 8, middle.y() - edge / 4, edge / 4, edge / 4));
                    painter.setBrush(QColor(30, 30, 32));
                }
            }
    }
    if (chess && side > 5.0) {
        painter.setBrush(colors.accent);
        for (int y = 1; y <= rows; ++y)
            for (int x = 1; x <= columns; ++x) painter.drawEllipse(place(x, y), kDot, kDot);
    }
    // What is measured.
    painter.setPen(QPen(colors.accent, 2.0));
    const double from = circles ? 1.0 : 0.0;
    const double below = high + 3.0 / side;
    painter.drawLine(place(from, below), place(from + 1.0, below));
    painter.setPen(colors.textMuted);
    painter.drawText(QRectF(place(from + 1.0, high) + QPointF(6.0, 0.0), QSizeF(width(), 18.0)),
                     Qt::AlignLeft | Qt::AlignVCenter, QString("%1 mm").arg(board_.spacing));
}

} // namespace lumorph::studio
