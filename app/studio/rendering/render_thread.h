#pragma once

#include <functional>
#include <memory>
#include <optional>

#include <QImage>
#include <QObject>
#include <QSize>
#include <QString>

#include "app/studio/rendering/show_request.h"
#include "core/render/viewport/view_camera.h"
#include "core/render/viewport/viewport_scene.h"

namespace lumorph::studio {

/// What a viewport wants drawn.
struct FrameRequest {
    std::shared_ptr<const ViewportScene> scene;
    ViewCamera camera;
    QSize pixels;       ///< of the framebuffer, not of the desktop
    double scale = 1.0; ///< desktop scale
    bool refine = true; ///< when nothing newer comes, draw it again in full quality
};

/// A frame that was drawn. The image belongs to the receiver; no OpenGL context is needed to show it.
struct DrawnFrame {
    QImage image;
    std::shared_ptr<const ViewportScene> scene;
    ViewCamera camera;
    bool still = false;      ///< in full quality
    double resolution = 1.0; ///< share of each side that it was drawn with
    double milliseconds = 0.0;
};

/// Draws all viewports, and the show, in a thread of its own with a context of its own. The newest request of each
/// viewport and of the show counts; frames are read back and handed over, so that the window's thread only paints a
/// picture and a dock that moves loses nothing. Made, used and destroyed in the window's thread.
class RenderThread : public QObject {
    Q_OBJECT
public:
    explicit RenderThread(QObject* parent = nullptr);
    ~RenderThread() override;

    /// Why nothing can be drawn here (OpenGL 4.1 is missing, with the version found, and what to do); empty when all is
    /// well. Known once `ready` was emitted. After a reset of the graphics driver drawing begins anew by itself.
    [[nodiscard]] std::optional<QString> failure() const;
    /// After a failure, for example when a driver was installed: looks again and emits `ready`.
    void retry();

    /// A number for a new viewport.
    [[nodiscard]] int newViewport();
    /// `viewport` is any number that tells viewports apart. A request without a scene or without pixels is ignored.
    void request(int viewport, FrameRequest request);
    /// Whether views at rest are drawn again in full quality; on at first.
    void setStillQuality(bool on);
    /// The share of its time, in (0, 1], that this thread may draw; all of it at first. After each frame it rests for
    /// the remainder, a quarter of a second at most. For tests beside a renderer in software.
    void setShare(double share);
    /// Forgets a viewport and what was asked for it.
    void forget(int viewport);
    /// Draws one picture of any size in full quality; `done` runs in the window's thread with a null image and a reason
    /// when that failed.
    void picture(FrameRequest request, std::function<void(QImage, QString)> done);

    /// Draws a frame of the show, all views of it; it takes turns with the viewports. Views without pixels are left
    /// out; a request without views, scene or assets only takes the one before back.
    void requestShow(ShowRequest request);
    /// The newest frame of the show that was not taken yet.
    [[nodiscard]] std::optional<DrawnShow> takeShow();

    /// For tests: OpenGL objects held by the renderer, and OpenGL errors since the start.
    [[nodiscard]] std::size_t objectCount() const;
    [[nodiscard]] std::size_t errorCount() const;

    /// The newest frame of a viewport that was not taken yet.
    [[nodiscard]] std::optional<DrawnFrame> takeFrame(int viewport);

signals:
    void ready();
    void drawn(int viewport); ///< take it with `takeFrame`
    /// A frame could not be drawn; emitted once for a cause, not for every frame. Drawing goes on.
    void broke(const QString& why);
    void showDrawn(); ///< take it with `takeShow`
    /// The same as `broke` for a frame of the show. The next request tries again.
    void showBroke(const QString& why);

private:
    struct Data;
    std::unique_ptr<Data> data_;
    int viewports_ = 0;
};

} // namespace lumorph::studio
