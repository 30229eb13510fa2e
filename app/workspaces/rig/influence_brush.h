#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "app/studio/document/studio_document.h"
#include "app/studio/viewport/pane_overlay.h"
#include "app/workspaces/rig/influence_tools.h"
#include "core/render/viewport/view_camera.h"
#include "core/render/viewport/viewport_scene.h"

namespace lumorph::studio {

/// Edits in the view which places of the surface follow the chosen actuator, and how much: a press on the device begins
/// a stroke, which is one step of undo; a press beside it is the view's. Picks a place for the tool `distance`.
class InfluenceBrush : public PaneOverlay {
public:
    struct View {
        std::function<ViewCamera()> camera;
        std::function<std::shared_ptr<const ViewportScene>()> scene;
    };
    /// Both outlive it. `changed` is told when other weights are to be shown.
    InfluenceBrush(StudioDocument& document, InfluenceTools& tools, View view, std::function<void()> changed);

    /// The chosen actuator as the document has it now; a stroke that is being drawn goes on.
    void follow(std::optional<std::size_t> actuator);
    /// Of the chosen actuator, one a vertex, a stroke included; empty without one.
    [[nodiscard]] const std::vector<float>& weights() const { return stroke_ ? stroke_->weights() : weights_; }

    void paint(QPainter& painter, const QSize& size) override;
    bool press(const QPointF& at, const QSize& size, Qt::KeyboardModifiers modifiers) override;
    void drag(const QPointF& to, const QSize& size, Qt::KeyboardModifiers modifiers) override;
    void release() override;
    void cancel() override;
    bool hover(const QPointF& at, const QSize& size) override;
    [[nodiscard]] bool hot() const override { return spot_.has_value(); }

private:
    /// What lies under the pointer.
    struct Spot {
        QPointF pixel;
        float pixels = 0.0F;                 ///< of the brush's radius there
        glm::vec3 place{0.0F}, normal{0.0F}; ///< of the rest mesh
    };
    [[nodiscard]] std::optional<Spot> spotAt(const QPointF& at, const QSize& size) const;
    void move();

    StudioDocument& document_;
    InfluenceTools& tools_;
    View view_;
    std::function<void()> changed_;
    std::optional<std::size_t> actuator_;
    std::vector<float> weights_;
    std::shared_ptr<const RigParts> of_; ///< whose weights those are
    std::optional<Spot> spot_;
    std::optional<WeightStroke> stroke_;
    std::shared_ptr<const RigParts> base_; ///< the parts when the stroke began
    bool picking_ = false;                 ///< the press was for a place
};

} // namespace lumorph::studio
