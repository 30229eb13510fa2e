#pragma once

#include <memory>

#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// The middle of the Scene workspace: what eye, projector and lab see of the scene, side by side. Dragging in a picture
/// leads the simulated viewer around the device; in the lab somebody else may look, too.
class SceneCentralView : public QWidget {
    Q_OBJECT
public:
    /// `studio` outlives it.
    explicit SceneCentralView(Studio& studio, QWidget* parent = nullptr);
    ~SceneCentralView() override;

    /// A hidden stage draws nothing.
    void setActive(bool active);
    /// The pictures alone, without bar, cards and handles; or all again.
    void setForVisitors(bool on);
    /// Marks an item of the scene; 0 marks none.
    void setSelected(int item);

signals:
    /// The user pointed at an item; 0: at none.
    void picked(int item);

protected:
    void resizeEvent(QResizeEvent* event) override;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::studio
