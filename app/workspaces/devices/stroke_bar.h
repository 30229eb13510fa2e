#pragma once

#include <QWidget>

#include "devices/controllers/servo_link.h"

namespace lumorph::studio {

/// Where one servo is: filled up to what it was sent, a ring where it is wanted, a line where it says it is.
class StrokeBar : public QWidget {
    Q_OBJECT
public:
    explicit StrokeBar(QWidget* parent = nullptr);
    void show(const ServoStatus& servo);
    [[nodiscard]] const ServoStatus& shown() const noexcept { return servo_; }
    [[nodiscard]] QSize sizeHint() const override;
    [[nodiscard]] QSize minimumSizeHint() const override;

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    ServoStatus servo_;
};

/// The three marks of the bars with their words.
[[nodiscard]] QWidget* makeStrokeLegend(QWidget* parent);

} // namespace lumorph::studio
