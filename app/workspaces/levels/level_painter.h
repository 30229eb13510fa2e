#pragma once

#include <optional>
#include <vector>

#include <QIcon>
#include <QPainter>
#include <QRectF>

#include "app/workspaces/levels/level_draft.h"

namespace lumorph::studio {

/// How a level lies on a page, seen from above.
struct LevelView {
    QPointF origin;     ///< of its first cell, pixels
    double side = 24.0; ///< of a cell, pixels

    [[nodiscard]] QRectF boxOf(glm::ivec2 cell) const {
        return {origin.x() + side * cell.x, origin.y() + side * cell.y, side, side};
    }
    [[nodiscard]] glm::ivec2 cellAt(const QPointF& at) const;
    /// As large as it fits, in the middle.
    [[nodiscard]] static LevelView fitted(const labyrinth::Level& level, const QRectF& page);
};

/// What is shown beside the level itself.
struct LevelMarks {
    std::optional<glm::ivec2> cursor; ///< the cell that keys and pointer aim at
    std::optional<glm::ivec2> wrong;
    std::vector<glm::ivec2> way;
};

void paintLevel(QPainter& painter, const labyrinth::Level& level, const LevelView& view, const LevelMarks& marks);

/// A piece as a button shows it.
[[nodiscard]] QIcon pieceIcon(const LevelPiece& piece);

} // namespace lumorph::studio
