#pragma once

#include <QLabel>
#include <QWidget>

#include "core/loop/match_frame.h"

namespace lumorph::studio {

/// How well the device fits the target: the IoU large, the steps to it, and the volumes that do not fit. Numbers are
/// "match.iou", "match.iou.voting", "match.iou.wanted", "match.iou.reached", "match.unmatched" and
/// "match.overfilled"; "match.word", "match.rest" and "match.bound" say it in words.
class MatchNumbers : public QWidget {
    Q_OBJECT
public:
    explicit MatchNumbers(QWidget* parent = nullptr);
    /// A dash everywhere while nothing is matched; and for refinement unless the levels come from there.
    void show(const MatchFrame& frame, bool refined);
    /// A sentence on how much better it could be; empty: not known.
    void showBound(const QString& sentence);
    using QWidget::show;

private:
    QLabel* iou_ = nullptr;
    QLabel* word_ = nullptr; ///< "good", "fair" or "poor"
    QLabel* rest_ = nullptr; ///< where the rest of the target is lost
    QLabel* bound_ = nullptr;
    QLabel* voting_ = nullptr;
    QLabel* wanted_ = nullptr;
    QLabel* reached_ = nullptr;
    QLabel* unmatched_ = nullptr;
    QLabel* overfilled_ = nullptr;
};

/// A square in the colour of unmatched or overfilled volume, in any theme.
[[nodiscard]] QWidget* makeChip(bool unmatched, QWidget* parent);

} // namespace lumorph::studio
