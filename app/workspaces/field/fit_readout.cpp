#include "app/workspaces/field/fit_readout.h"

#include <QGridLayout>
#include <QVBoxLayout>

#include "app/studio/widgets/dock_parts.h"
#include "app/workspaces/field/match_numbers.h"

namespace lumorph::studio {

FitReadout::FitReadout(QWidget* parent)
    : FloatingCard(parent), iou_(new QLabel(this)), unmatched_(makeNumber("field.unmatched", "0000 cm³", this)),
      overfilled_(makeNumber("field.overfilled", "0000 cm³", this)) {
    setObjectName("field.readout");
    setSizePolicy(QSizePolicy::Maximum, QSizePolicy::Maximum);
    iou_->setObjectName("field.iou");
    makeLarge(iou_, 36, "0.00");
    auto* unit = new QLabel("IoU", this);
    unit->setProperty("look", "muted");
    unit->setToolTip("Intersection over union of the target and the volume that the device covers: 1 is a perfect fit");
    unit->setContentsMargins(0, 0, 0, 5); // onto the number's line
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(16, 8, 16, 12);
    column->setSpacing(4);
    volumes_ = new QWidget(this);
    auto* grid = new QGridLayout(volumes_);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setHorizontalSpacing(8);
    grid->setVerticalSpacing(4);
    auto* top = new QHBoxLayout;
    top->setSpacing(8);
    top->addWidget(iou_);
    top->addWidget(unit, 0, Qt::AlignBottom);
    top->addStretch(1);
    column->addLayout(top);
    column->addWidget(volumes_);
    const auto chip = [&](int row, bool unmatched, const QString& text, const QString& hint, QLabel* number) {
        auto* label = new QLabel(text, volumes_);
        label->setToolTip(hint);
        grid->addWidget(makeChip(unmatched, volumes_), row, 0, Qt::AlignVCenter);
        grid->addWidget(label, row, 1);
        grid->addWidget(number, row, 2);
    };
    chip(1, true, "unmatched", "This colour on the target: volume that the device leaves out", unmatched_);
    chip(2, false, "overfilled", "This colour on the device: volume outside the target", overfilled_);
    hide();
}

void FitReadout::setCompact(bool compact) { volumes_->setVisible(!compact); }

void FitReadout::show(const MatchFrame& frame) {
    const bool ofTarget = frame.matched && frame.driver != Driver::dance;
    setVisible(ofTarget);
    if (!ofTarget) return;
    iou_->setText(QString::number(frame.iouWanted, 'f', 2));
    unmatched_->setText(volumeText(frame.unmatchedVolume));
    overfilled_->setText(volumeText(frame.overfilledVolume));
}

} // namespace lumorph::studio
