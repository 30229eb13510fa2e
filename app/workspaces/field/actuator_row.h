#pragma once

#include <QLabel>
#include <QWidget>

#include "app/studio/document/hand_control.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/field/actuator_scale.h"
#include "app/workspaces/field/level_slider.h"

namespace lumorph::studio {

/// Name, level, value and slider of one actuator.
class ActuatorRow : public QWidget {
    Q_OBJECT
public:
    /// Of actuator `index` of a rig, with so many levels. Controls are named "actuators.slider.NAME",
    /// "actuators.value.NAME" and "actuators.level.NAME".
    ActuatorRow(HandControl& hand, const QString& name, std::size_t index, const Actuator& actuator, int levels,
                QWidget* parent = nullptr);

    void show(double wanted, double estimated);
    using QWidget::show;
    void setLive(bool live) { slider_->setLive(live); }

private:
    void arrange();
    void describe(const QString& actuator);
    void connectControls(HandControl& hand);
    [[nodiscard]] double strokeOf(int level) const { return static_cast<double>(level) / slider_->maximum(); }

    std::size_t index_;
    ActuatorScale scale_;
    QLabel* title_ = nullptr;
    QLabel* level_ = nullptr;
    ValueField* value_ = nullptr;
    LevelSlider* slider_ = nullptr;
};

} // namespace lumorph::studio
