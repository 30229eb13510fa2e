#include "app/studio/shell/top_bar.h"

#include <array>
#include <utility>

#include <QButtonGroup>
#include <QEvent>
#include <QHBoxLayout>
#include <QPainter>
#include <QPainterPath>
#include <QPushButton>
#include <QStyle>

#include "app/studio/look/icons.h"
#include "app/studio/look/palette.h"
#include "app/studio/shell/driver_chip.h"
#include "app/studio/shell/record_chip.h"
#include "app/studio/shell/shell_commands.h"

namespace lumorph::studio {
namespace {

constexpr int kTopBarHeight = 40;
constexpr int kSearchWidth = 240;
constexpr int kGlassWidth = 32; ///< of the field without its words

/// The mark of the program: a sheet that three actuators lift.
class AppMark : public QWidget {
public:
    explicit AppMark(QWidget* parent) : QWidget(parent) {
        setFixedSize(24, 24);
        setToolTip("Lumorph");
    }

protected:
    void paintEvent(QPaintEvent* /*event*/) override {
        const Palette& colors = currentPalette();
        QPainter painter(this);
        painter.setRenderHint(QPainter::Antialiasing);
        painter.setPen(QPen(colors.accent, 2.2, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
        QPainterPath sheet(QPointF(2.5, 14));
        sheet.cubicTo(7, 14, 7.5, 4.5, 12, 4.5);
        sheet.cubicTo(16.5, 4.5, 16, 10.5, 21.5, 10.5);
        painter.drawPath(sheet);
        painter.setPen(QPen(blend(colors.panel, colors.text, 0.75), 2.2, Qt::SolidLine, Qt::RoundCap));
        for (const auto& [x, top] : {std::pair(4.5, 18.0), std::pair(12.0, 10.0), std::pair(19.5, 15.0)})
            painter.drawLine(QPointF(x, top), QPointF(x, 20.5));
    }
};

QToolButton* makeTool(QAction* action, QWidget* parent) {
    auto* button = new QToolButton(parent);
    button->setDefaultAction(action);
    button->setObjectName("bar." + action->objectName());
    button->setToolButtonStyle(Qt::ToolButtonIconOnly);
    button->setIconSize(QSize(18, 18));
    button->setFocusPolicy(Qt::StrongFocus);
    return button;
}

void relook(QWidget& widget, const char* look) {
    widget.setProperty("look", look);
    widget.style()->unpolish(&widget);
    widget.style()->polish(&widget);
}

} // namespace

TopBar::TopBar(Studio& studio, const std::vector<std::unique_ptr<Workspace>>& workspaces, QWidget* parent)
    : QWidget(parent), studio_(studio) {
    setObjectName("topBar");
    setAttribute(Qt::WA_StyledBackground);
    setFixedHeight(kTopBarHeight);
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(12, 0, 8, 0);
    row->setSpacing(4);
    mark_ = new AppMark(this);
    row->addWidget(mark_);
    row->addSpacing(8);
    auto* cards = makeTool(studio.commands.find("applications"), this);
    cards->ensurePolished();
    cards->setFixedWidth(cards->sizeHint().width()); // else menus that do not fit would move the tabs
    row->addWidget(cards);
    row->addSpacing(4);
    // Before the menus, whose number changes with the workspace: a tab stays where it was clicked.
    addTabs(workspaces, *row);
    addLeave(*row);
    row->addSpacing(12);
    menus_ = new QMenuBar(this);
    menus_->setNativeMenuBar(false);
    menus_->setSizePolicy(QSizePolicy::Maximum, QSizePolicy::Fixed);
    row->addWidget(menus_, 0, Qt::AlignVCenter);
    row->addStretch(1);
    addTools(*row);
    row->addSpacing(8);
    driver_ = new DriverChip(studio, this);
    row->addWidget(driver_);
    connect(&studio.driver, &DriverControl::changed, this, &TopBar::fitSearch);
    row->addSpacing(8);
    addStop(*row);
}

void TopBar::addTabs(const std::vector<std::unique_ptr<Workspace>>& workspaces, QHBoxLayout& row) {
    auto* group = new QButtonGroup(this);
    for (const auto& workspace : workspaces) {
        auto* tab = new QToolButton(this);
        tab->setObjectName("tab." + workspace->id());
        tab->setProperty("look", "tab");
        tab->setProperty("workspace", workspace->id());
        tab->setText(workspace->title());
        tab->setToolButtonStyle(Qt::ToolButtonTextOnly);
        tab->setCheckable(true);
        tab->setFixedHeight(kTopBarHeight - 1);
        tab->setFocusPolicy(Qt::StrongFocus);
        group->addButton(tab);
        row.addWidget(tab);
        tab->ensurePolished();
        tab->setFixedWidth(tab->sizeHint().width()); // else menus that do not fit would squeeze it
        tabs_.push_back(tab);
        connect(tab, &QToolButton::clicked, this, [this, id = workspace->id()] { emit workspaceChosen(id); });
    }
}

void TopBar::addLeave(QHBoxLayout& row) {
    leave_ = new QToolButton(this);
    leave_->setObjectName("bar.leaveKiosk");
    leave_->setIconSize(QSize(18, 18));
    leave_->hide();
    connect(leave_, &QToolButton::clicked, this, &TopBar::leaveWanted);
    row.addWidget(leave_);
}

void TopBar::addTools(QHBoxLayout& row) {
    Commands& commands = studio_.commands;
    for (const char* id : {"edit.undo", "edit.redo"}) {
        tools_.push_back(makeTool(commands.find(id), this));
        row.addWidget(tools_.back());
    }
    row.addSpacing(8);
    search_ = new QPushButton(icon("search", IconRole::muted), {}, this);
    search_->setObjectName("bar.search");
    search_->setProperty("look", "search");
    search_->setAccessibleName("Search commands");
    QAction* palette = commands.find("view.commandPalette");
    search_->setToolTip("Search commands (" + palette->shortcut().toString(QKeySequence::NativeText) + ")");
    connect(search_, &QPushButton::clicked, palette, &QAction::trigger);
    search_->setFixedWidth(kGlassWidth);
    row.addWidget(search_);
    tools_.push_back(search_);
    row.addSpacing(8);
    tools_.push_back(makeTool(commands.find("view.theme"), this));
    row.addWidget(tools_.back());
    tools_.push_back(makeRecordButton(studio_.recorder, commands, this));
    row.addWidget(tools_.back());
}

void TopBar::addStop(QHBoxLayout& row) {
    // Two buttons: who hits STOP twice must not start everything again.
    resume_ = new QPushButton(icon("play"), "Resume", this);
    resume_->setObjectName("resume");
    resume_->setToolTip(kResumePromise);
    row.addWidget(resume_);
    connect(resume_, &QPushButton::clicked, &studio_.loop, &StudioLoop::resume);
    row.addSpacing(8);
    stop_ = new QPushButton(icon("stop", IconRole::onDanger), "STOP", this);
    stop_->setObjectName("stop");
    stop_->setMinimumWidth(96);
    row.addWidget(stop_);
    connect(stop_, &QPushButton::clicked, &studio_.loop, &StudioLoop::stop);
    connect(&studio_.loop, &StudioLoop::stoppedChanged, this, &TopBar::showStopped);
    showStopped();
}

void TopBar::showStopped() {
    const bool stopped = studio_.loop.stopped();
    resume_->setVisible(stopped);
    stop_->setText(stopped ? "Stopped" : "STOP");
    stop_->setToolTip(stopped ? "The show holds still and servos are limp, until you resume. Click to say it to the "
                                "servos again"
                              : kStopPromise);
    stop_->setIcon(icon("stop", stopped ? IconRole::control : IconRole::onDanger));
    relook(*stop_, stopped ? "latched" : "danger");
    fitSearch();
}

void TopBar::setWorkspace(const QString& id) {
    for (QToolButton* tab : tabs_) tab->setChecked(tab->property("workspace").toString() == id);
}

void TopBar::setForVisitors(bool on, bool locked) {
    forVisitors_ = on;
    leave_->setIcon(icon(locked ? "lock" : "close", IconRole::muted));
    leave_->setAccessibleName(locked ? "Leave the kiosk, by the operator's PIN" : "Back to the studio");
    leave_->setToolTip(locked ? QString() : leave_->accessibleName());
    if (on) {
        for (QWidget* child : findChildren<QWidget*>(Qt::FindDirectChildrenOnly)) {
            const bool stays = child == mark_ || child == stop_ || child == resume_ || child == leave_;
            if (stays || child->isHidden()) continue;
            child->hide();
            shut_.emplace_back(child);
        }
    } else {
        for (const auto& child : std::exchange(shut_, {}))
            if (child) child->show();
    }
    leave_->setVisible(on);
    fitSearch();
}

void TopBar::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    fitSearch();
}

bool TopBar::event(QEvent* event) {
    const bool known = QWidget::event(event);
    if (event->type() == QEvent::LayoutRequest) fitSearch(); // another workspace brought other menus
    return known;
}

/// The field with its words where there is room, else the glass alone; in a narrow window undo, redo, theme and
/// recording are left to the menu, so that all menus are in sight.
void TopBar::fitSearch() {
    if (forVisitors_) return;
    const std::array<QWidget*, 4> spare{tools_[0], tools_[1], tools_[3], tools_[4]}; // all but the search
    int needed = layout()->sizeHint().width() + kGlassWidth;
    needed += search_->isHidden() ? layout()->spacing() : -search_->minimumWidth();
    for (const QWidget* tool : spare)
        if (tool->isHidden()) needed += tool->sizeHint().width() + layout()->spacing();
    if (driver_->isNarrow()) needed += driver_->wordsWidth();
    const bool tight = needed > width();
    for (QWidget* tool : spare) {
        tool->setVisible(!tight);
        if (tight) needed -= tool->sizeHint().width() + layout()->spacing();
    }
    const bool narrow = needed > width();
    driver_->setNarrow(narrow);
    search_->setVisible(!narrow || needed - driver_->wordsWidth() <= width());
    const bool roomy = !tight && needed + kSearchWidth - kGlassWidth <= width();
    search_->setFixedWidth(roomy ? kSearchWidth : kGlassWidth);
    search_->setText(roomy ? "Search commands    Ctrl+K" : QString());
}

} // namespace lumorph::studio
