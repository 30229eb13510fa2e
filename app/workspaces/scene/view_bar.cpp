#include "app/workspaces/scene/view_bar.h"

#include <utility>

#include <QHBoxLayout>
#include <QMenu>
#include <QPainter>
#include <QSignalBlocker>

#include "app/studio/look/icons.h"
#include "app/studio/look/palette.h"
#include "app/studio/widgets/dock_parts.h"

namespace lumorph::studio {
namespace {

constexpr int kViewBarHeight = 40;

QFrame* makeLine(QWidget* parent) {
    auto* line = new QFrame(parent);
    line->setFrameShape(QFrame::VLine);
    line->setFixedHeight(20);
    return line;
}

struct ModeWords {
    StageMode mode;
    const char* id;
    const char* text;
    const char* icon;
    const char* tip;
};

constexpr ModeWords kModes[] = {
    {StageMode::pair, "scene.showLab", "Lab", "lab", "The lit device, and beside it what the viewer should see"},
    {StageMode::eye, "scene.showEye", "Eye", "eye", "What the viewer should see"},
    {StageMode::projector, "scene.showProjector", "Projector", "projector", "What is sent out"},
    {StageMode::device, "scene.showDevice", "Device", "device", "The device without light"},
    {StageMode::all, "scene.showAll", "All four", "quarters", "Lab, eye, projector and device side by side"},
    {StageMode::compare, "scene.compare", "Compare", "compare",
     "The same eye before a flat device and before one that bends up for it: cropped and uncropped"},
};

} // namespace

ViewBar::ViewBar(Studio& studio, QWidget* parent) : QWidget(parent), studio_(studio) {
    setObjectName("scene.bar");
    setFixedHeight(kViewBarHeight);
    setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed); // words give way, not the pictures
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(8, 0, 8, 0);
    row->setSpacing(4);
    addModes();
    addToggles();
}

QAction* ViewBar::add(const QString& id, const QString& text, const QString& icon, const QString& tip, bool checkable,
                      const QString& shortcut) {
    Commands::Options options;
    options.icon = icon;
    options.shortcut = QKeySequence(shortcut);
    options.menu = "View";
    options.workspace = "scene";
    options.checkable = checkable;
    QAction* action = studio_.commands.add(id, text, options, [] {});
    action->setToolTip(shortcut.isEmpty() ? tip : QString("%1 (%2)").arg(tip, shortcut));
    return action;
}

void ViewBar::addModes() {
    int number = 0;
    for (const ModeWords& words : kModes) {
        QAction* action = add(words.id, words.text, words.icon, words.tip, true, QString("Alt+%1").arg(++number));
        modes_.emplace_back(words.mode, action);
        connect(action, &QAction::triggered, this, [this, mode = words.mode] { setMode(mode); });
        auto* button = new QToolButton(this);
        button->setObjectName(QString("bar.") + words.id);
        button->setDefaultAction(action);
        worded_.push_back(button);
        layout()->addWidget(button);
        action->setChecked(words.mode == mode_);
    }
}

void ViewBar::addToggles() {
    auto* row = static_cast<QHBoxLayout*>(layout());
    row->addStretch(1);
    row->addWidget(makeCommandIcon(studio_.commands.find("scene.play"), "bar.scene.play", this));
    time_ = makeNumber("scene.time", "0000.0 s", this);
    row->addWidget(time_);
    row->addWidget(makeLine(this));
    elsewhere_ = add("scene.elsewhere", tr("Look from elsewhere"), "elsewhere",
                     tr("Somebody else walks around the lab: the illusion holds for the viewer alone"), true, "Alt+L");
    connect(elsewhere_, &QAction::toggled, this, &ViewBar::elsewhereChanged);
    row->addWidget(makeCommandIcon(elsewhere_, "bar.scene.elsewhere", this));
    latency_ = add("scene.latency", tr("Show where the time goes"), "speed",
                   tr("Milliseconds of each stage of a frame"), true, "Alt+M");
    connect(latency_, &QAction::toggled, this, &ViewBar::latencyChanged);
    row->addWidget(makeCommandIcon(latency_, "bar.scene.latency", this));
    auto* output = new QToolButton(this);
    output->setObjectName("bar.output");
    output->setIcon(icon("projector"));
    output->setIconSize({20, 20});
    output->setText(tr("Output"));
    output->setToolTip(tr("Where each projector's picture goes: a window, a screen, a test pattern"));
    worded_.push_back(output);
    output->setPopupMode(QToolButton::InstantPopup);
    auto* menu = new QMenu(output);
    menu->setObjectName("output.menu");
    connect(menu, &QMenu::aboutToShow, this, [this, menu] { studio_.outputs.fillMenu(*menu); });
    output->setMenu(menu);
    row->addWidget(output);
    QAction* next = add("scene.nextProjector", tr("Show the next projector"), "projector",
                        tr("Show the next projector's picture"), false);
    connect(next, &QAction::triggered, this, &ViewBar::nextProjector);
}

void ViewBar::setMode(StageMode mode) {
    for (const auto& [of, action] : modes_) {
        const QSignalBlocker quiet(action);
        action->setChecked(of == mode);
    }
    // Blocked actions do not tell their buttons.
    for (QToolButton* button : findChildren<QToolButton*>())
        if (button->defaultAction() != nullptr) button->setChecked(button->defaultAction()->isChecked());
    fitWords();
    if (std::exchange(mode_, mode) != mode) emit modeChanged();
}

void ViewBar::fitWords() {
    const auto word = [this](auto wanted) {
        for (QToolButton* button : worded_)
            button->setToolButtonStyle(wanted(*button) ? Qt::ToolButtonTextBesideIcon : Qt::ToolButtonIconOnly);
        layout()->invalidate();
        return layout()->sizeHint().width() <= width();
    };
    if (word([](const QToolButton&) { return true; })) return;
    if (word([](const QToolButton& button) { return button.isChecked(); })) return;
    word([](const QToolButton&) { return false; });
}

void ViewBar::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    fitWords();
}

bool ViewBar::elsewhere() const { return elsewhere_->isChecked(); }
void ViewBar::setElsewhere(bool on) { elsewhere_->setChecked(on); }
bool ViewBar::latencyShown() const { return latency_->isChecked(); }

void ViewBar::setSeconds(double seconds) { time_->setText(tr("%1 s").arg(seconds, 0, 'f', 1)); }

void ViewBar::paintEvent(QPaintEvent* /*event*/) {
    QPainter painter(this);
    painter.fillRect(rect(), currentPalette().panel);
    painter.setPen(currentPalette().line);
    painter.drawLine(rect().bottomLeft(), rect().bottomRight());
}

} // namespace lumorph::studio
