#include "app/workspaces/devices/device_card.h"

#include <QApplication>
#include <QHBoxLayout>
#include <QPainter>
#include <QVBoxLayout>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

constexpr int kCardHeight = 80; ///< the same whatever it says, so that rows do not jump under the pointer

QColor stripeOf(DeviceCard::Tone tone) {
    const Palette& colors = currentPalette();
    switch (tone) {
    case DeviceCard::Tone::live:
        return colors.accent;
    case DeviceCard::Tone::warning:
        return colors.warning;
    case DeviceCard::Tone::failure:
        return colors.danger;
    case DeviceCard::Tone::quiet:
        break;
    }
    return colors.border;
}

std::pair<QString, IconRole> toneIcon(DeviceCard::Tone tone) {
    switch (tone) {
    case DeviceCard::Tone::live:
        return {"live", IconRole::accent};
    case DeviceCard::Tone::warning:
        return {"warning", IconRole::warning};
    case DeviceCard::Tone::failure:
        return {"error", IconRole::danger};
    case DeviceCard::Tone::quiet:
        break;
    }
    return {"device", IconRole::muted};
}

} // namespace

DeviceCardWidget::DeviceCardWidget(QWidget* parent)
    : QFrame(parent), icon_(new IconLabel("device", IconRole::muted, 28, this)), title_(new QLabel(this)),
      text_(new QLabel(this)), next_(new QPushButton(this)) {
    setObjectName("devices.card");
    setProperty("look", "card");
    setMinimumHeight(kCardHeight);
    title_->setObjectName("devices.card.title");
    title_->setProperty("look", "title");
    text_->setObjectName("devices.card.text");
    for (QLabel* label : {title_, text_}) {
        label->setTextFormat(Qt::PlainText);
        label->setWordWrap(true);
        label->setTextInteractionFlags(Qt::TextSelectableByMouse);
    }
    next_->setObjectName("devices.next");
    next_->setProperty("look", "primary");
    next_->setMinimumHeight(36);
    next_->setToolTip("The next step (Ctrl+Return)");
    auto* texts = new QVBoxLayout;
    texts->setSpacing(4);
    texts->addStretch(1);
    texts->addWidget(title_);
    texts->addWidget(text_);
    texts->addStretch(1);
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(20, 12, 16, 12);
    row->setSpacing(16);
    row->addWidget(icon_);
    row->addLayout(texts, 1);
    row->addWidget(next_);
    connect(next_, &QPushButton::clicked, this, &DeviceCardWidget::onClicked);
}

/// The second click of a double click is not meant for the step that came up under it.
void DeviceCardWidget::onClicked() {
    const bool again = sinceClick_.isValid() && sinceClick_.elapsed() < QApplication::doubleClickInterval();
    sinceClick_.start();
    if (!again) emit nextWanted();
}

void DeviceCardWidget::show(const DeviceCard& card) {
    if (card == card_) return;
    card_ = card;
    const auto [name, role] = toneIcon(card.tone);
    icon_->setIcon(name, role);
    title_->setText(card.title);
    text_->setText(card.text);
    text_->setVisible(!card.text.isEmpty());
    next_->setText(card.button);
    next_->setVisible(!card.button.isEmpty());
    update();
}

void DeviceCardWidget::paintEvent(QPaintEvent* event) {
    QFrame::paintEvent(event);
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(Qt::NoPen);
    painter.setBrush(stripeOf(card_.tone));
    painter.drawRoundedRect(QRectF(0, 0, 4, height()), 2.0, 2.0);
}

} // namespace lumorph::studio
