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
    void show(const LinkStatus& link);

private:
    std::vector<QLabel*> values_;
    QLabel* failsafe_;
};

} // namespace lumorph::studio
