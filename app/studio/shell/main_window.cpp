#include "app/studio/shell/main_window.h"

#include <algorithm>
#include <map>
#include <utility>

#include <QApplication>
#include <QCloseEvent>
#include <QDialog>
#include <QDropEvent>
#include <QScreen>
#include <QStackedWidget>
#include <QTimer>
#include <QVBoxLayout>

#include "app/applications/demo.h"
#include "app/studio/look/palette.h"
#include "app/studio/shell/command_palette.h"
#include "app/studio/shell/dialog_fit.h"
#include "app/studio/shell/drop_overlay.h"
#include "app/studio/shell/escape_twice.h"
#include "app/studio/shell/file_commands.h"
#include "app/studio/shell/idle_cursor.h"
#include "app/studio/shell/kiosk.h"
#include "app/studio/shell/loop_rest.h"
#include "app/studio/shell/menus.h"
#include "app/studio/shell/replay_bar.h"
#include "app/studio/shell/second_studio.h"
#include "app/studio/shell/shell_commands.h"
#include "app/studio/shell/sight_watch.h"
#include "app/studio/shell/status_line.h"
#include "app/studio/shell/stop_key_watch.h"
#include "app/studio/shell/top_bar.h"
#include "app/studio/shell/tour.h"
#include "app/studio/shell/visitor_desk.h"
#include "app/studio/shell/workspace_page.h"
#include "app/studio/widgets/panel.h"

namespace lumorph::studio {
namespace {

constexpr QSize kUsualSize{1440, 900};
constexpr QMargins kUsualFrame{4, 36, 4, 4}; // what a desktop puts around a window
constexpr auto kFrameKey = "window/frame";
constexpr auto kGeometryKey = "window/geometry";
constexpr auto kWorkspaceKey = "window/workspace";

QSize sizeOf(const QMargins& frame) { return {frame.left() + frame.right(), frame.top() + frame.bottom()}; }

/// Before it is shown nobody knows what the desktop will put around it, so the frame of last time stands for it.
QMargins keptFrame(const Settings& settings) {
    const QVariantList kept = settings.value(kFrameKey).toList();
    if (kept.size() != 4) return kUsualFrame;
    const auto side = [&kept](int i) { return std::clamp(kept[i].toInt(), 0, 100); };
    return {side(0), side(1), side(2), side(3)};
}

QVariantList frameOf(const QWidget& window) {
    const QRect outer = window.frameGeometry(), inner = window.geometry();
    return {inner.left() - outer.left(), inner.top() - outer.top(), outer.right() - inner.right(),
            outer.bottom() - inner.bottom()};
}

} // namespace

struct MainWindow::Data {
    Data(Studio& shared, std::vector<std::unique_ptr<Workspace>> all) : studio(shared), workspaces(std::move(all)) {}

    Studio& studio;
    std::vector<std::unique_ptr<Workspace>> workspaces;
    SteadyClock clock;
    std::map<QString, WorkspacePage*> pages; ///< those that were shown
    TopBar* bar = nullptr;
    Menus* menus = nullptr;
    StatusLine* status = nullptr;
    QStackedWidget* stack = nullptr;
    QWidget* homeNotices = nullptr; ///< what concerns the whole program
    QPointer<DropOverlay> drop;
    std::unique_ptr<StopKeyWatch> stopKeys;
    EscapeTwice* escape = nullptr;
    QString present;
    Kiosk* kiosk = nullptr;
    VisitorDesk* desk = nullptr;
    SightWatch* sight = nullptr;
    LoopRest* loopRest = nullptr;
    IdleCursor* idleCursor = nullptr; ///< while visitors have the window
    bool maximized = false;           ///< before they had it
    QUndoGroup stacks{nullptr};
};

MainWindow::MainWindow(Studio& studio, std::vector<std::unique_ptr<Workspace>> workspaces)
    : data_(new Data(studio, std::move(workspaces))) {
    setObjectName("mainWindow");
    setAcceptDrops(true);
    setContextMenuPolicy(Qt::NoContextMenu);
    setMinimumSize(760, 400);
    connect(&studio.commands, &Commands::workspaceWanted, this, &MainWindow::showWorkspace);
    addCommands();
    data_->bar = new TopBar(studio, data_->workspaces, this);
    data_->menus = new Menus(studio, data_->bar->menuBar(), *this);
    setMenuWidget(data_->bar);
    auto* body = new QWidget(this);
    auto* column = new QVBoxLayout(body);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(0);
    data_->stack = new QStackedWidget(body);
    data_->status = new StatusLine(studio, body);
    data_->homeNotices = new QWidget(body); // over the cards, too
    auto* home = new QVBoxLayout(data_->homeNotices);
    home->setContentsMargins(0, 0, 0, 0);
    home->addWidget(makeNoticeBar(studio.notices, "home"));
    column->addWidget(data_->homeNotices);
    column->addWidget(data_->stack, 1);
    column->addWidget(makeReplayBar(studio, body));
    column->addWidget(data_->status);
    setCentralWidget(body);
    data_->kiosk = new Kiosk(*this, studio.settings, data_->clock, data_->bar->kioskButtons());
    connect(data_->kiosk, &Kiosk::leaveWanted, this, &MainWindow::leaveKiosk);
    auto* desk = data_->desk = new VisitorDesk(studio, *this, *data_->stack, data_->clock);
    data_->kiosk->setVisitors(
        [desk](const QObject& watched, const QEvent& event) { return desk->mayHave(watched, event); });
    connect(desk, &VisitorDesk::applicationWanted, this, &MainWindow::openApplication);
    connect(desk, &VisitorDesk::studioWanted, this, &MainWindow::leaveFullView);
    connect(desk, &VisitorDesk::tourWanted, this, &MainWindow::startTour);
    connect(desk, &VisitorDesk::coversChanged, this, &MainWindow::followSight);
    data_->loopRest = new LoopRest(studio, this);
    data_->sight = new SightWatch(*this);
    connect(data_->sight, &SightWatch::changed, this, &MainWindow::followSight);
    connect(data_->bar, &TopBar::leaveWanted, this, &MainWindow::leaveFullView);
    connect(data_->bar, &TopBar::workspaceChosen, this, &MainWindow::showWorkspace);
    connect(&studio.document, &StudioDocument::titleChanged, this, &MainWindow::showTitle);
    connect(&studio.settings, &Settings::themeChanged, this, &MainWindow::retheme);
    const auto setRate = [&studio] { studio.loop.setRate(studio.settings.loopRate()); };
    connect(&studio.settings, &Settings::loopRateChanged, this, setRate);
    setRate();
    const auto setLanguage = [&studio] { studio.loop.setLanguage(studio.settings.language()); };
    connect(&studio.settings, &Settings::languageChanged, this, setLanguage);
    setLanguage();
    const auto setQuality = [&studio] { studio.renderer.setStillQuality(studio.settings.stillQuality()); };
    connect(&studio.settings, &Settings::qualityChanged, this, setQuality);
    setQuality();
    const auto setPlacing = [&studio] { studio.project.setPlacesNewTargets(studio.settings.placesNewTargets()); };
    connect(&studio.settings, &Settings::placesNewTargetsChanged, this, setPlacing);
    setPlacing();
    auto* escape = data_->escape = new EscapeTwice(data_->clock, this);
    connect(escape, &EscapeTwice::pressed, &studio.loop, &StudioLoop::stop);
    connect(escape, &EscapeTwice::single, desk, &VisitorDesk::escape);
    connect(escape, &EscapeTwice::pressed, desk, &VisitorDesk::hideCards); // which the first of both may have brought
    // Also while another program has the keyboard, and for the servos while this window is stuck.
    data_->stopKeys = std::make_unique<StopKeyWatch>([&studio] {
        studio.devices.stopNow();
        QMetaObject::invokeMethod(&studio.loop, &StudioLoop::stop, Qt::QueuedConnection);
    });
    studio.devices.setStopKeysProblem(data_->stopKeys->why());
    connect(escape, &EscapeTwice::openChanged, this, [this](bool any) { data_->stopKeys->setSomethingOpen(any); });
    for (const auto answered : {&EscapeTwice::pressed, &EscapeTwice::spent})
        connect(escape, answered, this, [this] { data_->stopKeys->forget(); });
    qApp->installEventFilter(this);
    resize(kUsualSize.boundedTo(screen()->availableSize() - sizeOf(kUsualFrame)));
    if (restoreGeometry(studio.settings.value(kGeometryKey).toByteArray())) keepOnScreen();
    showFirstWorkspace();
    showTitle();
    reportOtherStudio(studio, *this);
}

// A window that is kept may come from a larger screen, or from a smaller scale of this one. By its inner geometry:
// `move` would put the frame where the inside was, a frame further at each start.
void MainWindow::keepOnScreen() {
    if (isMaximized() || isFullScreen()) return;
    const QMargins frame = keptFrame(data_->studio.settings);
    const QRect outer = geometry().marginsAdded(frame);
    if (screen()->availableVirtualGeometry().contains(outer)) return;
    const QScreen* on = QGuiApplication::screenAt(outer.center());
    const QRect there = (on == nullptr ? screen() : on)->availableGeometry();
    QRect fitting(outer.topLeft(), outer.size().boundedTo(there.size()));
    const QSize space = there.size() - fitting.size();
    fitting.moveTo(std::clamp(fitting.left(), there.left(), there.left() + space.width()),
                   std::clamp(fitting.top(), there.top(), there.top() + space.height()));
    setGeometry(fitting.marginsRemoved(frame));
}

MainWindow::~MainWindow() {
    delete std::exchange(data_->sight, nullptr); // what is hidden from here on is no news
    delete data_->kiosk;                         // it hears all that follows
    delete std::exchange(data_->desk, nullptr);
    delete data_->escape; // likewise, and it tells the watch, which is gone when the last child is hidden
    qApp->removeEventFilter(this);
    // Views and docks refer to their workspace, so they go first.
    delete takeCentralWidget();
}

void MainWindow::addCommands() {
    addFileCommands(data_->studio, *this);
    ShellActions does;
    does.startTour = [this] { startTour(); };
    does.showApplications = [this] { showApplications(); };
    does.resetLayout = [this] {
        if (const auto page = data_->pages.find(data_->present); page != data_->pages.end())
            page->second->resetLayout();
    };
    does.present = [this] {
        for (const auto& one : data_->workspaces)
            if (one->id() == data_->present) return one->title();
        return QString();
    };
    does.stacks = &data_->stacks;
    data_->stacks.addStack(&data_->studio.document.undoStack());
    for (const auto& one : data_->workspaces)
        if (QUndoStack* own = one->undoStack()) data_->stacks.addStack(own);
    data_->stacks.setActiveStack(&data_->studio.document.undoStack());
    for (const auto& workspace : data_->workspaces)
        does.workspaces.push_back({workspace->title(), [this, id = workspace->id()] { showWorkspace(id); }});
    does.enterKiosk = [this] { data_->kiosk->requirePin(true, [this] { enterKiosk(); }); };
    does.changePin = [this] { data_->kiosk->changePin(); };
    addShellCommands(data_->studio, *this, does);
}

void MainWindow::showWorkspace(const QString& id) {
    const auto& all = data_->workspaces;
    const auto found = std::find_if(all.begin(), all.end(), [&id](const auto& one) { return one->id() == id; });
    if (found == all.end()) return;
    data_->bar->setWorkspace(id);
    if (data_->desk != nullptr) data_->desk->hideCards();
    if (id == data_->present) return;
    if (const auto old = data_->pages.find(data_->present); old != data_->pages.end()) old->second->setActive(false);
    data_->present = id;
    WorkspacePage*& page = data_->pages[id];
    if (page == nullptr) {
        page = new WorkspacePage(**found, data_->studio.settings, data_->studio.commands, data_->stack);
        data_->stack->addWidget(page);
        if (data_->desk != nullptr && data_->desk->mode() != VisitorDesk::Mode::studio) page->setKiosk(true);
    }
    QUndoStack* own = (*found)->undoStack();
    data_->stacks.setActiveStack(own != nullptr ? own : &data_->studio.document.undoStack());
    data_->menus->show(id);
    data_->stack->setCurrentWidget(page);
    page->setInSight(viewsSeen());
    page->setActive(true);
}

bool MainWindow::viewsSeen() const {
    return data_->sight == nullptr || data_->desk == nullptr || (data_->sight->seen() && !data_->desk->covers());
}

void MainWindow::followSight() {
    const bool seen = viewsSeen();
    data_->loopRest->setSeen(seen);
    for (const auto& [id, page] : data_->pages) page->setInSight(seen);
    if (data_->desk != nullptr) data_->desk->setSeen(seen);
}

/// The one of last time; at first the one where light and shape come together.
void MainWindow::showFirstWorkspace() {
    if (data_->workspaces.empty()) return;
    showWorkspace(data_->studio.settings.value(kWorkspaceKey, "scene").toString());
    if (data_->present.isEmpty()) showWorkspace(data_->workspaces.front()->id());
}

QString MainWindow::workspace() const { return data_->present; }

void MainWindow::startTour() {
    leaveFullView();
    showWorkspace("scene");
    const auto seen = [this] { data_->studio.settings.setTourSeen(true); };
    showTour(*this, tourSteps(data_->studio), seen);
}

void MainWindow::showApplications() { data_->desk->showCards(); }

/// From the cards; visitors stay before the view that fills the window.
void MainWindow::openApplication(const Demo& demo) {
    showWorkspace(QString::fromStdString(demo.workspace));
    enterFullView();
    data_->studio.project.openDemo(demo.name, Audience::visitors, data_->studio.settings.toldTo(demo.name));
}

void MainWindow::enterKiosk() {
    if (data_->kiosk->closed()) return;
    leaveFullView();
    data_->maximized = isMaximized();
    data_->kiosk->close();
    setForVisitors(true, true);
    showFullScreen();
    data_->kiosk->requirePin(false, [] {});
}

void MainWindow::leaveKiosk() {
    if (!data_->kiosk->closed()) return;
    data_->kiosk->open();
    setForVisitors(false, true);
    data_->maximized ? showMaximized() : showNormal();
}

/// As in the kiosk, but for its doors.
void MainWindow::enterFullView() {
    if (data_->desk->mode() != VisitorDesk::Mode::studio) return;
    data_->maximized = isMaximized();
    setForVisitors(true, false);
    showFullScreen();
}

void MainWindow::leaveFullView() {
    if (data_->desk->mode() != VisitorDesk::Mode::full) return;
    setForVisitors(false, false);
    data_->maximized ? showMaximized() : showNormal();
}

void MainWindow::setForVisitors(bool on, bool locked) {
    using Mode = VisitorDesk::Mode;
    data_->menus->setShut(on);
    data_->bar->setForVisitors(on, locked);
    data_->status->setVisible(!on);
    data_->homeNotices->setVisible(!on);
    for (const auto& [id, page] : data_->pages) page->setKiosk(on);
    data_->desk->setMode(!on ? Mode::studio : locked ? Mode::kiosk : Mode::full);
    if (on && !data_->pages.at(data_->present)->hasVisitors()) showWorkspace("scene");
    if (on)
        data_->idleCursor = new IdleCursor(this);
    else
        delete std::exchange(data_->idleCursor, nullptr);
}

void MainWindow::closeNow() {
    leaveKiosk();
    close();
}

void MainWindow::showTitle() {
    const StudioDocument& document = data_->studio.document;
    setWindowTitle(document.name() + (document.modified() ? "*" : "") + " - Lumorph");
}

void MainWindow::retheme() { applyTheme(*qApp, data_->studio.settings.theme()); }

void MainWindow::closeEvent(QCloseEvent* event) {
    if (data_->kiosk->closed() && !qApp->isSavingSession()) {
        event->ignore();
        data_->kiosk->askOperator("To close Lumorph.", [this] { closeNow(); });
        return;
    }
    data_->studio.devices.beginLeave(); // a disk that hangs may hold up what follows
    leaveFullView();                    // it is no layout to come back to
    for (const auto& [id, page] : data_->pages)
        if (id == data_->present) page->keepLayout();
    if (!data_->kiosk->closed()) {
        data_->studio.settings.setValue(kGeometryKey, saveGeometry());
        if (!isMaximized() && !isFullScreen()) data_->studio.settings.setValue(kFrameKey, frameOf(*this));
        data_->studio.settings.setValue(kWorkspaceKey, data_->present);
    }
    data_->studio.project.keepSession();
    event->accept();
    QTimer::singleShot(0, qApp, [] { QCoreApplication::exit(0); }); // floating docks and dialogs are windows too
}

void MainWindow::acceptDrag(QDropEvent& event) {
    event.setDropAction(Qt::CopyAction);
    event.accept();
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
    if (!event->mimeData()->hasUrls()) return;
    acceptDrag(*event);
    if (data_->drop) return;
    data_->drop = new DropOverlay(*this, *event->mimeData());
    data_->drop->open();
}

void MainWindow::dragLeaveEvent(QDragLeaveEvent* /*event*/) {
    if (data_->drop) data_->drop->leave();
    data_->drop = nullptr;
}

void MainWindow::dropEvent(QDropEvent* event) {
    dragLeaveEvent(nullptr);
    if (!event->mimeData()->hasUrls()) return;
    acceptDrag(*event);
    const auto files = localFiles(*event->mimeData());
    if (!files.empty()) {
        for (const auto& one : data_->workspaces)
            if (one->id() == data_->present && one->takeDrop(files)) return;
        openDropped(data_->studio, files);
        return;
    }
    Notice notice;
    notice.subject = "What was dropped";
    notice.why = "It is not a file on this computer.";
    notice.remedy = "Save it to a folder first, then drop the file.";
    data_->studio.notices.post("project", notice);
}

void MainWindow::changeEvent(QEvent* event) {
    QMainWindow::changeEvent(event);
    if (event->type() == QEvent::WindowStateChange)
        if (QAction* full = data_->studio.commands.find("view.fullScreen")) full->setChecked(isFullScreen());
}

/// Fields inside the window would take a dropped file as text; files are the window's, wherever they are dropped.
bool MainWindow::eventFilter(QObject* watched, QEvent* event) {
    const auto type = event->type();
    if (data_->desk != nullptr && (type == QEvent::KeyPress || type == QEvent::ShortcutOverride))
        if (data_->desk->takeKey(*watched, *static_cast<QKeyEvent*>(event))) {
            event->accept();
            return true;
        }
    if (type == QEvent::Show)
        if (auto* dialog = qobject_cast<QDialog*>(watched); dialog != nullptr && !event->spontaneous())
            fitDialog(*dialog);
    if (type != QEvent::DragEnter && type != QEvent::DragMove && type != QEvent::DragLeave && type != QEvent::Drop)
        return QMainWindow::eventFilter(watched, event);
    if (watched == this || !watched->isWidgetType() || !belongsTo(watched, this)) return false;
    if (type == QEvent::DragLeave) {
        dragLeaveEvent(static_cast<QDragLeaveEvent*>(event));
        return false;
    }
    auto* drag = static_cast<QDropEvent*>(event);
    if (!drag->mimeData()->hasUrls()) return false;
    if (type == QEvent::DragEnter) dragEnterEvent(static_cast<QDragEnterEvent*>(event));
    if (type == QEvent::DragMove) acceptDrag(*drag);
    if (type == QEvent::Drop) dropEvent(drag);
    return true;
}

} // namespace lumorph::studio
