#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <QColor>
#include <QPainter>
#include <QPixmap>
#include <QRect>
#include <QString>

#include "app/workspaces/rig/page_view.h"
#include "core/rig/templates/sheet_drawing.h"
#include "core/rig/templates/sheet_plan.h"

namespace lumorph::studio {

inline constexpr int kRulerWidth = 24; ///< pixels

/// Of the flap that an actuator moves, in the theme in use; the ones next to each other differ well.
[[nodiscard]] QColor flapColor(std::size_t actuator);

/// Spacing of the finest grid that one can see and aim at, metres: 1, 2 or 5 times a power of ten.
[[nodiscard]] double gridSpacing(const PageView& view);

/// What is on the page right now.
struct SheetPage {
    const SheetDevice& device;
    std::shared_ptr<const SheetPlan> plan; ///< of this drawing or one before it; may be empty
    PageView view;
    QRect area; ///< of the widget, rulers included
    SheetPart chosen;
    SheetPart hovered;
    std::vector<glm::dvec2> outlineBegun; ///< being drawn
    bool outlineCloses = false;           ///< it is drawn closed
    std::optional<std::pair<glm::dvec2, glm::dvec2>> lineBegun;
    std::optional<SnappedPoint> pointer; ///< where the next press would be
    QString readout;                     ///< beside the pointer
};

/// The page itself: grid and rulers. It changes only with the view, the size and the theme, and takes longer than all
/// else, so that its owner keeps it.
void paintPage(QPainter& painter, const PageView& view, const QRect& area);

/// What is drawn on it. `page` is a picture of `paintPage`, whose rulers stay on top.
void paintSheet(QPainter& painter, const SheetPage& picture, const QPixmap& page);

} // namespace lumorph::studio
