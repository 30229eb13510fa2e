#pragma once

#include <QLabel>

#include "app/studio/widgets/floating_card.h"
#include "core/loop/match_frame.h"

namespace lumorph::studio {

/// The match at a glance, over the viewport: the IoU large, and what the two colours on the model mean.
/// Numbers are "field.iou", "field.unmatched" and "field.overfilled".
class FitReadout : public FloatingCard {
    Q_OBJECT
public:
    explicit FitReadout(QWidget* parent = nullptr);
    /// Hidden while nothing is matched.
    void show(const MatchFrame& frame);
    using QWidget::show;
    /// The IoU alone, for a small view.
    void setCompact(bool compact);

private:
    QLabel* iou_;
    QLabel* unmatched_;
    QLabel* overfilled_;
    QWidget* volumes_ = nullptr;
};

} // namespace lumorph::studio
