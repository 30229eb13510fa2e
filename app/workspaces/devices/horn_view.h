#pragma once

#include <vector>

#include <QWidget>

#include "devices/simulator/simulated_bench.h"

namespace lumorph::studio {

/// The servos of a simulated board as they really are: a horn each, grey while it gets no pulse.
class HornView : public QWidget {
    Q_OBJECT
public:
    explicit HornView(QWidget* parent = nullptr);
    /// `channels` of the board, in the order of the rig's actuators; the board's own begin with `first`.
    void show(std::vector<SimulatedServo> servos, std::vector<int> channels, int first);
    [[nodiscard]] QSize sizeHint() const override;
    [[nodiscard]] QSize minimumSizeHint() const override;
    [[nodiscard]] bool hasHeightForWidth() const override { return true; }
    [[nodiscard]] int heightForWidth(int width) const override;

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    [[nodiscard]] int columns(int width) const;
    void drawHorn(QPainter& painter, const QRectF& box, std::size_t index) const;

    std::vector<SimulatedServo> servos_;
    std::vector<int> channels_;
    int first_ = 0;
};

} // namespace lumorph::studio
