#pragma once

#include <QAbstractButton>
#include <QLabel>
#include <QPushButton>

#include "app/workspaces/devices/stroke_bar.h"
#include "devices/controllers/device_profile.h"

namespace lumorph::studio {

/// One servo, large and live: name, channel, bar, pulse, what it does, and a button that wiggles it. Checked while it
/// is the chosen one.
class ServoRow : public QAbstractButton {
    Q_OBJECT
public:
    ServoRow(std::size_t servo, const QString& name, QWidget* parent);

    void show(const LinkStatus& link, const ServoSetup& setup, bool tested, double wanted);
    [[nodiscard]] QSize sizeHint() const override;

signals:
    void wiggled();

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    std::size_t servo_;
    QLabel* channel_;
    StrokeBar* bar_;
    QLabel* pulse_;
    QLabel* word_;
    QPushButton* wiggle_;
};

} // namespace lumorph::studio
