#include "app/workspaces/calibrate/calibrate_workspace.h"

#include <algorithm>

#include <QHBoxLayout>
#include <QStackedWidget>
#include <QVBoxLayout>

#include "app/studio/calibration/table_bench.h"
#include "app/studio/output/pattern_screen.h"
#include "app/studio/widgets/segments.h"
#include "app/workspaces/calibrate/calibrate_commands.h"
#include "app/workspaces/calibrate/calibrate_docks.h"
#include "app/workspaces/calibrate/chain_docks.h"
#include "calibration/verify/verify_lab.h"
#include "core/base/error.h"

namespace lumorph::studio {
namespace {

/// The projector's own window; where it is not open yet it goes to a screen beside the studio's, if there is one.
void openOutput(ProjectorOutputs& outputs, std::size_t projector) {
    if (outputs.window(projector) == nullptr) outputs.useScreen(projector, outputs.freeScreen());
    if (outputs.window(projector) == nullptr) outputs.showInWindow(projector);
}

CalibrationService::DisplayOpener displayOpener(Studio& studio) {
    return [&studio](std::size_t projector) -> std::unique_ptr<PatternDisplay> {
        openOutput(studio.outputs, projector);
        return std::make_unique<PatternScreen>(studio.outputs, projector);
    };
}

CameraOpener cameraOpener(Studio& studio) {
    return [&studio](const std::string& address) {
        return studio.openCamera ? studio.openCamera(address) : openCaptureCamera(address);
    };
}

ChainService::TableOpener tableOpener(Studio& studio) {
    return [&studio](const Installation& room, bool isMoved) {
        TableParts parts{&studio.devices, displayOpener(studio), cameraOpener(studio)};
        parts.drawSeconds = [&studio] { return 1e-3 * studio.show.usualDelay(); };
        parts.board = boardText(keptSetup(studio.settings, CaptureWay::camera).board);
        return openTable(parts, room, isMoved);
    };
}

CalibrationService::VersionTaker versionTaker(Studio& studio) {
    return [&studio](const CalibrationState& state, const Installation& installation) {
        return studio.room.takeVersion(versionOf(state, installation));
    };
}

CrosshairService::Shower crosshairShower(Studio& studio) {
    return [&studio](std::size_t projector, const QImage& picture) {
        const std::string name = "projector " + std::to_string(projector + 1);
        if (!picture.isNull()) openOutput(studio.outputs, projector);
        ProjectorWindow* window = studio.outputs.window(projector);
        if (window == nullptr) {
            if (picture.isNull()) return;
            throw DeviceError(name, "its picture is not shown", "open it on the projector's screen");
        }
        window->setCalibrationPicture(picture, 0);
        if (picture.isNull()) return;
        if (const QString problem = window->calibrationProblem(); !problem.isEmpty())
            throw DeviceError(name, "cannot show the crosshair pixel by pixel", problem.toStdString());
    };
}

} // namespace

CalibrateWorkspace::CalibrateWorkspace(Studio& studio)
    : studio_(studio), service_(studio.settings, studio.document, studio.jobs, studio.notices, cameraOpener(studio),
                                displayOpener(studio), versionTaker(studio)),
      crosshairs_(studio.document, crosshairShower(studio),
                  [&studio](const InstallationVersion& version) { return studio.room.takeVersion(version); }),
      live_(studio.trackers, [show = crosshairShower(studio)](const QImage& picture) { show(0, picture); }),
      chain_(studio.document, studio.loop, studio.lab, studio.jobs, studio.notices, live_, tableOpener(studio),
             [&studio](InstallationVersion version) { return studio.room.takeVersion(std::move(version)); }) {
    connect(&chain_, &ChainService::handsOff, &studio.sound, [&studio] { studio.sound.signal(kHandsOffSound); });
    addCalibrateCommands(parts());
    addWatchCommand();
    connect(&service_, &CalibrationService::changed, this, [this] { setActive(active_); });
    connect(&selection_, &CalibrateSelection::wholeChanged, this, [this] { setActive(active_); });
}

/// By the room's camera; without one by the lab's, which sees what truly stands there as the watch begins.
std::unique_ptr<DriftService> CalibrateWorkspace::makeWatch() {
    const auto camera = [this] {
        const Installation& room = *studio_.document.state().installation;
        const std::string address = room.cameras.empty() ? std::string() : room.cameras.front().address;
        return address.empty() ? labShowCamera(withLabCamera(studio_.lab.truth())) : machineShowCamera(address);
    };
    return std::make_unique<DriftService>(sentShowOf(studio_.show), camera, studio_.notices, [this] { checkRoom(); });
}

/// By the camera that watches.
void CalibrateWorkspace::checkRoom() {
    emit studio_.commands.workspaceWanted("calibrate");
    selection_.setWhole(true);
    selection_.setPage(CalibrateSelection::Page::link);
    const auto& links = chainLinks();
    const auto found = std::ranges::find(links, LinkId::check, &ChainLink::id);
    chain_.choose(static_cast<std::size_t>(found - links.begin()));
    const auto& cameras = studio_.document.state().installation->cameras;
    if (!cameras.empty() && !cameras.front().address.empty()) chain_.setWay(LinkWay::live);
}

void CalibrateWorkspace::addWatchCommand() {
    Commands::Options options;
    options.icon = "eye";
    options.menu = "Hardware";
    options.checkable = true;
    watchAction_ = studio_.commands.add("calibrate.watch", "Watch the running show", options, {});
    connect(&studio_.lab, &LabRoom::changed, this, [this] { followWatch(); });
    connect(&studio_.document, &StudioDocument::changed, this, [this](StateParts parts) {
        if (parts & StatePart::installation) followWatch();
    });
    followWatch();
    connect(&studio_.watch, &WatchBoard::checkWanted, this, [this] { checkRoom(); });
    connect(watchAction_, &QAction::toggled, this, [this](bool on) {
        if (!watch_) {
            watch_ = makeWatch();
            connect(watch_.get(), &DriftService::changed, this, [this] { tellWatch(); });
        }
        watch_->setWatching(on);
    });
}

/// In the status line; the gravest first.
void CalibrateWorkspace::tellWatch() {
    const DriftReport& drift = watch_->drift();
    const OutputReport& output = watch_->output();
    WatchStand stand;
    if (!watch_->isWatching())
        stand = {};
    else if (output.state == OutputReport::State::black)
        stand = {"Watch: a projector is dark", output.sentence, WatchStand::How::alarm};
    else if (output.state == OutputReport::State::frozen)
        stand = {"Watch: the picture is frozen", output.sentence, WatchStand::How::alarm};
    else if (drift.state == DriftReport::State::moved)
        stand = {"Watch: something has moved", drift.sentence, WatchStand::How::alarm};
    else if (output.state == OutputReport::State::blind)
        stand = {"Watch: cannot tell", output.sentence, WatchStand::How::unsure};
    else if (drift.state == DriftReport::State::blind)
        stand = {"Watch: light comes, its place is unknown", drift.sentence, WatchStand::How::unsure};
    else if (drift.state == DriftReport::State::good)
        stand = {"Watch: all in place", drift.sentence, WatchStand::How::good};
    else
        stand = {"Watch: looking", "It has not seen enough yet.", WatchStand::How::unsure};
    studio_.watch.set(std::move(stand));
}

/// Why the running show cannot be watched; empty: it can. As long as the lab is packed its truth is what is believed,
/// and a watch would see its own belief.
QString CalibrateWorkspace::watchObstacle() const {
    const Installation& room = *studio_.document.state().installation;
    if (room.projectors.empty()) return "the room has no projector: add one in Scene";
    if (!room.cameras.empty() && !room.cameras.front().address.empty()) return {};
    if (studio_.lab.isUnpacked()) return {};
    return "the room has no camera of this machine: calibrate projector and camera with one first";
}

void CalibrateWorkspace::followWatch() {
    const QString obstacle = watchObstacle();
    if (!obstacle.isEmpty()) watchAction_->setChecked(false);
    watchAction_->setEnabled(obstacle.isEmpty());
    watchAction_->setToolTip(obstacle.isEmpty()
                                 ? "By the room's camera, in the virtual lab by the lab's: tells when something has "
                                   "moved, or a projector is black or frozen"
                                 : "It cannot watch: " + obstacle);
}

QString CalibrateWorkspace::id() const { return "calibrate"; }
QString CalibrateWorkspace::title() const { return "Calibrate"; }

QWidget* CalibrateWorkspace::makeCentralView() {
    auto* views = new QStackedWidget;
    views->addWidget(makeCalibrateView(parts()));
    views->addWidget(makeCrosshairView(parts()));
    const auto follow = [this, views] {
        const CalibrationState& state = service_.state();
        views->setCurrentIndex(state.setup.way == CaptureWay::crosshairs && !state.isImported ? 1 : 0);
    };
    connect(&service_, &CalibrationService::changed, views, follow);
    follow();
    auto* chain = new QStackedWidget; // in the order of CalibrateSelection::Page
    for (QWidget* page : {makeChainView(parts()), makeConnectedView(parts()), makeBudgetView(parts())})
        chain->addWidget(page);
    const auto turn = [this, chain] { chain->setCurrentIndex(static_cast<int>(selection_.page())); };
    connect(&selection_, &CalibrateSelection::pageChanged, chain, turn);
    turn();
    return makeSwitched(views, chain);
}

CalibrateParts CalibrateWorkspace::parts() { return {studio_, service_, crosshairs_, live_, chain_, selection_}; }

/// One or the other, by what is looked at.
QWidget* CalibrateWorkspace::makeSwitched(QWidget* single, QWidget* whole) {
    auto* both = new QStackedWidget;
    both->addWidget(single);
    both->addWidget(whole);
    const auto follow = [this, both] { both->setCurrentIndex(selection_.whole() ? 1 : 0); };
    connect(&selection_, &CalibrateSelection::wholeChanged, both, follow);
    follow();
    return both;
}

namespace {

/// What of both is seen, over what is switched.
QWidget* withSwitch(CalibrateSelection& selection, QWidget* switched) {
    auto* dock = new QWidget;
    auto* column = new QVBoxLayout(dock);
    column->setContentsMargins(0, 8, 0, 0);
    column->setSpacing(8);
    auto* segments = new Segments({{"calibrate.single", "Projector and camera", "Their sequence, step by step"},
                                   {"calibrate.whole", "Whole chain", "From boxes to a calibrated show"}},
                                  dock);
    auto* row = new QHBoxLayout;
    row->setContentsMargins(16, 0, 16, 0);
    row->addWidget(segments);
    column->addLayout(row);
    column->addWidget(switched, 1);
    QObject::connect(segments, &Segments::chosen, &selection,
                     [&selection](int index) { selection.setWhole(index == 1); });
    const auto follow = [segments, &selection] { segments->setChosen(selection.whole() ? 1 : 0); };
    QObject::connect(&selection, &CalibrateSelection::wholeChanged, segments, follow);
    follow();
    return dock;
}

} // namespace

std::vector<WorkspaceDock> CalibrateWorkspace::makeDocks() {
    QWidget* steps = withSwitch(selection_, makeSwitched(makeStepsDock(parts()), makeChainLinks(parts())));
    QWidget* result = makeSwitched(makeResultDock(parts()), makeChainResult(parts()));
    return {{"dock.calibrate.steps", "Steps", "check", steps, Qt::LeftDockWidgetArea, false},
            {"dock.calibrate.result", "Result", "target", result, Qt::RightDockWidgetArea, false},
            {"dock.calibrate.versions", "Versions", "clock", makeVersionsDock(parts()), Qt::RightDockWidgetArea, true}};
}

void CalibrateWorkspace::setActive(bool active) {
    active_ = active;
    look();
    crosshairs_.setProjector(service_.projector());
    crosshairs_.setActive(active && service_.state().setup.way == CaptureWay::crosshairs);
}

/// The crosshairs stay on their projector, whether the window is seen or not.
void CalibrateWorkspace::setSeen(bool seen) {
    seen_ = seen;
    look();
}

void CalibrateWorkspace::look() {
    const bool looks = seen_ && !selection_.whole(); // nobody sees the camera's picture beside the whole chain
    service_.setHolding(active_ && !selection_.whole());
    if (looks != looks_) service_.setActive(looks);
    looks_ = looks;
}

bool CalibrateWorkspace::takeDrop(const std::vector<std::filesystem::path>& files) {
    std::error_code none;
    if (files.size() != 1 || !std::filesystem::is_directory(files.front(), none)) return false;
    useFolder(service_, studio_.settings, files.front());
    return true;
}

} // namespace lumorph::studio
