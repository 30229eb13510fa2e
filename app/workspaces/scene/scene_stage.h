#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// The middle of the Scene workspace: what eye, projector and lab see of the scene.
class SceneStage : public QWidget {
    Q_OBJECT
public:
    /// `studio` outlives it.
    explicit SceneStage(Studio& studio, QWidget* parent = nullptr);

    /// A hidden stage draws nothing.
    void setActive(bool active);
    /// Marks an item of the scene; 0 marks none.
    void setSelected(int item);

signals:
    /// The user pointed at an item; 0: at none.
    void picked(int item);
};

} // namespace lumorph::studio
