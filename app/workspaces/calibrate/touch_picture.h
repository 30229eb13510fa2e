#pragma once

#include <memory>
#include <optional>

#include <QPixmap>
#include <QWidget>

#include "calibration/registration/touch_plan.h"

namespace lumorph::studio {

/// The device at rest, seen from before and above, with the corner that is to be touched.
class TouchPicture : public QWidget {
    Q_OBJECT
public:
    explicit TouchPicture(QWidget* parent = nullptr);
    /// Null, or no corner: nothing is drawn.
    void show(std::shared_ptr<const Rig> rig, const std::optional<PlannedLandmark>& corner);

protected:
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;

private:
    void drawDevice();

    std::shared_ptr<const Rig> rig_;
    std::optional<PlannedLandmark> corner_;
    QPixmap device_; ///< null: to be drawn anew
    double scale_ = 1.0;
    QPointF origin_; ///< of the device in this widget
};

} // namespace lumorph::studio
