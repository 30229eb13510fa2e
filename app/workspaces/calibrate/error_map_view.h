#pragma once

#include <optional>

#include <QPolygonF>
#include <QWidget>

#include "app/studio/calibration/error_plan.h"
#include "app/studio/document/studio_state.h"

namespace lumorph::studio {

/// How far light may land beside, seen from above in colours: on the table, and as high as the device lifts its
/// surface. The value under the pointer is told.
class ErrorMapView : public QWidget {
    Q_OBJECT
public:
    explicit ErrorMapView(QWidget* parent = nullptr);
    /// `device`: its outline in world metres, x and z.
    void show(std::optional<ErrorPlan> plan, QPolygonF device);
    [[nodiscard]] const std::optional<ErrorPlan>& plan() const noexcept { return plan_; } ///< that is shown
    [[nodiscard]] QSize minimumSizeHint() const override { return {240, 160}; }

protected:
    void paintEvent(QPaintEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;

private:
    [[nodiscard]] QRectF panelOf(int plane) const;

    std::optional<ErrorPlan> plan_;
    QPolygonF device_;
    QRect part_; ///< of the plan that is drawn, its columns and rows: where light falls, and the device
};

/// Around the rig at rest, in the room: world metres, x and z; empty without a rig.
[[nodiscard]] QPolygonF deviceOutlineOf(const StudioState& state);

} // namespace lumorph::studio
