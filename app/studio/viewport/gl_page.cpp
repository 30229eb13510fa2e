#include "app/studio/viewport/gl_page.h"

#include <algorithm>
#include <cmath>

#include <QBoxLayout>
#include <QFontInfo>
#include <QPainter>
#include <QPushButton>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

constexpr int kTextWidth = 440;
constexpr int kPageMargin = 24;

QLabel* label(const QString& text, double size, QFont::Weight weight) {
    auto* made = new QLabel(text);
    QFont font = made->font();
    font.setPixelSize(static_cast<int>(std::lround(QFontInfo(font).pixelSize() * size)));
    font.setWeight(weight);
    made->setFont(font);
    made->setWordWrap(true);
    made->setTextInteractionFlags(Qt::TextSelectableByMouse);
    return made;
}

} // namespace

GlPage::GlPage(std::function<void()> retry, QWidget* parent) : QWidget(parent) {
    setObjectName(QStringLiteral("viewport.failure"));
    title_ = label(tr("The 3D view cannot be drawn here"), 1.4, QFont::DemiBold);
    reason_ = label({}, 1.0, QFont::Normal);
    reason_->setObjectName(QStringLiteral("viewport.failure.reason"));
    rest_ = label(tr("Everything else in this window works."), 1.0, QFont::Normal);
    auto* button = new QPushButton(tr("Try again"));
    button->setObjectName(QStringLiteral("viewport.retry"));
    connect(button, &QPushButton::clicked, this, [retry = std::move(retry)] { retry(); });

    auto* column = new QVBoxLayout;
    column->setSpacing(8);
    column->addWidget(title_);
    column->addWidget(reason_);
    column->addWidget(rest_);
    column->addSpacing(8);
    column->addWidget(button, 0, Qt::AlignLeft);
    auto* across = new QHBoxLayout;
    across->addStretch(1);
    across->addLayout(column);
    across->addStretch(1);
    auto* down = new QVBoxLayout(this);
    down->setContentsMargins(kPageMargin, kPageMargin, kPageMargin, kPageMargin);
    down->addStretch(2);
    down->addLayout(across);
    down->addStretch(3);
}

void GlPage::setReason(const QString& why) { reason_->setText(why); }

void GlPage::resizeEvent(QResizeEvent* /*event*/) {
    // Labels that wrap know their height only for a width that is settled.
    for (QLabel* text : {title_, reason_, rest_})
        text->setFixedWidth(std::clamp(width() - 2 * kPageMargin, 60, kTextWidth));
}

void GlPage::paintEvent(QPaintEvent* /*event*/) { QPainter(this).fillRect(rect(), currentPalette().window); }

} // namespace lumorph::studio
