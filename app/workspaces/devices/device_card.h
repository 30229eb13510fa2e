#pragma once

#include <functional>

#include <QElapsedTimer>
#include <QFrame>
#include <QLabel>
#include <QPushButton>

#include "app/studio/widgets/icon_label.h"
#include "app/workspaces/devices/device_words.h"

namespace lumorph::studio {

/// The card over the servos: what the state is, and the next step as its one accent button.
class DeviceCardWidget : public QFrame {
    Q_OBJECT
public:
    explicit DeviceCardWidget(QWidget* parent);
    void show(const DeviceCard& card);

signals:
    void nextWanted();

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    void onClicked();

    DeviceCard card_;
    QElapsedTimer sinceClick_;
    IconLabel* icon_;
    QLabel* title_;
    QLabel* text_;
    QPushButton* next_;
};

} // namespace lumorph::studio
