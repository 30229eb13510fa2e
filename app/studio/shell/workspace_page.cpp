#include "app/studio/shell/workspace_page.h"

#include <algorithm>
#include <utility>

#include <QDockWidget>
#include <QPainter>

#include "app/studio/look/palette.h"
#include "app/studio/shell/dock_title.h"

namespace lumorph::studio {
namespace {

/// Has an edge while it floats, since it then has no frame of the desktop's.
class StudioDock : public QDockWidget {
public:
    using QDockWidget::QDockWidget;

protected:
    void paintEvent(QPaintEvent* event) override {
        QDockWidget::paintEvent(event);
        if (!isFloating()) return;
        QPainter painter(this);
        painter.setPen(currentPalette().border);
        painter.setBrush(currentPalette().panel);
        painter.drawRect(rect().adjusted(0, 0, -1, -1));
    }
};

constexpr int kLayoutVersion = 1;
constexpr int kUsualDockWidth = 312;
constexpr int kNarrowPage = 960; ///< below it two columns of docks would leave no room for the view
constexpr int kSettleMilliseconds = 400;

} // namespace

WorkspacePage::WorkspacePage(Workspace& workspace, Settings& settings, Commands& commands, QWidget* parent)
    : QMainWindow(parent), workspace_(workspace), settings_(settings) {
    setWindowFlags(Qt::Widget); // a main window is a window of its own unless told after it is made
    setObjectName("workspace." + workspace.id());
    setDockOptions(QMainWindow::AllowNestedDocks | QMainWindow::AllowTabbedDocks);
    setTabPosition(Qt::AllDockWidgetAreas, QTabWidget::North);
    setCorner(Qt::BottomLeftCorner, Qt::LeftDockWidgetArea);
    setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
    setContextMenuPolicy(Qt::NoContextMenu);
    setCentralWidget(workspace.makeCentralView());
    QDockWidget* before = nullptr;
    for (const WorkspaceDock& brought : workspace.makeDocks()) {
        addDock(brought, brought.tabbedWithPrevious ? before : nullptr);
        before = docks_.back();
        addCommands(commands, before, brought);
    }
    for (auto dock = docks_.begin(); dock != docks_.end(); ++dock) { // of docks behind each other the first is in front
        const QList<QDockWidget*> behind = tabifiedDockWidgets(*dock);
        const auto isBehind = [&](QDockWidget* other) { return behind.contains(other); };
        if (!behind.isEmpty() && std::none_of(docks_.begin(), dock, isBehind)) (*dock)->raise();
    }
    firstLayout_ = saveState(kLayoutVersion);
    settled_.setSingleShot(true);
    connect(&settled_, &QTimer::timeout, this, [this] { restored_.clear(); });
    const QByteArray kept = settings.layout(workspace.id());
    sized_ = !kept.isEmpty() && restoreState(kept, kLayoutVersion);
    if (sized_) restored_ = kept;
}

void WorkspacePage::addDock(const WorkspaceDock& brought, QDockWidget* before) {
    auto* dock = new StudioDock(brought.title, this);
    dock->setObjectName(brought.id);
    dock->setAcceptDrops(true); // while it floats it is a window of its own
    dock->setTitleBarWidget(makeDockTitle(*dock, brought.icon));
    dock->setWidget(brought.content);
    addDockWidget(brought.area, dock);
    if (before != nullptr) tabifyDockWidget(before, dock);
    if (brought.hiddenAtFirst) dock->hide();
    docks_.push_back(dock);
}

void WorkspacePage::addCommands(Commands& commands, QDockWidget* dock, const WorkspaceDock& brought) {
    Commands::Options options;
    options.menu = "View";
    options.workspace = workspace_.id();
    options.checkable = true;
    QAction* toggle = dock->toggleViewAction();
    QAction* command = commands.add("view." + brought.id, "Show " + brought.title, options, [dock] {
        dock->toggleViewAction()->trigger();
        if (dock->isVisible()) dock->raise();
    });
    const auto follow = [command, toggle] { command->setChecked(toggle->isChecked()); };
    follow();
    connect(toggle, &QAction::toggled, command, follow);
    connect(dock, &QObject::destroyed, command, &QObject::deleteLater);
}

void WorkspacePage::setActive(bool active) {
    if (active == active_) return;
    active_ = active;
    if (active) {
        for (const auto& dock : hiddenFloats_)
            if (dock) dock->show();
        hiddenFloats_.clear();
    } else {
        keepLayout();
        for (QDockWidget* dock : docks_)
            if (dock->isFloating() && dock->isVisible()) {
                hiddenFloats_.emplace_back(dock);
                dock->hide();
            }
    }
    workspace_.setActive(active);
    workspace_.setSeen(active && inSight_);
}

void WorkspacePage::setInSight(bool inSight) {
    if (std::exchange(inSight_, inSight) == inSight) return;
    workspace_.setSeen(active_ && inSight);
}

/// While the page is hidden its floating docks are too, and that is not what the user chose.
void WorkspacePage::keepLayout() {
    if (kiosk_ || !hiddenFloats_.empty()) return;
    const QByteArray& other = wideLayout_.isEmpty() ? restored_ : wideLayout_;
    settings_.setLayout(workspace_.id(), other.isEmpty() ? saveState(kLayoutVersion) : other);
}

void WorkspacePage::resetLayout() {
    hiddenFloats_.clear();
    wideLayout_.clear();
    restored_.clear();
    restoreState(firstLayout_, kLayoutVersion);
    applyFirstSizes();
    fitColumns();
    keepLayout();
}

void WorkspacePage::setKiosk(bool on) {
    if (on == kiosk_) return;
    if (on && active_) keepLayout();
    hasVisitors_ = workspace_.setForVisitors(on);
    if (on) {
        restored_.clear();
        kioskLayout_ = saveState(kLayoutVersion);
        kiosk_ = true;
        for (QDockWidget* dock : docks_) dock->hide();
        return;
    }
    restoreState(std::exchange(kioskLayout_, {}), kLayoutVersion);
    kiosk_ = false;
    if (isVisible()) fitColumns();
}

/// A page is laid out several times on its way to its size, and widths that do not fit on the way would stay cut.
void WorkspacePage::restore(const QByteArray& layout) {
    restored_ = layout;
    restoreInRoom();
}

void WorkspacePage::restoreInRoom() {
    if (restored_.isEmpty() || !isVisible() || !wideLayout_.isEmpty()) return;
    restoreState(restored_, kLayoutVersion);
    settled_.start(kSettleMilliseconds);
}

void WorkspacePage::showEvent(QShowEvent* event) {
    QMainWindow::showEvent(event);
    fitColumns();
    if (!restored_.isEmpty()) QTimer::singleShot(0, this, [this] { restoreInRoom(); }); // see below
    if (sized_) return;
    sized_ = true;
    QTimer::singleShot(0, this, [this] { // the layout has its size only after this event
        if (wideLayout_.isEmpty()) applyFirstSizes();
    });
}

void WorkspacePage::resizeEvent(QResizeEvent* event) {
    QMainWindow::resizeEvent(event);
    if (!isVisible()) return;
    fitColumns();
    restoreInRoom();
}

/// In a narrow window all docks lie behind each other in one column, until it is wide again.
void WorkspacePage::fitColumns() {
    const bool narrow = width() < kNarrowPage;
    if (kiosk_ || narrow == !wideLayout_.isEmpty()) return;
    if (!narrow) {
        restore(std::exchange(wideLayout_, {}));
        return;
    }
    wideLayout_ = restored_.isEmpty() ? saveState(kLayoutVersion) : std::exchange(restored_, {});
    QDockWidget* first = nullptr;
    for (QDockWidget* dock : docks_) {
        if (dock->isFloating()) continue;
        if (first == nullptr)
            addDockWidget(Qt::LeftDockWidgetArea, dock);
        else
            tabifyDockWidget(first, dock);
        if (first == nullptr) first = dock;
    }
    if (first != nullptr) first->raise();
}

/// A column of docks is as wide as suits numbers, and leaves more than half of a small window to the view.
void WorkspacePage::applyFirstSizes() {
    const int width = std::min(kUsualDockWidth, this->width() / 4);
    QList<QDockWidget*> sideways;
    QList<int> widths;
    for (QDockWidget* dock : docks_) {
        const auto area = dockWidgetArea(dock);
        if (dock->isFloating() || (area != Qt::LeftDockWidgetArea && area != Qt::RightDockWidgetArea)) continue;
        sideways << dock;
        widths << width;
    }
    if (!sideways.isEmpty()) resizeDocks(sideways, widths, Qt::Horizontal);
}

} // namespace lumorph::studio
