#include "app/workspaces/common/step_card.h"

#include <utility>

#include <QApplication>
#include <QHBoxLayout>
#include <QPainter>
#include <QStyle>
#include <QVBoxLayout>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

constexpr int kStepCardHeight = 88; // the same whatever it says, so that what is below does not jump
constexpr int kNarrow = 400;        // pixels; in less the button goes under the texts

QColor toneColor(StepCardText::Tone tone) {
    const Palette& colors = currentPalette();
    switch (tone) {
    case StepCardText::Tone::live:
        return colors.accent;
    case StepCardText::Tone::good:
        return colors.success;
    case StepCardText::Tone::warning:
        return colors.warning;
    case StepCardText::Tone::failure:
        return colors.danger;
    case StepCardText::Tone::quiet:
        break;
    }
    return colors.border;
}

} // namespace

StepCard::StepCard(const QString& name, const QString& icon, QWidget* parent)
    : QFrame(parent), quietIcon_(icon), icon_(new IconLabel(icon, IconRole::muted, 28, this)), title_(new QLabel(this)),
      text_(new QLabel(this)), next_(new QPushButton(this)) {
    setObjectName(name);
    setProperty("look", "card");
    setMinimumHeight(kStepCardHeight);
    title_->setObjectName(name + ".title");
    title_->setProperty("look", "title");
    text_->setObjectName(name + ".text");
    for (QLabel* label : {title_, text_}) {
        label->setTextFormat(Qt::PlainText);
        label->setWordWrap(true);
        label->setTextInteractionFlags(Qt::TextSelectableByMouse);
    }
    next_->setObjectName(name + ".next");
    next_->setProperty("look", "primary");
    next_->setMinimumHeight(36);
    auto* texts = new QVBoxLayout;
    texts->setSpacing(4);
    texts->addStretch(1);
    texts->addWidget(title_);
    texts->addWidget(text_);
    texts->addStretch(1);
    row_ = new QBoxLayout(QBoxLayout::LeftToRight, this);
    row_->setContentsMargins(20, 12, 16, 12);
    row_->setSpacing(16);
    row_->addWidget(icon_);
    row_->addLayout(texts, 1);
    row_->addWidget(next_);
    // The second click of a double click is not meant for the step that came up under it.
    connect(next_, &QPushButton::clicked, this, [this] {
        const bool again = sinceClick_.isValid() && sinceClick_.elapsed() < QApplication::doubleClickInterval();
        sinceClick_.start();
        if (!again) emit nextWanted();
    });
}

void StepCard::show(const StepCardText& text) {
    if (text == shown_) return;
    if (text.isButtonQuiet != shown_.isButtonQuiet) {
        next_->setProperty("look", text.isButtonQuiet ? "" : "primary");
        next_->style()->unpolish(next_);
        next_->style()->polish(next_);
    }
    shown_ = text;
    using Tone = StepCardText::Tone;
    switch (text.tone) {
    case Tone::live:
        icon_->setIcon("live", IconRole::accent);
        break;
    case Tone::good:
        icon_->setIcon("check", IconRole::accent);
        break;
    case Tone::warning:
        icon_->setIcon("warning", IconRole::warning);
        break;
    case Tone::failure:
        icon_->setIcon("error", IconRole::danger);
        break;
    case Tone::quiet:
        icon_->setIcon(quietIcon_, IconRole::muted);
    }
    title_->setText(text.title);
    text_->setText(text.text);
    text_->setVisible(!text.text.isEmpty());
    next_->setText(text.button);
    next_->setVisible(!text.button.isEmpty());
    update();
}

void StepCard::resizeEvent(QResizeEvent* event) {
    QFrame::resizeEvent(event);
    const bool isNarrow = width() < kNarrow;
    row_->setDirection(isNarrow ? QBoxLayout::TopToBottom : QBoxLayout::LeftToRight);
    row_->setSpacing(isNarrow ? 8 : 16);
    icon_->setVisible(!isNarrow);
}

void StepCard::paintEvent(QPaintEvent* event) {
    QFrame::paintEvent(event);
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(Qt::NoPen);
    painter.setBrush(toneColor(shown_.tone));
    painter.drawRoundedRect(QRectF(0, 0, 4, height()), 2.0, 2.0);
}

} // namespace lumorph::studio
