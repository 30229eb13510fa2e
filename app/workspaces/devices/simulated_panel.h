#pragma once

#include <functional>
#include <memory>
#include <vector>

#include <QCheckBox>
#include <QLabel>
#include <QPushButton>
#include <QSlider>
#include <QWidget>

#include "devices/trackers/simulated_orders.h"

namespace lumorph::studio {

/// How well a simulated tracker sees, to order, and ways to break it on purpose.
class SimulatedPanel : public QWidget {
public:
    /// Its parts are named "NAME.noise", "NAME.teleport" and so on.
    SimulatedPanel(std::shared_ptr<SimulatedSteering> steering, const QString& name, QWidget* parent = nullptr);
    /// Shows what is ordered now.
    void refresh();

private:
    struct Row {
        double SimulatedOrders::*order;
        double scale; ///< of one step of the slider, in the order's unit
        double shown; ///< of the order's unit, in the unit shown
        QString unit;
        QSlider* slider;
        QLabel* value;
    };
    void change(const std::function<void(SimulatedOrders&)>& edit);

    std::shared_ptr<SimulatedSteering> steering_;
    std::vector<Row> rows_;
    QCheckBox* hidden_ = nullptr;
    QPushButton* release_ = nullptr;
};

} // namespace lumorph::studio
