#include "app/workspaces/calibrate/calibrate_workspace.h"

#include <QGuiApplication>
#include <QScreen>

#include "app/studio/output/pattern_screen.h"
#include "app/workspaces/calibrate/calibrate_commands.h"
#include "app/workspaces/calibrate/calibrate_docks.h"

namespace lumorph::studio {
namespace {

/// The projector's own window; where it is not open yet it goes to a second screen, if there is one.
CalibrationService::DisplayOpener displayOpener(Studio& studio) {
    return [&studio](std::size_t projector) -> std::unique_ptr<PatternDisplay> {
        if (studio.outputs.window(projector) == nullptr) {
            const QScreen* own = QGuiApplication::primaryScreen();
            for (const QScreen* screen : QGuiApplication::screens())
                if (screen != own) {
                    studio.outputs.showOnScreen(projector, screen->name());
                    break;
                }
        }
        if (studio.outputs.window(projector) == nullptr) studio.outputs.showInWindow(projector);
        return std::make_unique<PatternScreen>(studio.outputs, projector);
    };
}

CalibrationService::VersionTaker versionTaker(Studio& studio) {
    return [&studio](const CalibrationState& state, const Installation& installation) {
        return studio.room.takeVersion(versionOf(state, installation));
    };
}

} // namespace

CalibrateWorkspace::CalibrateWorkspace(Studio& studio)
    : studio_(studio), service_(studio.settings, studio.document, studio.jobs, studio.notices, displayOpener(studio),
                                versionTaker(studio)) {
    addCalibrateCommands({studio_, service_, selection_});
}

QString CalibrateWorkspace::id() const { return "calibrate"; }
QString CalibrateWorkspace::title() const { return "Calibrate"; }

QWidget* CalibrateWorkspace::makeCentralView() { return makeCalibrateView({studio_, service_, selection_}); }

std::vector<WorkspaceDock> CalibrateWorkspace::makeDocks() {
    const CalibrateParts parts{studio_, service_, selection_};
    return {{"dock.calibrate.steps", "Steps", "check", makeStepsDock(parts), Qt::LeftDockWidgetArea, false},
            {"dock.calibrate.result", "Result", "target", makeResultDock(parts), Qt::RightDockWidgetArea, false},
            {"dock.calibrate.versions", "Versions", "clock", makeVersionsDock(parts), Qt::RightDockWidgetArea, true}};
}

void CalibrateWorkspace::setActive(bool active) { service_.setActive(active); }

bool CalibrateWorkspace::takeDrop(const std::vector<std::filesystem::path>& files) {
    std::error_code none;
    if (files.size() != 1 || !std::filesystem::is_directory(files.front(), none)) return false;
    useFolder(service_, studio_.settings, files.front());
    return true;
}

} // namespace lumorph::studio
