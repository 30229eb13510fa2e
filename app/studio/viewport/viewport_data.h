#pragma once

#include <chrono>

#include <QImage>
#include <QPointF>
#include <QThreadPool>
#include <QTimer>

#include "app/studio/viewport/camera_motion.h"
#include "app/studio/viewport/gl_page.h"
#include "app/studio/viewport/view_cube.h"
#include "app/studio/viewport/viewport_widget.h"

namespace lumorph::studio {

/// The inside of a viewport: what is shown and how frames come (viewport_widget.cpp), what the pointer and the keys do
/// (viewport_input.cpp).
struct ViewportWidget::Data {
    using Clock = std::chrono::steady_clock;

    /// The pointer is not over the view.
    static constexpr QPointF kNowhere{-1e4, -1e4};

    /// What a pressed button does.
    enum class Drag { none, undecided, orbit, pan, cube, gizmo };

    /// The drag of a handle.
    struct Grip {
        Gizmo start;
        GizmoHandle handle = GizmoHandle::moveX;
        QPointF from;
        bool coarse = false;
        bool moved = false;
        QString label;
    };

    Data(ViewportWidget& widget, RenderThread& thread);
    ~Data();

    // Frames.
    void changed();      ///< of what is to be drawn: asks for a frame
    void cameraMoved();  ///< the same, and tells the owner
    void prepareScene(); ///< the owner's scene with the gizmo's lines
    void frameFirstScene();
    void takeFrame();
    void showReason();
    void tick();
    void startTicking();
    [[nodiscard]] bool wantsFrames() const;
    [[nodiscard]] QSize pixels() const;
    [[nodiscard]] glm::vec2 size() const;
    void paintFrame(QPainter& painter) const;
    void paintMarks(QPainter& painter) const;

    // Pointer and keys; true when used.
    void press(const QPointF& at, Qt::MouseButton with, Qt::KeyboardModifiers modifiers);
    void drag(const QPointF& to, Qt::KeyboardModifiers modifiers);
    void release(const QPointF& at);
    void hover(const QPointF& at);
    void click(const QPointF& at);
    void dragGrip(const QPointF& to, bool coarse);
    void cancelGrip(bool tell);
    void dropGrip();
    void setHot(std::optional<GizmoHandle> handle, std::optional<CubeSide> side);
    void showCursor();
    [[nodiscard]] bool key(int key, Qt::KeyboardModifiers modifiers);
    void turnBy(const glm::vec2& pixels);
    void panBy(const glm::vec2& pixels);
    void zoomBy(double factor, const QPointF& at);
    void glideTo(const ViewCamera& camera);
    [[nodiscard]] std::optional<CubeSide> cubeAt(const QPointF& at) const;

    ViewportWidget& self;
    RenderThread& renderer;
    const int number;

    std::shared_ptr<const ViewportScene> scene;
    std::shared_ptr<const ViewportScene> prepared; ///< `scene`, with the gizmo when there is one
    Box selection;
    std::optional<Gizmo> gizmo;
    std::vector<BodyMark> bodies;
    bool active = true;
    bool cameraGiven = false; ///< the owner or the user has chosen where to look from
    CameraMotion motion;
    QTimer ticker;

    DrawnFrame frame; ///< on the screen or about to be
    QSize asked;      ///< size of the newest request, pixels
    std::uint64_t painted = 0;
    bool unpainted = false; ///< `frame` was not painted yet
    QString notice;         ///< why frames do not come
    GlPage* page = nullptr;
    bool ringed = false; ///< the focus came by key

    Drag dragging = Drag::none;
    Qt::MouseButton button = Qt::NoButton;
    QPointF pressedAt;
    QPointF pointer = kNowhere;
    std::optional<Grip> grip;
    std::optional<GizmoHandle> hotHandle;
    std::optional<CubeSide> hotSide;

    QThreadPool picker; ///< last: waits for its work before the rest goes
};

inline glm::vec2 toVec(const QPointF& p) { return {static_cast<float>(p.x()), static_cast<float>(p.y())}; }

} // namespace lumorph::studio
