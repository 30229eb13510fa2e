#include "app/studio/widgets/range_row.h"

#include <cmath>

#include <QHBoxLayout>
#include <QLabel>

namespace lumorph::studio {
namespace {

constexpr int kFieldWidth = 44;
constexpr int kLabelWidth = 48;

ValueField* endField(const QString& id, const QString& name) {
    auto* field = new ValueField(Quantity::level, 0, 1, 0);
    field->setObjectName(id);
    field->setAccessibleName(name);
    field->setFixedWidth(kFieldWidth);
    field->setStep(1.0);
    return field;
}

int whole(double value) { return static_cast<int>(std::lround(value)); }

} // namespace

RangeRow::RangeRow(const QString& id, const QString& label, const QString& name, QWidget* parent)
    : QWidget(parent), from_(endField(id + ".from", tr("%1 from").arg(name))), slider_(new RangeSlider),
      to_(endField(id + ".to", tr("%1 to").arg(name))) {
    slider_->setObjectName(id + ".slider");
    slider_->setAccessibleName(name);
    auto* text = new QLabel(label);
    text->setBuddy(from_);
    text->setMinimumWidth(kLabelWidth);
    auto* layout = new QHBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(8);
    layout->addWidget(text);
    layout->addWidget(from_);
    layout->addWidget(slider_, 1);
    layout->addWidget(to_);
    setFocusProxy(from_);

    connect(slider_, &RangeSlider::changed, this, [this](int from, int to) {
        showValues();
        emit changed(from, to);
    });
    // A value typed beyond the other end takes that end along.
    const auto fromChanged = [this](double value) {
        slider_->setRange(whole(value), std::max(whole(value), slider_->to()));
        showValues();
        emit changed(slider_->from(), slider_->to());
    };
    const auto toChanged = [this](double value) {
        slider_->setRange(std::min(whole(value), slider_->from()), whole(value));
        showValues();
        emit changed(slider_->from(), slider_->to());
    };
    connect(from_, &ValueField::previewed, this, fromChanged);
    connect(from_, &ValueField::committed, this, fromChanged);
    connect(to_, &ValueField::previewed, this, toChanged);
    connect(to_, &ValueField::committed, this, toChanged);
}

void RangeRow::setLimits(int lowest, int highest) {
    from_->setRange(lowest, highest);
    to_->setRange(lowest, highest);
    slider_->setLimits(lowest, highest);
    showValues();
}

void RangeRow::setRange(int from, int to) {
    slider_->setRange(from, to);
    showValues();
}

void RangeRow::showValues() {
    from_->setValue(slider_->from());
    to_->setValue(slider_->to());
}

} // namespace lumorph::studio
