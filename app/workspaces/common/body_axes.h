#pragma once

#include <QObject>
#include <QTimer>

#include "app/studio/shell/studio.h"
#include "app/studio/viewport/viewport_widget.h"

namespace lumorph::studio {

/// Adds the command "view.bodies", which shows and hides the axes of tracked bodies in all views; remembered.
void addBodiesCommand(Studio& studio);

/// Keeps the axes of tracked bodies over one view, whose scene is in the device's frame. Costs nothing while no tracker
/// is open, the view is out of sight, or the command is off.
class BodyAxes : public QObject {
public:
    /// `studio` outlives it; belongs to the view.
    BodyAxes(Studio& studio, ViewportWidget* view);

private:
    void follow(); ///< begins or ends looking
    void look();
    [[nodiscard]] bool isWanted() const;

    Studio& studio_;
    ViewportWidget* view_;
    QTimer timer_;
};

} // namespace lumorph::studio
