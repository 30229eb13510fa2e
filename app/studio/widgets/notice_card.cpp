#include "app/studio/widgets/notice_card.h"

#include <QLabel>
#include <QPainter>
#include <QPushButton>
#include <QToolButton>
#include <QVBoxLayout>

#include "app/studio/look/palette.h"
#include "app/studio/widgets/icon_label.h"

namespace lumorph::studio {
namespace {

struct LevelLook {
    QString icon;
    IconRole role;
};

LevelLook lookOf(Notice::Level level) {
    switch (level) {
    case Notice::Level::info:
        return {"info", IconRole::accent};
    case Notice::Level::warning:
        return {"warning", IconRole::warning};
    case Notice::Level::error:
        return {"error", IconRole::danger};
    }
    return {"info", IconRole::accent};
}

QLabel* makeText(const QString& text, const char* look, QWidget* parent) {
    auto* label = new QLabel(text, parent);
    label->setTextFormat(Qt::PlainText); // a file's name is no markup
    label->setWordWrap(true);
    label->setTextInteractionFlags(Qt::TextSelectableByMouse);
    if (look != nullptr) label->setProperty("look", look);
    return label;
}

/// Errors are worded as parts of one sentence; on a card each has a line of its own.
QString capitalised(QString text) {
    if (!text.isEmpty()) text[0] = text[0].toUpper();
    return text;
}

/// A card with a stripe in the colour of its level at the left edge.
class Card : public QFrame {
public:
    Card(Notice::Level level, QWidget* parent) : QFrame(parent), level_(level) { setProperty("look", "card"); }

protected:
    void paintEvent(QPaintEvent* event) override {
        QFrame::paintEvent(event);
        const Palette& colors = currentPalette();
        QPainter painter(this);
        painter.setRenderHint(QPainter::Antialiasing);
        painter.setPen(Qt::NoPen);
        painter.setBrush(level_ == Notice::Level::error     ? colors.danger
                         : level_ == Notice::Level::warning ? colors.warning
                                                            : colors.accent);
        painter.drawRoundedRect(QRectF(0, 0, 3, height()), 1.5, 1.5);
    }

private:
    Notice::Level level_;
};

/// The buttons may outlive the card's place in the list: what they do is done after the card is gone.
void addButtons(QHBoxLayout* row, Notices& notices, const QString& place, const Notice& notice, QWidget* card) {
    int index = 0;
    for (const Notice::Action& action : notice.actions) {
        auto* button = new QPushButton(action.text, card);
        button->setObjectName("notice.action." + QString::number(index));
        if (index++ == 0) button->setProperty("look", "primary");
        QObject::connect(button, &QPushButton::clicked, &notices,
                         [&notices, place, subject = notice.subject, run = action.run] {
                             notices.dismiss(place, subject);
                             if (run) run();
                         });
        row->addWidget(button);
    }
    row->addStretch(1);
}

} // namespace

QWidget* makeNoticeCard(Notices& notices, const QString& place, const Notice& notice, const QString& heading,
                        QWidget* parent, bool dismissible) {
    auto* card = new Card(notice.level, parent);
    card->setObjectName("notice");
    auto* row = new QHBoxLayout(card);
    row->setContentsMargins(12, 8, 8, 8);
    row->setSpacing(8);
    const LevelLook look = lookOf(notice.level);
    row->addWidget(new IconLabel(look.icon, look.role, 18, card), 0, Qt::AlignTop);
    auto* texts = new QVBoxLayout;
    texts->setSpacing(4);
    if (!heading.isEmpty()) texts->addWidget(makeText(heading, "muted", card));
    texts->addWidget(makeText(notice.subject, "heading", card));
    if (!notice.why.isEmpty()) texts->addWidget(makeText(capitalised(notice.why), nullptr, card));
    if (!notice.remedy.isEmpty()) texts->addWidget(makeText(capitalised(notice.remedy), "muted", card));
    if (!notice.actions.empty()) {
        auto* buttons = new QHBoxLayout;
        buttons->setContentsMargins(0, 4, 0, 0);
        buttons->setSpacing(8);
        addButtons(buttons, notices, place, notice, card);
        texts->addLayout(buttons);
    }
    row->addLayout(texts, 1);
    if (!dismissible) return card;
    auto* close = new QToolButton(card);
    close->setObjectName("notice.dismiss");
    close->setIcon(icon("close", IconRole::muted));
    close->setToolTip("Dismiss");
    close->setAccessibleName("Dismiss");
    QObject::connect(close, &QToolButton::clicked, &notices,
                     [&notices, place, subject = notice.subject] { notices.dismiss(place, subject); });
    row->addWidget(close, 0, Qt::AlignTop);
    return card;
}

} // namespace lumorph::studio
