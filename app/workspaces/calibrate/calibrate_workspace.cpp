#include "app/workspaces/calibrate/calibrate_workspace.h"

#include "app/workspaces/calibrate/calibrate_commands.h"
#include "app/workspaces/calibrate/calibrate_docks.h"
#include "core/base/error.h"

namespace lumorph::studio {
namespace {

CalibrationService::DisplayOpener displayOpener(Studio& /*studio*/) {
    return [](std::size_t) -> std::unique_ptr<PatternDisplay> {
        throw DeviceError("projector", "patterns cannot be shown yet", "use a folder of images");
    };
}

CalibrationService::VersionTaker versionTaker(Studio& studio) {
    return [&studio](const CalibrationState& /*state*/, const Installation& installation) {
        const auto taken = std::make_shared<const Installation>(installation);
        studio.document.change("Use the calibration", [&](StudioState& state) { state.installation = taken; });
        return true;
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
            {"dock.calibrate.result", "Result", "target", makeResultDock(parts), Qt::RightDockWidgetArea, false}};
}

void CalibrateWorkspace::setActive(bool active) { service_.setActive(active); }

bool CalibrateWorkspace::takeDrop(const std::vector<std::filesystem::path>& files) {
    std::error_code none;
    if (files.size() != 1 || !std::filesystem::is_directory(files.front(), none)) return false;
    useFolder(service_, studio_.settings, files.front());
    return true;
}

} // namespace lumorph::studio
