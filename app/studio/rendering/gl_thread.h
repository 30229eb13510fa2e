#pragma once

#include <functional>
#include <memory>

#include <QString>

class QThread;
class QOffscreenSurface;

namespace lumorph::studio {

/// A thread with an OpenGL 4.1 core context of its own. It shares nothing with other contexts: after a reset of the
/// driver whatever shares with a lost context is lost too. Made and destroyed in the window's thread.
class GlThread {
public:
    /// Runs `work` in the thread, the context being current, or `failed` there with what is wrong and what to do. The
    /// destructor waits for either to return.
    GlThread(std::function<void()> work, std::function<void(QString)> failed);
    ~GlThread();
    GlThread(const GlThread&) = delete;
    GlThread& operator=(const GlThread&) = delete;

private:
    std::unique_ptr<QOffscreenSurface> surface_;
    std::unique_ptr<QThread> thread_;
};

} // namespace lumorph::studio
