#include "app/workspaces/calibrate/calibrate_commands.h"

#include <span>

#include <QApplication>
#include <QDate>

#include "app/output/pattern_export.h"
#include "app/workspaces/calibrate/error_map_view.h"
#include "app/workspaces/common/export_dialogs.h"
#include "calibration/tracking/board_page.h"
#include "core/base/atomic_file.h"

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

void askExport(const CalibrateParts& parts) {
    askFile(QApplication::activeWindow(), parts.studio.settings, "calibrate.export", "Export the calibration",
            "calibration", {{"Lumorph's calibration (JSON)", "json"}, {"OpenCV (YAML)", "yaml"}},
            [parts](const QString& file) { parts.service.exportTo(file.toStdString()); });
}

/// The error map as it is seen on the screen.
std::vector<ReportPicture> mapOf(const CalibrateParts& parts) {
    const auto& result = parts.service.state().result;
    if (!result || !result->plan) return {};
    ErrorMapView view;
    view.resize(1000, 460);
    view.show(result->plan, deviceOutlineOf(parts.studio.document.state()));
    const QImage image = view.grab().toImage().convertToFormat(QImage::Format_BGR888);
    const cv::Mat picture(image.height(), image.width(), CV_8UC3, const_cast<uchar*>(image.bits()),
                          static_cast<std::size_t>(image.bytesPerLine()));
    return {{"How far light may land beside, on the table and above it", picture.clone()}};
}

void askReport(const CalibrateParts& parts) {
    askFile(QApplication::activeWindow(), parts.studio.settings, "calibrate.report", "Write a report",
            "calibration-report", {{"PDF", "pdf"}, {"Web page (HTML)", "html"}},
            [parts](const QString& file) { parts.service.reportTo(file.toStdString(), mapOf(parts)); });
}

void askImport(const CalibrateParts& parts) {
    askFileToOpen(QApplication::activeWindow(), parts.studio.settings, "calibrate.import", "Import a calibration",
                  "Calibrations (*.json *.yaml *.yml *.xml *.txt *.JSON *.YAML *.YML *.XML)",
                  [parts](const QString& file) {
                      parts.selection.setWhole(false); // where its figures and its button are
                      parts.service.importFrom(file.toStdString());
                  });
}

void doNextOfCalibration(const CalibrateParts& parts) {
    const NextStep::Do what = nextOf(parts.service.state()).what;
    if (what == NextStep::Do::chooseFolder) return askForImages(parts);
    if (what == NextStep::Do::nothing && parts.service.state().isUsed()) return parts.selection.setWhole(true);
    parts.service.doNext();
}

void doNextOfChain(const CalibrateParts& parts) {
    const ChainState& state = parts.chain.state();
    const ChainStep::Do what = stepOf(state).what;
    if (what == ChainStep::Do::sequence) return parts.selection.setWhole(false);
    if (what == ChainStep::Do::chooseFile)
        return askForRecording(parts, state.chosen, missingFile(state, state.chosen).value_or(0));
    parts.chain.doNext();
}

/// Shows a page of the whole chain; checked while that page is shown.
void addPageAction(const CalibrateParts& parts, const char* id, const QString& text, const char* icon,
                   const QString& tip, CalibrateSelection::Page page) {
    QAction* action = addCalibrateAction(parts, id, text, icon, tip, [parts, page] {
        parts.selection.setWhole(true);
        parts.selection.setPage(page);
    });
    action->setCheckable(true);
    const auto follow = [parts, action, page] { action->setChecked(parts.selection.page() == page); };
    QObject::connect(&parts.selection, &CalibrateSelection::pageChanged, action, follow);
    QObject::connect(action, &QAction::triggered, action, follow); // a second click does not uncheck it
}

/// Each link by its own name in the palette.
void addChainCommands(const CalibrateParts& parts) {
    for (std::size_t k = 1; k < chainLinks().size(); ++k) {
        const ChainLink& link = chainLinks()[k];
        Commands::Options options;
        options.icon = "target";
        options.workspace = "calibrate";
        QAction* action = parts.studio.commands.add(QString("calibrate.chain.") + link.key, "Calibrate: " + link.title,
                                                    options, [parts, k] {
                                                        parts.selection.setWhole(true);
                                                        parts.selection.setPage(CalibrateSelection::Page::link);
                                                        parts.chain.choose(k);
                                                    });
        action->setToolTip(link.purpose);
    }
}

} // namespace

QString buttonOf(const CalibrationState& state) {
    const NextStep step = nextOf(state);
    return step.button.isEmpty() && state.isUsed() ? "Go on with the chain" : step.button;
}

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

void askForOrder(const CalibrateParts& parts) {
    askFileToOpen(QApplication::activeWindow(), parts.studio.settings, "calibrate.order",
                  "What each image shows: one line an image", "Order files (*.txt);;All files (*)",
                  [parts](const QString& file) {
                      CalibrationSetup setup = parts.service.state().setup;
                      setup.order = file.toStdString();
                      parts.service.setSetup(setup);
                  });
}

void askForRecording(const CalibrateParts& parts, std::size_t link, std::size_t file) {
    if (file == chainLinks()[link].files.size())
        return askFileToOpen(QApplication::activeWindow(), parts.studio.settings, "chain.recording",
                             "The description in a recording's folder", "Recordings (recording.json)",
                             [parts, link, file](const QString& path) {
                                 parts.chain.setFile(link, file,
                                                     std::filesystem::path(path.toStdString()).parent_path());
                             });
    const LinkFile& wanted = chainLinks()[link].files[file];
    askFileToOpen(QApplication::activeWindow(), parts.studio.settings, "chain.recording",
                  wanted.title + ": " + wanted.words, "Recordings (*.csv *.txt);;All files (*)",
                  [parts, link, file](const QString& path) { parts.chain.setFile(link, file, path.toStdString()); });
}

void askToKeepRecording(const CalibrateParts& parts, std::size_t link) {
    askNewFolder(
        QApplication::activeWindow(), parts.studio.settings, "chain.keep", "A new folder for the recording",
        QString("%1-%2").arg(chainLinks()[link].key, QDate::currentDate().toString(Qt::ISODate)),
        [parts, link](const QString& folder) { parts.chain.keepRecording(link, folder.toStdString()); }, "Keep");
}

void askToPrintBoard(const CalibrateParts& parts) {
    askFile(QApplication::activeWindow(), parts.studio.settings, "calibrate.board", "Write the board to print", "board",
            {{"PDF of true size", "pdf"}}, [parts](const QString& file) {
                try {
                    const std::string pdf = calibrationBoardPdf(parts.service.state().setup.board);
                    writeFileAtomically(file.toStdString(), std::as_bytes(std::span(pdf)));
                } catch (const std::exception& error) {
                    parts.studio.notices.post("calibrate", noticeOf(error));
                }
            });
}

void askToWritePatterns(const CalibrateParts& parts) {
    constexpr double kPace = 2.0; // seconds: time for a finger on a shutter
    askNewFolder(
        QApplication::activeWindow(), parts.studio.settings, "calibrate.patterns", "A new folder for the patterns",
        "patterns",
        [parts](const QString& folder) {
            const CalibrationSetup setup = parts.service.state().setup;
            parts.studio.jobs.run<bool>(
                "calibrate", "Writing the patterns",
                [setup, folder](const Progress& progress) {
                    writePatterns(orderOf(setup), folder.toStdString(), kPace, progress);
                    return true;
                },
                [](bool) {},
                [parts](const std::exception& error) { parts.studio.notices.post("calibrate", noticeOf(error)); });
        },
        "Write");
}

void askForSaved(const CalibrateParts& parts) {
    askFolder(
        QApplication::activeWindow(), parts.studio.settings, "calibrate.saved",
        "Folder for poses: each calibration gets a dated one in it",
        [parts](const QString& folder) {
            CalibrationSetup setup = parts.service.state().setup;
            setup.saved = folder.toStdString();
            parts.service.setSetup(setup);
        },
        "Choose");
}

bool offersAnother(const CalibrationState& state) {
    return isLive(state.setup.way) && state.isSolved() && !state.isImported &&
           state.work == CalibrationState::Work::none;
}

void addCalibrateCommands(const CalibrateParts& parts) {
    CalibrationService& service = parts.service;
    QAction* next = addCalibrateAction(
        parts, "calibrate.next", "Next step of the calibration", "play", "What the card over the picture offers",
        [parts] { parts.selection.whole() ? doNextOfChain(parts) : doNextOfCalibration(parts); },
        QKeySequence(Qt::CTRL | Qt::Key_Return));
    QAction* rest =
        addCalibrateAction(parts, "calibrate.rest", "Photograph all poses", "record",
                           "The lab lays the board for you, pose after pose", [&service] { service.photographRest(); });
    QAction* another = addCalibrateAction(parts, "calibrate.another", "Photograph another pose", "record",
                                          "As the outline in the live picture shows; it is solved again with all",
                                          [&service] { service.photograph(); });
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
    addCalibrateAction(parts, "calibrate.crosshairs", "Calibrate without a camera", "target",
                       "Lay the projector's crosshair onto points of the device",
                       [&service] { service.setWay(CaptureWay::crosshairs); });
    QAction* use = addCalibrateAction(parts, "calibrate.use", "Use this calibration", "check",
                                      "The room's projector gets these figures; undo takes them back",
                                      [&service] { service.use(); });
    QAction* save = addCalibrateAction(parts, "calibrate.export", "Export the calibration...", "export",
                                       "As JSON, or as YAML that OpenCV reads", [parts] { askExport(parts); });
    save->setIconText("Export...");
    addCalibrateAction(parts, "calibrate.import", "Import a calibration...", "open",
                       "Of Lumorph, or of other programs: OpenCV, ROS, Kalibr, SLStudio, procam-calibration",
                       [parts] { askImport(parts); })
        ->setIconText("Import...");
    QAction* report =
        addCalibrateAction(parts, "calibrate.report", "Write a report of the calibration...", "file",
                           "Figures, poses and pictures as PDF or as a web page", [parts] { askReport(parts); });
    report->setIconText("Report...");
    addCalibrateAction(parts, "calibrate.chain", "From boxes to a calibrated show", "target",
                       "Projector, pointer tip, tracker, device, eye, servos, delays, light: measured one after the "
                       "other, and verified",
                       [parts] {
                           parts.selection.setWhole(true);
                           parts.selection.setPage(CalibrateSelection::Page::link);
                       });
    addPageAction(parts, "calibrate.connected", "What is connected", "link",
                  "Projectors, camera, tracker, device and servos: what there is, and what is missing",
                  CalibrateSelection::Page::connected);
    addPageAction(parts, "calibrate.budget", "Where the millimetres come from", "target",
                  "Each part's share of how far pictures slip, and what would help most",
                  CalibrateSelection::Page::budget);
    QAction* rest2 = addCalibrateAction(parts, "calibrate.chain.rest", "Measure all that is missing", "play",
                                        "In the lab, one after the other; ends where something needs you",
                                        [parts] { parts.chain.measureRest(); });
    addChainCommands(parts);
    const auto follow = [=, &service] {
        report->setEnabled(service.state().result || !service.state().poses.empty());
        save->setEnabled(service.state().result != nullptr);
        const CalibrationState& state = service.state();
        const bool works = state.work != CalibrationState::Work::none;
        const ChainState& chain = parts.chain.state();
        next->setEnabled(parts.selection.whole() ? !stepOf(chain).button.isEmpty() : !buttonOf(state).isEmpty());
        rest2->setEnabled(!chain.session.running() && chain.session.next().has_value());
        rest->setEnabled(state.setup.way == CaptureWay::lab && !works && state.counting() < state.setup.poses);
        another->setEnabled(offersAnother(state));
        anew->setEnabled(!state.poses.empty() || state.isImported || state.refusal || !state.trouble.isEmpty());
        use->setEnabled(state.isSolved() && !state.isUsed() && !works);
    };
    QObject::connect(&service, &CalibrationService::changed, next, follow);
    QObject::connect(&parts.chain, &ChainService::changed, next, follow);
    QObject::connect(&parts.selection, &CalibrateSelection::wholeChanged, next, follow);
    follow();
}

} // namespace lumorph::studio
