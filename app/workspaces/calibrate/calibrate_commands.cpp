#include "app/workspaces/calibrate/calibrate_commands.h"

#include <QApplication>

#include "app/workspaces/common/export_dialogs.h"

namespace lumorph::studio {
namespace {

QAction* addCalibrateAction(const CalibrateParts& parts, const char* id, const QString& text, const char* icon,
                            const QString& tip, std::function<void()> run, const QKeySequence& keys = {}) {
    Commands::Options options;
    options.icon = icon;
    options.menu = "Hardware";
    options.shortcut = keys;
    options.workspace = "calibrate";
    QAction* action = parts.studio.commands.add(id, text, options, std::move(run));
    action->setToolTip(tip);
    return action;
}

} // namespace

void useFolder(CalibrationService& service, Settings& settings, const std::filesystem::path& folder) {
    CalibrationSetup setup = keptSetup(settings, CaptureWay::folder);
    if (service.state().setup.way == CaptureWay::folder) setup = service.state().setup;
    setup.folder = folder;
    service.setSetup(setup);
}

void askForImages(const CalibrateParts& parts) {
    askFolder(
        QApplication::activeWindow(), parts.studio.settings, "calibrate.folder",
        "Folder of images: in it one folder for each pose",
        [parts](const QString& folder) { useFolder(parts.service, parts.studio.settings, folder.toStdString()); },
        "Choose");
}

void addCalibrateCommands(const CalibrateParts& parts) {
    CalibrationService& service = parts.service;
    QAction* next = addCalibrateAction(
        parts, "calibrate.next", "Next step of the calibration", "play", "What the card over the picture offers",
        [parts] {
            if (nextOf(parts.service.state()).what == NextStep::Do::chooseFolder)
                askForImages(parts);
            else
                parts.service.doNext();
        },
        QKeySequence(Qt::CTRL | Qt::Key_Return));
    QAction* rest =
        addCalibrateAction(parts, "calibrate.rest", "Photograph all poses", "record",
                           "The lab lays the board for you, pose after pose", [&service] { service.photographRest(); });
    QAction* anew =
        addCalibrateAction(parts, "calibrate.anew", "Begin the calibration anew", "reset",
                           "Forgets poses and result; what the room uses stays", [&service] { service.beginAnew(); });
    addCalibrateAction(parts, "calibrate.lab", "Calibrate in the virtual lab", "lab", "Without any hardware",
                       [&service] { service.setWay(CaptureWay::lab); });
    addCalibrateAction(parts, "calibrate.folder", "Calibrate from a folder of images...", "folder",
                       "Photographs that were taken before, one folder for each pose",
                       [parts] { askForImages(parts); });
    addCalibrateAction(parts, "calibrate.camera", "Calibrate with a camera", "picture",
                       "A camera of this machine, and the projector's output window",
                       [&service] { service.setWay(CaptureWay::camera); });
    QAction* use = addCalibrateAction(parts, "calibrate.use", "Use this calibration", "check",
                                      "The room's projector gets these figures; undo takes them back",
                                      [&service] { service.use(); });
    const auto follow = [=, &service] {
        const CalibrationState& state = service.state();
        const NextStep step = nextOf(state);
        const bool works = state.work != CalibrationState::Work::none;
        next->setEnabled(!step.button.isEmpty());
        rest->setEnabled(state.setup.way == CaptureWay::lab && !works && state.counting() < state.setup.poses);
        anew->setEnabled(!state.poses.empty() || state.refusal || !state.trouble.isEmpty());
        use->setEnabled(state.isSolved() && !state.isUsed() && !works);
    };
    QObject::connect(&service, &CalibrationService::changed, next, follow);
    follow();
}

} // namespace lumorph::studio
