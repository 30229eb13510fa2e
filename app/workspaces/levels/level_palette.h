#pragma once

#include <QButtonGroup>
#include <QWidget>

#include "app/workspaces/levels/level_draft.h"

namespace lumorph::studio {

/// The pieces of a level as buttons, one of which is chosen; arrow keys go from one to the next.
class LevelPalette : public QWidget {
    Q_OBJECT
public:
    explicit LevelPalette(QWidget* parent = nullptr);
    void choose(const LevelPiece& piece);

signals:
    void chosen(const lumorph::studio::LevelPiece& piece);

private:
    QButtonGroup* buttons_;
};

} // namespace lumorph::studio
