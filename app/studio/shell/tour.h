#pragma once

#include <functional>
#include <vector>

#include <QMainWindow>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// One step of the tour: what it points at, what it says, and what its button does.
struct TourStep {
    std::vector<QString> widgets; ///< objectNames; the first that is there is lit
    QString title;
    QString text;
    QString action; ///< of the button; empty: none
    std::function<void()> run;
    QString alsoLit{}; ///< objectName of where one sees what it does; empty: nowhere else
};

/// The first-run tour over the Scene workspace, five steps.
[[nodiscard]] std::vector<TourStep> tourSteps(Studio& studio);

/// Shows a tour over a window: each step lights its widget, which stays usable, and points at it from a card with Back,
/// Next and Skip (arrow keys, Enter, Esc), which lies whole in the window. Steps whose widget is missing are left out.
/// `finished` runs at the end, skipped or not.
void showTour(QMainWindow& window, std::vector<TourStep> steps, std::function<void()> finished);

} // namespace lumorph::studio
