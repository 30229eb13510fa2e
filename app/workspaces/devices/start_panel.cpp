#include "app/workspaces/devices/start_panel.h"

#include <QApplication>
#include <QDialog>
#include <QHBoxLayout>
#include <QPushButton>
#include <QVBoxLayout>

#include "app/workspaces/common/field_colors.h"
#include "app/workspaces/devices/servo_board.h"

namespace lumorph::studio {
namespace {

constexpr int kRefreshEvery = 200; ///< milliseconds; the show goes on meanwhile
constexpr QSize kLeastPicture{220, 150};
constexpr float kGhost = 0.45F;

QWidget* programWindow() {
    for (QWidget* top : QApplication::topLevelWidgets())
        if (top->objectName() == "mainWindow") return top;
    return nullptr;
}

} // namespace

StartPanel::StartPanel(Studio& studio, DeviceService::StartBy by, QWidget* parent)
    : QWidget(parent), studio_(studio), by_(by), view_(new ViewportWidget(studio.renderer, this)),
      title_(new QLabel(this)), text_(new QLabel(this)), servos_(new QListWidget(this)),
      hold_(new HoldButton({}, this)) {
    setObjectName("start.panel");
    view_->setObjectName("start.view");
    view_->setAccessibleName("The device where its servos are, and as a ghost the pose to come");
    view_->setToolTip("The ghost is the pose to come");
    view_->setMinimumSize(kLeastPicture);
    view_->setActive(false);
    builder_.setPatient(false);
    title_->setObjectName("start.title");
    title_->setProperty("look", "title");
    text_->setObjectName("start.text");
    text_->setTextFormat(Qt::PlainText);
    text_->setWordWrap(true);
    servos_->setObjectName("start.servos");
    servos_->setAccessibleName("What each servo will do");
    servos_->setSelectionMode(QAbstractItemView::NoSelection);
    servos_->setFocusPolicy(Qt::TabFocus);
    servos_->setMinimumHeight(44);
    servos_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    hold_->setObjectName("start.hold");
    hold_->setMinimumHeight(36);
    auto* words = new QVBoxLayout;
    words->setSpacing(6);
    words->addWidget(title_);
    words->addWidget(text_);
    words->addWidget(servos_, 1);
    auto* end = new QHBoxLayout;
    auto* hint = new QLabel("For a second: with the mouse, Space or Enter", this);
    hint->setProperty("look", "muted");
    hint->setWordWrap(true);
    end->addWidget(hint, 1);
    end->addWidget(hold_);
    words->addLayout(end);
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(12);
    row->addWidget(view_, 2);
    row->addLayout(words, 3);
    refresh_.setInterval(kRefreshEvery);
    connect(&refresh_, &QTimer::timeout, this, &StartPanel::refresh);
    connect(&studio.devices, &DeviceService::changed, this, [this] {
        if (isVisible()) refresh();
    });
    connect(hold_, &HoldButton::held, this, &StartPanel::start);
    refresh();
}

void StartPanel::focusButton() { hold_->setFocus(Qt::ShortcutFocusReason); }

void StartPanel::showEvent(QShowEvent* event) {
    QWidget::showEvent(event);
    builder_.setColors(fieldSceneColors(studio_.settings.theme()));
    drawn_.clear();
    view_->setActive(true);
    refresh_.start();
    refresh();
}

void StartPanel::hideEvent(QHideEvent* event) {
    refresh_.stop();
    view_->setActive(false);
    QWidget::hideEvent(event);
}

void StartPanel::refresh() {
    const auto& frame = studio_.loop.frame();
    const bool recording = by_ == DeviceService::StartBy::recording && frame;
    const std::vector<double> wanted = recording ? frame->estimatedStrokes : studio_.devices.wanted();
    const auto moves = startMoves(studio_.devices.status(), studio_.devices.profile(), wanted);
    StartQuestion next = startQuestion(deviceViewOf(studio_), moves, by_);
    // Whoever holds it has agreed to what it said when he began, and to less: positions may be read meanwhile.
    if (next.jumps && (!question_.jumps || next.button != question_.button)) hold_->cancel();
    const bool other = next != question_;
    question_ = std::move(next);
    title_->setText(question_.title);
    text_->setText(question_.text);
    text_->setProperty("look", question_.jumps ? "warning" : "");
    hold_->setText(question_.button);
    hold_->setAccessibleName(question_.button);
    hold_->setEnabled(question_.possible);
    if (other) {
        while (servos_->count() > question_.servos.size()) delete servos_->takeItem(servos_->count() - 1);
        for (int k = 0; k < question_.servos.size(); ++k)
            k < servos_->count() ? servos_->item(k)->setText(question_.servos[k])
                                 : servos_->addItem(question_.servos[k]);
        text_->style()->unpolish(text_);
        text_->style()->polish(text_);
        emit questionChanged();
    }
    if (isVisible()) draw(moves);
}

/// Servos that nobody knows of are drawn where they will be; where that is all, only the ghost is drawn.
void StartPanel::draw(const std::vector<StartMove>& moves) {
    const auto& rig = studio_.document.state().rig.rig;
    if (!rig || rig->actuatorCount() != moves.size()) return;
    if (!builder_.pending() && drawn_ == moves) return;
    drawn_ = moves;
    MatchFrame pose;
    pose.rig = rig;
    bool known = false;
    for (const StartMove& move : moves) {
        known = known || move.from.has_value();
        pose.wantedStrokes.push_back(move.to);
        pose.estimatedStrokes.push_back(move.from.value_or(move.to));
    }
    auto positions = std::make_shared<std::vector<glm::vec3>>(rig->restMesh().positions.size());
    rig->deform(pose.estimatedStrokes, *positions);
    pose.devicePositions = std::move(positions);
    FieldDisplay display;
    display.showWish = true;
    auto scene = std::make_shared<ViewportScene>(*builder_.build(pose, display, false));
    if (!known && !scene->surfaces.empty()) scene->surfaces.front().opacity = kGhost;
    view_->setScene(std::move(scene));
}

void StartPanel::start() {
    if (!question_.possible) return;
    if (by_ == DeviceService::StartBy::recording) studio_.replay.setDrivesServos(true);
    const LinkStatus& link = studio_.devices.status();
    if (link.phase != LinkPhase::live || !link.waiting.empty()) studio_.devices.start(question_.jumps);
    emit started();
}

void openStartDialog(Studio& studio, DeviceService::StartBy by) {
    QWidget* window = programWindow();
    if (auto* open = window ? window->findChild<QDialog*>("dialog.start") : nullptr) {
        open->close();
        open->setObjectName({}); // the new question is another one
    }
    auto* dialog = new QDialog(window);
    dialog->setObjectName("dialog.start");
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    auto* panel = new StartPanel(studio, by, dialog);
    auto* cancel = new QPushButton("Not now", dialog);
    cancel->setObjectName("start.cancel");
    cancel->setAutoDefault(false);
    auto* column = new QVBoxLayout(dialog);
    column->setContentsMargins(24, 16, 24, 16);
    column->setSpacing(12);
    column->addWidget(panel, 1);
    column->addWidget(cancel, 0, Qt::AlignLeft);
    dialog->setWindowTitle("Servos");
    QObject::connect(cancel, &QPushButton::clicked, dialog, &QDialog::reject);
    QObject::connect(panel, &StartPanel::started, dialog, &QDialog::accept);
    // What was asked about has come about otherwise, or is gone.
    QObject::connect(&studio.devices, &DeviceService::changed, dialog, [&studio, by, dialog] {
        const LinkPhase phase = studio.devices.status().phase;
        const bool begun =
            by == DeviceService::StartBy::show && phase == LinkPhase::live && studio.devices.status().waiting.empty();
        if (begun || phase == LinkPhase::off) dialog->reject();
    });
    if (by == DeviceService::StartBy::recording)
        QObject::connect(&studio.replay, &ReplayService::changed, dialog, [&studio, dialog] {
            if (!studio.replay.recording()) dialog->reject();
        });
    dialog->resize(680, 320);
    dialog->show();
    panel->focusButton();
}

} // namespace lumorph::studio
