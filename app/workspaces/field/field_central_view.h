#pragma once

#include <QLayout>

#include "app/studio/shell/studio.h"
#include "app/studio/viewport/viewport_widget.h"
#include "app/studio/widgets/throttle.h"
#include "app/workspaces/field/fit_readout.h"
#include "app/workspaces/field/timeline.h"

namespace lumorph::studio {

/// The central view of the Field workspace: the viewport with what floats over it: tools, the readout of the match, the
/// timeline, notices and jobs, and, while there is no target, what to do first.
class FieldCentralView : public QWidget {
    Q_OBJECT
public:
    /// Numbers follow the newest frame whenever `numbers` are due.
    FieldCentralView(Studio& studio, Throttle& numbers, QWidget* parent = nullptr);

    [[nodiscard]] ViewportWidget* viewport() const noexcept { return viewport_; }
    /// What is there and what is not, and the time of the animation.
    void refresh();
    /// Notices about the target stand over the view while no dock shows them.
    void setTargetNoticesShown(bool shown);
    /// The view and how well it matches, without tools, timeline and notices; or all again.
    void setForVisitors(bool on);

protected:
    void resizeEvent(QResizeEvent* event) override;

private:
    [[nodiscard]] QWidget* makeTools();
    [[nodiscard]] QWidget* makeHint();
    [[nodiscard]] QWidget* makeNotices();

    Studio& studio_;
    ViewportWidget* viewport_;
    FitReadout* readout_;
    Timeline* timeline_;
    QLayout* timelineMargins_ = nullptr;
    QLayout* readoutMargins_ = nullptr;
    QWidget *tools_ = nullptr, *notices_ = nullptr;
    QWidget* hint_ = nullptr;
    QWidget* targetNotices_ = nullptr;
    bool forVisitors_ = false;
};

} // namespace lumorph::studio
