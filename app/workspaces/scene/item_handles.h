#pragma once

#include <functional>
#include <optional>

#include <QSize>

#include "app/studio/document/studio_document.h"
#include "app/studio/viewport/gizmo.h"
#include "app/workspaces/scene/view_pane.h"
#include "core/geometry/calibrated_camera.h"

namespace lumorph::studio {

/// A camera of the show as a viewport's camera sees it: the off-axis picture is a part of a larger one around the
/// direction of view. A point at p in the picture is at p + `offset` in the larger one.
struct HandleView {
    ViewCamera camera;
    glm::vec2 size{1.0F}; ///< of the larger picture
    glm::vec2 offset{0.0F};
};
/// `camera` looks level or down with +Y up in its picture, has square pixels and no distortion.
[[nodiscard]] HandleView handleView(const CalibratedCamera& camera);

/// World from the frame in which an item's position counts: its group's or its anchor's.
[[nodiscard]] glm::mat4 worldFromParent(const Scene& scene, const SceneItem& item, double seconds,
                                        const glm::mat4& worldFromDevice);

/// The item after its handles were dragged: moved, turned about the world's +Y, scaled evenly.
[[nodiscard]] SceneItem draggedItem(SceneItem item, const glm::mat4& worldFromParent, const Placement& from,
                                    const Placement& to);

/// Handles of the selected item over a picture: arrows, ground square, ring and size, with the numbers of the drag. A
/// drag is one step of undo.
class ItemHandles : public PaneOverlay {
public:
    /// `cameraOf` gives the camera of the picture for its size; empty while there is none.
    using CameraOf = std::function<std::optional<CalibratedCamera>(const QSize&)>;
    ItemHandles(StudioDocument& document, CameraOf cameraOf);

    /// 0: no item. An item without a place of its own (the sun) has no handles.
    void setItem(int item);
    /// Time of the scene, which moves groups.
    void setSeconds(double seconds) { seconds_ = seconds; }

    void paint(QPainter& painter, const QSize& size) override;
    bool press(const QPointF& at, const QSize& size, Qt::KeyboardModifiers modifiers) override;
    void drag(const QPointF& to, const QSize& size, Qt::KeyboardModifiers modifiers) override;
    void release() override;
    void cancel() override;
    bool hover(const QPointF& at, const QSize& size) override;
    [[nodiscard]] bool hot() const override { return hot_.has_value(); }

private:
    struct Grip {
        GizmoHandle handle = GizmoHandle::moveX;
        Gizmo start;
        SceneItem item;
        glm::mat4 worldFromParent{1.0F};
        glm::vec2 from{0.0F};
        QPointF pointer;
        QString label;
    };
    [[nodiscard]] const SceneItem* item() const;
    [[nodiscard]] std::optional<Gizmo> gizmo() const;
    [[nodiscard]] std::optional<HandleView> viewOf(const QSize& size) const;

    StudioDocument& document_;
    CameraOf cameraOf_;
    int item_ = 0;
    double seconds_ = 0.0;
    std::optional<GizmoHandle> hot_;
    std::optional<Grip> grip_;
};

} // namespace lumorph::studio
