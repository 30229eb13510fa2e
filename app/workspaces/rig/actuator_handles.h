#pragma once

#include <functional>
#include <optional>

#include "app/studio/viewport/pane_overlay.h"
#include "app/workspaces/rig/actuator_guide.h"
#include "app/workspaces/rig/actuator_preview.h"
#include "app/workspaces/rig/influence_map.h"
#include "app/workspaces/rig/rig_selection.h"

namespace lumorph::studio {

/// Handles of the chosen actuator over the view: the ends of its line, its range as an arc or a way with its limits,
/// and a pointer at the stroke that is shown. A drag is one step of undo; that of the pointer rehearses, in the view
/// alone. Ctrl snaps, to 5 mm, 15 degrees and a tenth of the stroke.
class ActuatorHandles : public PaneOverlay {
public:
    /// Both outlive it. `camera` is that of the view.
    ActuatorHandles(StudioDocument& document, RigSelection& selection, std::function<ViewCamera()> camera);

    /// The chosen actuator of the document as it is now; `vertices` are those that it moves.
    void follow(std::optional<std::size_t> actuator, std::span<const std::uint32_t> vertices);
    /// The strokes that the view shows, and those of the device itself.
    void setStrokes(const std::vector<double>& shown, const std::vector<double>& device);
    [[nodiscard]] const std::optional<ActuatorGuide>& guide() const { return guide_; }

    /// Says what the colours of the device tell; none: it has none.
    void setLegend(std::optional<HeatLegend> legend) { legend_ = std::move(legend); }

    void paint(QPainter& painter, const QSize& size) override;
    bool press(const QPointF& at, const QSize& size, Qt::KeyboardModifiers modifiers) override;
    void drag(const QPointF& to, const QSize& size, Qt::KeyboardModifiers modifiers) override;
    void release() override;
    void cancel() override;
    bool hover(const QPointF& at, const QSize& size) override;
    [[nodiscard]] bool hot() const override { return hot_.has_value(); }

private:
    struct Grip {
        RigHandle handle;
        ActuatorGuide start;
        std::vector<double> rehearsed; ///< before the drag
        double value = 0.0;            ///< of a limit or the stroke, as it was dragged so far
        glm::vec2 offset{0.0F};        ///< from where it was taken to the handle's middle
        QPointF pointer;
        QString label;
    };
    void dragLimit(glm::vec2 pixel, glm::vec2 size, bool coarse);
    void dragStroke(glm::vec2 pixel, glm::vec2 size, bool coarse);
    void dragEnd(glm::vec2 pixel, glm::vec2 size, bool coarse);
    void dragBend(glm::vec2 pixel, glm::vec2 size, bool coarse);
    void dragDirection(glm::vec2 pixel, glm::vec2 size, bool coarse);
    void rehearse(double stroke);
    [[nodiscard]] QString stepOf(RigHandle handle) const;
    [[nodiscard]] double stroke() const;

    StudioDocument& document_;
    RigSelection& selection_;
    std::function<ViewCamera()> camera_;
    ActuatorPreview preview_;
    std::optional<std::size_t> actuator_;
    std::optional<ActuatorGuide> guide_; ///< as it is shown, during a drag too
    std::vector<double> shown_, device_;
    std::optional<HeatLegend> legend_;
    std::optional<RigHandle> hot_;
    std::optional<Grip> grip_;
};

} // namespace lumorph::studio
