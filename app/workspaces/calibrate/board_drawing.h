#pragma once

#include <QWidget>

#include "calibration/decode/calibration_board.h"

namespace lumorph::studio {

/// A small drawing of a calibration board with what is counted and measured on it.
class BoardDrawing : public QWidget {
    Q_OBJECT
public:
    explicit BoardDrawing(QWidget* parent = nullptr);
    void show(const CalibrationBoard& board);
    [[nodiscard]] QSize sizeHint() const override { return {240, 120}; }

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    CalibrationBoard board_;
};

} // namespace lumorph::studio
