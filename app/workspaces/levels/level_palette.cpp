#include "app/workspaces/levels/level_palette.h"

#include <QGridLayout>
#include <QToolButton>

#include "app/studio/widgets/panel.h"
#include "app/workspaces/levels/level_painter.h"

namespace lumorph::studio {
namespace {

constexpr int kColumns = 4;

/// Where groups of pieces begin, with what stands over them.
const char* headingOf(const LevelPiece& piece, const LevelPiece* before) {
    if (!before) return "Ground";
    if (piece.kind == before->kind) return nullptr;
    switch (piece.kind) {
    case LevelPiece::Kind::ramp:
        return "Ramps, uphill";
    case LevelPiece::Kind::stairs:
        return "Stairs, uphill";
    case LevelPiece::Kind::bridge:
        return "Bridges";
    case LevelPiece::Kind::pickUp:
        return "Pick-ups";
    case LevelPiece::Kind::start:
        return "Start and goal";
    default:
        return nullptr;
    }
}

QToolButton* makeButton(const OfferedPiece& offered) {
    auto* button = new QToolButton;
    button->setObjectName(QString("levels.piece.%1").arg(QString(offered.name).toLower().replace(' ', '-')));
    button->setIcon(pieceIcon(offered.piece));
    button->setIconSize({28, 28});
    button->setFixedSize(40, 38);
    button->setCheckable(true);
    button->setAccessibleName(QObject::tr(offered.name));
    button->setToolTip(QObject::tr("%1 (%2)").arg(QObject::tr(offered.name)).arg(QChar(offered.sign)));
    return button;
}

} // namespace

LevelPalette::LevelPalette(QWidget* parent) : QWidget(parent), buttons_(new QButtonGroup(this)) {
    auto* grid = new QGridLayout(this);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setSpacing(4);
    int row = 0, column = 0, id = 0;
    const LevelPiece* before = nullptr;
    for (const OfferedPiece& offered : offeredPieces()) {
        if (const char* heading = headingOf(offered.piece, before)) {
            grid->addWidget(makeHeading(tr(heading)), ++row, 0, 1, kColumns);
            ++row;
            column = 0;
        }
        if (column == kColumns) {
            column = 0;
            ++row;
        }
        QToolButton* button = makeButton(offered);
        buttons_->addButton(button, id++);
        grid->addWidget(button, row, column++);
        before = &offered.piece;
    }
    grid->setRowStretch(row + 1, 1);
    grid->setColumnStretch(kColumns, 1);
    connect(buttons_, &QButtonGroup::idClicked, this,
            [this](int chosenId) { emit chosen(offeredPieces()[static_cast<std::size_t>(chosenId)].piece); });
}

void LevelPalette::choose(const LevelPiece& piece) {
    const auto found = std::ranges::find(offeredPieces(), piece, &OfferedPiece::piece);
    if (found == offeredPieces().end()) return;
    buttons_->button(static_cast<int>(found - offeredPieces().begin()))->setChecked(true);
}

} // namespace lumorph::studio
