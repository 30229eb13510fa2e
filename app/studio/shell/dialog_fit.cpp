#include "app/studio/shell/dialog_fit.h"

#include <algorithm>

#include <QDialogButtonBox>
#include <QFileDialog>
#include <QLayout>
#include <QScreen>
#include <QScrollArea>
#include <QScrollBar>
#include <QTimer>
#include <QVBoxLayout>

namespace lumorph::studio {
namespace {

constexpr QMargins kFrameAround{4, 36, 4, 4}; // what a desktop puts around a window

/// What is in it moves into an area that scrolls; its row of buttons stays in sight below that.
void makeScroll(QDialog& dialog) {
    QLayout* contents = dialog.layout();
    auto* buttons = dialog.findChild<QDialogButtonBox*>(QString(), Qt::FindDirectChildrenOnly);
    const QMargins margins = contents->contentsMargins();
    if (buttons != nullptr) contents->removeWidget(buttons);
    auto* inner = new QWidget;
    inner->setLayout(contents); // with all that is in it
    auto* area = new QScrollArea(&dialog);
    area->setObjectName("dialog.scroll");
    area->setWidgetResizable(true);
    area->setFrameShape(QFrame::NoFrame);
    area->setFocusPolicy(Qt::NoFocus);
    area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    area->setWidget(inner);
    area->setMinimumWidth(inner->minimumSizeHint().width() + area->verticalScrollBar()->sizeHint().width());
    auto* column = new QVBoxLayout(&dialog);
    column->setContentsMargins(0, 0, 0, 0);
    column->addWidget(area, 1);
    if (buttons == nullptr) return;
    buttons->setParent(&dialog);
    auto* row = new QHBoxLayout;
    row->setContentsMargins(margins.left(), 0, margins.right(), margins.bottom());
    row->addWidget(buttons);
    column->addLayout(row);
    buttons->show();
}

/// Lines that wrap need more height in a narrow dialog than its hint says.
int heightFor(const QLayout& layout, int width) {
    const int hint = layout.totalMinimumSize().height();
    return layout.hasHeightForWidth() ? std::max(hint, layout.totalHeightForWidth(width)) : hint;
}

void bringOnScreen(QDialog& dialog) {
    const QRect there = dialog.screen()->availableGeometry();
    const QRect outer = dialog.frameGeometry();
    if (there.contains(outer)) return;
    dialog.move(std::clamp(outer.left(), there.left(), std::max(there.left(), there.right() + 1 - outer.width())),
                std::clamp(outer.top(), there.top(), std::max(there.top(), there.bottom() + 1 - outer.height())));
}

} // namespace

void fitDialog(QDialog& dialog) {
    if (dialog.layout() == nullptr) return;
    const QSize room = dialog.screen()->availableGeometry().marginsRemoved(kFrameAround).size();
    dialog.ensurePolished();
    dialog.layout()->activate();
    const int width = std::min(dialog.width(), room.width());
    const int needed = heightFor(*dialog.layout(), width);
    const bool ownScroll =
        qobject_cast<QFileDialog*>(&dialog) != nullptr || dialog.findChild<QScrollArea*>("dialog.scroll");
    if (needed > room.height() && !ownScroll) {
        makeScroll(dialog);
        dialog.setMinimumSize(0, 0);
        dialog.layout()->activate();
    }
    dialog.resize(QSize(width, std::max(dialog.height(), needed)).expandedTo(dialog.minimumSizeHint()).boundedTo(room));
    QTimer::singleShot(0, &dialog, [&dialog] { bringOnScreen(dialog); }); // the desktop has put it somewhere by then
}

} // namespace lumorph::studio
