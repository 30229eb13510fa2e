#include "app/studio/rendering/gl_thread.h"

#include <QGuiApplication>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QSurfaceFormat>
#include <QThread>

#include "core/render/gl/gl_driver.h"

namespace lumorph::studio {
namespace {

constexpr int kNeededVersion = 41;

QSurfaceFormat neededFormat() {
    QSurfaceFormat format;
    format.setRenderableType(QSurfaceFormat::OpenGL);
    format.setVersion(kNeededVersion / 10, kNeededVersion % 10);
    format.setProfile(QSurfaceFormat::CoreProfile);
    format.setOption(QSurfaceFormat::ResetNotification);
    return format;
}

// A context as wished, or whatever there is, so that its version can be told; null when there is nothing.
std::unique_ptr<QOpenGLContext> makeContext(const QSurfaceFormat& wished) {
    QSurfaceFormat untold = wished; // of resets: there are drivers that cannot
    untold.setOption(QSurfaceFormat::ResetNotification, false);
    for (const QSurfaceFormat& format : {wished, untold, QSurfaceFormat()}) {
        auto context = std::make_unique<QOpenGLContext>();
        context->setFormat(format);
        if (context->create()) return context;
    }
    return nullptr;
}

QString whatIsMissing(const GlDriver& driver) {
    const QString remedy = driver.software
                               ? QStringLiteral("Install a newer Mesa (the package libgl1-mesa-dri) and start again "
                                                "without MESA_GL_VERSION_OVERRIDE.")
                               : QStringLiteral("Update the graphics driver, or start Lumorph with "
                                                "LIBGL_ALWAYS_SOFTWARE=1 to draw without it.");
    return QStringLiteral("This graphics driver offers OpenGL %1.%2 (%3); 4.1 is needed. %4")
        .arg(driver.version / 10)
        .arg(driver.version % 10)
        .arg(QString::fromStdString(driver.renderer).section(QStringLiteral(" ("), 0, 0), remedy);
}

QString nothingThere() {
    return QStringLiteral("OpenGL does not start here; OpenGL 4.1 is needed. Install a graphics driver "
                          "(on Debian the package libgl1-mesa-dri), or start Lumorph with LIBGL_ALWAYS_SOFTWARE=1.");
}

} // namespace

GlThread::GlThread(std::function<void()> work, std::function<void(QString)> failed) {
    std::shared_ptr<QOpenGLContext> context = makeContext(neededFormat());
    surface_ = std::make_unique<QOffscreenSurface>();
    surface_->setFormat(context ? context->format() : neededFormat());
    surface_->create();
    thread_.reset(
        QThread::create([context, surface = surface_.get(), work = std::move(work), failed = std::move(failed)] {
            if (!context || !context->makeCurrent(surface)) {
                failed(nothingThere());
                return;
            }
            const GlDriver driver = currentDriver();
            if (driver.version < kNeededVersion)
                failed(whatIsMissing(driver));
            else
                work();
            context->doneCurrent();
        }));
    thread_->setObjectName(QStringLiteral("render"));
    if (context) context->moveToThread(thread_.get());
    thread_->start();
}

GlThread::~GlThread() { thread_->wait(); }

} // namespace lumorph::studio
