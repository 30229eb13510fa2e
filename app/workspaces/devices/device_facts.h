#pragma once

#include <vector>

#include <QLabel>
#include <QWidget>

#include "devices/controllers/servo_link.h"

namespace lumorph::studio {

/// What is known of the board and the link, as a tidy grid of names and numbers.
class DeviceFacts : public QWidget {
    Q_OBJECT
public:
    explicit DeviceFacts(QWidget* parent);
    /// `stopKeysProblem`: why Esc Esc is not heard everywhere; may be empty.
    void show(const LinkStatus& link, const QString& stopKeysProblem);

private:
    std::vector<QLabel*> values_;
    QLabel* failsafe_;
    QLabel* stopKeys_;
};

} // namespace lumorph::studio
