#include "app/workspaces/field/actuator_row.h"

#include <algorithm>

#include <QBoxLayout>
#include <QSignalBlocker>

namespace lumorph::studio {

ActuatorRow::ActuatorRow(HandControl& hand, const QString& name, std::size_t index, const Actuator& actuator,
                         int levels, QWidget* parent)
    : QWidget(parent), index_(index), scale_(scaleOf(actuator)), title_(new QLabel(this)), level_(new QLabel(this)),
      value_(new ValueField(scale_.quantity, std::min(scale_.atRest, scale_.atEnd),
                            std::max(scale_.atRest, scale_.atEnd), scale_.atRest, this)),
      slider_(new LevelSlider(this)) {
    level_->setObjectName("actuators.level." + name);
    value_->setObjectName("actuators.value." + name);
    slider_->setObjectName("actuators.slider." + name);
    slider_->setLevels(levels);
    arrange();
    describe(QString::fromStdString(actuator.name));
    connectControls(hand);
}

void ActuatorRow::arrange() {
    title_->setTextFormat(Qt::PlainText);
    title_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    title_->setBuddy(slider_);
    level_->setProperty("look", "muted");
    level_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
    level_->setMinimumWidth(level_->fontMetrics().horizontalAdvance("level 200"));
    value_->setFixedWidth(80);
    auto* top = new QHBoxLayout;
    top->setSpacing(8);
    top->addWidget(title_, 1);
    top->addWidget(level_);
    top->addWidget(value_);
    auto* rows = new QVBoxLayout(this);
    rows->setContentsMargins(0, 0, 0, 0);
    rows->setSpacing(0);
    rows->addLayout(top);
    rows->addWidget(slider_);
    setTabOrder(slider_, value_);
}

void ActuatorRow::connectControls(HandControl& hand) {
    connect(slider_, &LevelSlider::previewed, this,
            [this, &hand](int level) { hand.preview(index_, strokeOf(level)); });
    connect(slider_, &LevelSlider::committed, this, [this, &hand](int level) { hand.commit(index_, strokeOf(level)); });
    connect(slider_, &LevelSlider::reverted, this, [&hand] { hand.cancel(); });
    connect(value_, &ValueField::previewed, this,
            [this, &hand](double value) { hand.preview(index_, scale_.strokeOf(value)); });
    connect(value_, &ValueField::committed, this,
            [this, &hand](double value) { hand.commit(index_, scale_.strokeOf(value)); });
    connect(value_, &ValueField::reverted, this, [&hand] { hand.cancel(); });
}

void ActuatorRow::describe(const QString& actuator) {
    title_->setText(actuator);
    slider_->setAccessibleName(actuator);
    slider_->setToolTip(
        QString("Level of %1. The thin mark is where it is by now: servos take their time.").arg(actuator));
    value_->setAccessibleName(actuator + " value");
    value_->setToolTip("Type a value, or drag sideways. A double click brings it back to rest.");
}

void ActuatorRow::show(double wanted, double estimated) {
    slider_->show(wanted, estimated);
    level_->setText(QString("level %1").arg(nearestLevel(wanted, slider_->maximum() + 1)));
    value_->setValue(scale_.valueOf(wanted));
}

} // namespace lumorph::studio
