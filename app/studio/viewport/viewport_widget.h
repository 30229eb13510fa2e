#pragma once

#include <memory>
#include <optional>

#include <QString>
#include <QWidget>

#include "app/studio/rendering/render_thread.h"
#include "app/studio/viewport/body_marks.h"
#include "app/studio/viewport/gizmo.h"
#include "app/studio/viewport/pane_overlay.h"
#include "core/render/viewport/viewport_renderer.h"

namespace lumorph::studio {

/// A view into the world, shared by all workspaces: orbit, pan, zoom, view cube, orthographic views, frame selected,
/// grid label, picking, and a gizmo for one placed object. It paints the newest frame of the render thread and draws
/// its own marks over it. Where OpenGL 4.1 is missing it says so instead, with what to do.
///
/// Left drag on empty space or middle drag turns, with Shift (or right drag) it pans, the wheel zooms at the pointer; F
/// frames what is selected, Home everything, 1/3/7 front, right, top, 5 perspective or orthographic. A click picks.
/// Arrow keys turn, with Shift they pan, + and - zoom. A left drag on a handle of the gizmo drags that, coarsely with
/// Ctrl; Esc takes it back.
class ViewportWidget : public QWidget {
    Q_OBJECT
public:
    explicit ViewportWidget(RenderThread& renderer, QWidget* parent = nullptr);
    ~ViewportWidget() override;

    /// The first scene with an extent is framed, unless a camera was set before.
    void setScene(std::shared_ptr<const ViewportScene> scene);
    [[nodiscard]] const std::shared_ptr<const ViewportScene>& scene() const noexcept;
    [[nodiscard]] const ViewCamera& camera() const noexcept;
    void setCamera(const ViewCamera& camera, bool glide = false);
    /// The box that F frames; everything when empty.
    void setSelectionBox(const Box& box);
    /// Shows or hides the gizmo. During a drag it follows the pointer by itself; the owner may set it all the same.
    void setGizmo(std::optional<Gizmo> gizmo);
    /// Drawn over the picture, and takes a left drag that begins on its handles, before the gizmo; Esc takes that back.
    /// It outlives the viewport, or is taken away before; null: none.
    void setOverlay(PaneOverlay* overlay);
    /// Tracked bodies, painted over the picture: no frame is drawn anew for them.
    void setBodies(std::vector<BodyMark> bodies);
    /// A hidden viewport asks for no frames.
    void setActive(bool active);
    /// Frames that were painted; for rates and tests.
    [[nodiscard]] std::uint64_t framesPainted() const noexcept;
    /// Share of each side, in pixels, that the frame now on screen was drawn with: below 1 where time was short.
    [[nodiscard]] double frameResolution() const noexcept;
    /// What drawing it took.
    [[nodiscard]] double frameMilliseconds() const noexcept;
    /// The frame now on screen, without marks; for tests and pictures of the view.
    [[nodiscard]] QImage frameImage() const;
    /// The last frame painted is in full quality and of the newest scene and camera.
    [[nodiscard]] bool settled() const noexcept;

    void frameAll();
    void frameSelected();
    void viewFrom(const glm::vec3& side);
    void setOrthographic(bool on);

signals:
    void cameraChanged();
    /// A click on something, or on nothing (id 0).
    void picked(const lumorph::ViewportHit& hit);
    void gizmoDragged(const lumorph::Placement& placement); ///< during a drag
    void gizmoDropped(const QString& what);                 ///< the drag ended; `what` names it for undo
    void gizmoCancelled();                                  ///< Esc during a drag

protected:
    bool event(QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    void showEvent(QShowEvent* event) override;
    void hideEvent(QHideEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void keyReleaseEvent(QKeyEvent* event) override;
    void focusInEvent(QFocusEvent* event) override;
    void focusOutEvent(QFocusEvent* event) override;
    void leaveEvent(QEvent* event) override;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::studio
