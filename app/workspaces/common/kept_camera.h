#pragma once

#include <optional>

#include <QObject>
#include <QTimer>

#include "app/studio/base/settings.h"
#include "app/studio/viewport/viewport_widget.h"

namespace lumorph::studio {

/// Where one looks from in a view, from one start to the next. A child of the view.
class KeptCamera : public QObject {
public:
    /// `name` tells views apart: "field". `settings` outlive the view.
    KeptCamera(Settings& settings, const QString& name, ViewportWidget* view);
    ~KeptCamera() override;

    /// From now on the view shows this device. What was kept, if it was for the same device and nothing was shown
    /// since the start; else empty, and the view has to find the device itself.
    [[nodiscard]] std::optional<ViewCamera> begin(const QString& device);

private:
    void keep();

    Settings& settings_;
    QString key_;
    QString device_;
    ViewCamera newest_;
    QTimer due_; ///< a drag moves the camera at each move of the mouse
    bool begun_ = false;
};

} // namespace lumorph::studio
