#include "app/workspaces/scene/color_field.h"

#include <QColorDialog>
#include <QPainter>
#include <QSpinBox>

#include "app/studio/look/palette.h"

namespace lumorph::studio {

namespace {

constexpr int kPatch = 18;
constexpr int kColorMargin = 6;
constexpr int kNumberWidth = 72;

} // namespace

ColorField::ColorField(QWidget* parent) : QPushButton(parent) {
    setProperty("look", "color");
    connect(this, &QPushButton::clicked, this, &ColorField::choose);
    setColor(Qt::white);
}

void ColorField::setColor(const QColor& color) {
    color_ = color;
    setText(color.name().toUpper());
    update();
}

/// Without blocking: STOP stays in reach.
void ColorField::choose() {
    auto* dialog = new QColorDialog(color_, this);
    dialog->setObjectName("dialog.color");
    dialog->setWindowTitle(accessibleName());
    dialog->setOption(QColorDialog::DontUseNativeDialog);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    for (auto* number : dialog->findChildren<QSpinBox*>()) number->setMinimumWidth(kNumberWidth); // else cut off
    connect(dialog, &QColorDialog::currentColorChanged, this, [this](const QColor& color) {
        setColor(color);
        emit previewed(color);
    });
    connect(dialog, &QColorDialog::accepted, this, [this, dialog] {
        setColor(dialog->currentColor());
        emit committed(dialog->currentColor());
    });
    connect(dialog, &QColorDialog::rejected, this, &ColorField::reverted);
    dialog->open();
}

void ColorField::paintEvent(QPaintEvent* event) {
    QPushButton::paintEvent(event);
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    QColor shown = color_;
    if (!isEnabled()) shown.setAlpha(90);
    painter.setPen(currentPalette().border);
    painter.setBrush(shown);
    painter.drawRoundedRect(QRectF(kColorMargin + 0.5, (height() - kPatch) / 2 + 0.5, 2 * kPatch - 1, kPatch - 1), 3,
                            3);
}

} // namespace lumorph::studio
