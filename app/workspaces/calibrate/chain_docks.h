#pragma once

#include <vector>

#include <QWidget>

#include "app/studio/calibration/chain.h"
#include "app/workspaces/calibrate/calibrate_docks.h"

namespace lumorph::studio {

// The whole chain beside the sequence of projector and camera: its links, the chosen one, and what that came to.
[[nodiscard]] QWidget* makeChainLinks(const CalibrateParts& parts);
[[nodiscard]] QWidget* makeChainView(const CalibrateParts& parts);
[[nodiscard]] QWidget* makeChainResult(const CalibrateParts& parts);

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
