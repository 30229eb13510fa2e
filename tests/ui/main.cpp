#include <cstring>
#include <filesystem>

#include <QDir>
#include <QStandardPaths>
#include <QTemporaryDir>
#include <gtest/gtest.h>

#include "app/studio/look/palette.h"
#include "app/studio/shell/studio_application.h"

namespace {

bool onlyLists(int argc, char** argv) {
    for (int i = 1; i < argc; ++i)
        if (std::strcmp(argv[i], "--gtest_list_tests") == 0) return true;
    return false;
}

/// The user's own settings and sessions are neither read nor written. The shaders that the driver has compiled are
/// shared by all runs: compiling them takes longer than most tests.
void useFolders(const QString& root) {
    if (qEnvironmentVariableIsEmpty("MESA_SHADER_CACHE_DIR"))
        qputenv("MESA_SHADER_CACHE_DIR",
                QStandardPaths::writableLocation(QStandardPaths::GenericCacheLocation).toUtf8());
    for (const char* name :
         {"XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_CACHE_HOME", "XDG_STATE_HOME", "XDG_RUNTIME_DIR"}) {
        const QString folder = root + '/' + name;
        QDir().mkpath(folder);
        QFile::setPermissions(folder, QFile::ReadOwner | QFile::WriteOwner | QFile::ExeOwner);
        qputenv(name, folder.toUtf8());
    }
}

} // namespace

int main(int argc, char** argv) {
    const bool lists = onlyLists(argc, argv); // needs no display
    ::testing::InitGoogleTest(&argc, argv);
    if (lists) return RUN_ALL_TESTS();
    const QTemporaryDir folder;
    useFolders(folder.path());
    const QString noDisplay = lumorph::studio::prepareApplication(argc, argv);
    if (!noDisplay.isEmpty()) {
        std::fputs(noDisplay.toUtf8().constData(), stderr);
        return 1;
    }
    lumorph::studio::StudioApplication application(argc, argv);
    QApplication::setQuitOnLastWindowClosed(false);
    lumorph::studio::applyTheme(application, lumorph::Theme::dark);
    return RUN_ALL_TESTS();
}
