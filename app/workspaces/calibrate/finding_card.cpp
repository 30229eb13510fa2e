#include "app/workspaces/calibrate/finding_card.h"

#include <utility>

#include <QFrame>
#include <QHBoxLayout>
#include <QLabel>
#include <QVBoxLayout>

#include "app/studio/widgets/icon_label.h"

namespace lumorph::studio {

QWidget* makeFindingCard(const FindingWords& words, bool isRefusal, QWidget* parent) {
    auto* card = new QFrame(parent);
    card->setProperty("look", "card");
    auto* row = new QHBoxLayout(card);
    row->setContentsMargins(12, 8, 12, 8);
    row->setSpacing(8);
    row->addWidget(
        new IconLabel(isRefusal ? "error" : "warning", isRefusal ? IconRole::danger : IconRole::warning, 20, card), 0,
        Qt::AlignTop);
    auto* texts = new QVBoxLayout;
    texts->setSpacing(2);
    const std::pair<QString, const char*> lines[] = {
        {words.title, "heading"}, {words.text, ""}, {words.remedy, "muted"}};
    for (const auto& [line, look] : lines) {
        if (line.isEmpty()) continue;
        auto* label = new QLabel(line, card);
        label->setTextFormat(Qt::PlainText);
        label->setProperty("look", look);
        label->setWordWrap(true);
        label->setTextInteractionFlags(Qt::TextSelectableByMouse);
        texts->addWidget(label);
    }
    row->addLayout(texts, 1);
    return card;
}

} // namespace lumorph::studio
