#pragma once

#include <vector>

#include <QWidget>

#include "app/studio/calibration/chain.h"

namespace lumorph::studio {

/// A bar for each point: how far it lies beside. Those that the fit never saw stand first, in the accent colour.
class PointBars : public QWidget {
    Q_OBJECT
public:
    explicit PointBars(QWidget* parent = nullptr);
    void show(std::vector<LinkPoint> points);
    [[nodiscard]] QSize sizeHint() const override;
    [[nodiscard]] QSize minimumSizeHint() const override { return sizeHint(); }

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    std::vector<LinkPoint> points_;
};

} // namespace lumorph::studio
