#pragma once

#include <QAbstractButton>
#include <QLabel>

#include "core/rig/rig_check.h"

namespace lumorph::studio {

/// One thing that is wrong with the rig, to be clicked: what and where it begins, and, while it is chosen, what to do.
class FindingRow : public QAbstractButton {
    Q_OBJECT
public:
    FindingRow(const RigFinding& finding, QWidget* parent);

protected:
    void paintEvent(QPaintEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void checkStateSet() override;
    void nextCheckState() override;

private:
    QLabel* remedy_;
};

} // namespace lumorph::studio
