#include "app/studio/shell/studio_application.h"

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <malloc.h>

#include <QSurfaceFormat>
#include <QWidget>

namespace lumorph::studio {
namespace {

constexpr auto kNoDisplay =
    "lumorph-studio: display: no window can be shown here (%s); start it in a desktop session, "
    "connect by `ssh -X`, or use `lumorph-studio --headless FOLDER` and `lumorph match`, which need no display\n";

/// Qt ends the program when it finds no display; it should say what to do, and exit like any other failure.
void tellNoDisplay(QtMsgType type, const QMessageLogContext& /*context*/, const QString& /*message*/) {
    if (type != QtFatalMsg) return;
    // Qt's own words advise to install it again, which helps nobody whose display does not answer.
    const QString display = qEnvironmentVariable("DISPLAY", qEnvironmentVariable("WAYLAND_DISPLAY"));
    std::fprintf(stderr, kNoDisplay, ("display '" + display + "' does not answer").toUtf8().constData());
    std::_Exit(1);
}

bool choosesPlatform(int argc, char** argv) {
    for (int i = 1; i < argc; ++i)
        if (std::string_view(argv[i]) == "-platform") return true;
    return !qEnvironmentVariableIsEmpty("QT_QPA_PLATFORM");
}

/// Pictures come and go with their resolution all day, and in software OpenGL they lie in this program's memory. By
/// itself glibc puts those of up to 32 MB among all else, where they leave holes that stay.
void returnFreedPictures() {
#ifdef __GLIBC__
    constexpr int kBytes = 1 << 20;
    ::mallopt(M_MMAP_THRESHOLD, kBytes);
#endif
}

/// While the application is being made its complaints are ours to word; afterwards they go where they always go.
class DisplayWatch {
public:
    DisplayWatch() : before_(qInstallMessageHandler(tellNoDisplay)) {}
    ~DisplayWatch() { qInstallMessageHandler(before_); }

private:
    QtMessageHandler before_;
};

} // namespace

QString prepareApplication(int argc, char** argv) {
    returnFreedPictures();
    QSurfaceFormat format;
    format.setVersion(4, 1);
    format.setProfile(QSurfaceFormat::CoreProfile);
    QSurfaceFormat::setDefaultFormat(format);
    QCoreApplication::setOrganizationName("lumorph");
    QCoreApplication::setApplicationName("lumorph");
    QCoreApplication::setApplicationVersion(LUMORPH_VERSION);
    if (choosesPlatform(argc, argv)) return {};
    if (!qEnvironmentVariableIsEmpty("DISPLAY") || !qEnvironmentVariableIsEmpty("WAYLAND_DISPLAY")) return {};
    return QString::asprintf(kNoDisplay, "DISPLAY is not set");
}

// The watch lives as long as the base class is being made.
StudioApplication::StudioApplication(int& argc, char** argv)
    : QApplication((static_cast<void>(DisplayWatch{}), argc), argv) {}

void StudioApplication::setOnError(std::function<void(const std::exception&)> told) { told_ = std::move(told); }

bool StudioApplication::notify(QObject* receiver, QEvent* event) {
    try {
        return QApplication::notify(receiver, event);
    } catch (const std::exception& error) {
        tell(error);
    } catch (...) {
        tell(std::runtime_error("something unknown was thrown"));
    }
    return false;
}

void StudioApplication::tell(const std::exception& error) {
    try {
        if (told_) {
            told_(error);
            return;
        }
    } catch (const std::exception& further) {
        std::fprintf(stderr, "lumorph-studio: %s\n", further.what());
    }
    std::fprintf(stderr, "lumorph-studio: %s\n", error.what());
}

} // namespace lumorph::studio
