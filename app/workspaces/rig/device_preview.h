#pragma once

#include <memory>

#include <QSlider>
#include <QWidget>

#include "app/studio/shell/studio.h"
#include "app/studio/viewport/viewport_widget.h"
#include "app/workspaces/common/field_scene.h"
#include "core/rig/rig.h"

namespace lumorph::studio {

/// A device that is not made yet, in a view of its own, with a slider that rehearses all its actuators at once.
class DevicePreview : public QWidget {
    Q_OBJECT
public:
    /// `prefix` begins the names of its widgets: "rig.new" makes "rig.new.view" and "rig.new.raised".
    DevicePreview(Studio& studio, const QString& prefix, QWidget* parent = nullptr);

    /// Shows another one, or nothing; from where all of it is seen when it is the first, or when `frameNext` was called
    /// before.
    void show(std::shared_ptr<const Rig> rig);
    void frameNext() { reframes_ = true; }
    void setActive(bool active) { view_->setActive(active); }

private:
    void refresh();

    FieldSceneBuilder builder_;
    std::shared_ptr<const Rig> rig_;
    bool reframes_ = true;
    ViewportWidget* view_;
    QSlider* raised_;
};

} // namespace lumorph::studio
