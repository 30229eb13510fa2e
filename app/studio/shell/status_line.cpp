#include "app/studio/shell/status_line.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QTimer>

#include "app/studio/look/icons.h"
#include "app/studio/shell/loop_text.h"
#include "app/studio/shell/notice_list.h"
#include "app/studio/shell/record_chip.h"
#include "app/studio/shell/second_studio.h"
#include "app/studio/widgets/icon_label.h"
#include "app/studio/widgets/panel.h"

namespace lumorph::studio {
namespace {

constexpr int kRefreshMilliseconds = 250;

QLabel* addText(QHBoxLayout& row, const char* name, const QString& iconName, const QString& toolTip, QWidget* parent) {
    if (!iconName.isEmpty()) {
        row.addWidget(new IconLabel(iconName, IconRole::muted, 14, parent));
        row.addSpacing(6);
    }
    auto* label = new QLabel(parent);
    label->setObjectName(name);
    label->setTextFormat(Qt::PlainText);
    label->setToolTip(toolTip);
    row.addWidget(label);
    row.addSpacing(24);
    return label;
}

/// While projectors show a test pattern instead of the scene: which, and a click ends it. Else nothing.
QWidget* makePatternChip(ProjectorOutputs& outputs, QWidget* parent) {
    auto* chip = new QPushButton(parent);
    chip->setObjectName("status.pattern");
    chip->setProperty("look", "status");
    const auto show = [chip, &outputs] {
        const TestPattern pattern = outputs.pattern();
        chip->setVisible(pattern != TestPattern::none);
        if (pattern == TestPattern::none) return;
        chip->setIcon(icon("projector", IconRole::warning));
        chip->setText("Test pattern: " + nameOf(pattern));
        chip->setToolTip("The projectors show a test pattern, not the scene. Click to show the scene again.");
    };
    QObject::connect(&outputs, &ProjectorOutputs::changed, chip, show);
    QObject::connect(chip, &QPushButton::clicked, &outputs, [&outputs] { outputs.setPattern(TestPattern::none); });
    show();
    return chip;
}

/// While the running show is watched: what the watch says, and a click leads to the check.
QWidget* makeWatchChip(Studio& studio, QWidget* parent) {
    auto* chip = new QPushButton(parent);
    chip->setObjectName("status.watch");
    chip->setProperty("look", "status");
    const auto show = [chip, &studio] {
        const WatchStand& stand = studio.watch.stand();
        chip->setVisible(!stand.words.isEmpty());
        const bool isAlarm = stand.how == WatchStand::How::alarm;
        chip->setIcon(icon(isAlarm ? "warning" : "eye", isAlarm ? IconRole::warning : IconRole::muted));
        chip->setText(stand.words);
        chip->setToolTip(QString::fromStdString(stand.sentence) + "\nClick to check the room.");
    };
    QObject::connect(&studio.watch, &WatchBoard::changed, chip, show);
    QObject::connect(chip, &QPushButton::clicked, &studio.watch, &WatchBoard::checkWanted);
    show();
    return chip;
}

/// While another studio runs: a click says again what this means.
QWidget* makeSecondChip(Studio& studio, QWidget* parent) {
    auto* chip = new QPushButton(icon("lock", IconRole::warning), "Second window", parent);
    chip->setObjectName("status.second");
    chip->setProperty("look", "status");
    chip->setToolTip("Another Lumorph is open: settings and the room are read only here. Click to read more.");
    const auto follow = [chip, &studio] { chip->setVisible(isSecond(studio)); };
    QObject::connect(&studio.home, &StudioHome::tookOver, chip, follow);
    QObject::connect(&studio.project, &ProjectService::tookOver, chip, follow);
    QObject::connect(chip, &QPushButton::clicked, &studio.project, [&studio] { postOtherStudio(studio); });
    follow();
    return chip;
}

QString counted(int count, const QString& one) {
    return QString::number(count) + ' ' + one + (count == 1 ? QString() : QString("s"));
}

} // namespace

StatusLine::StatusLine(Studio& studio, QWidget* parent)
    : QWidget(parent),
      studio_(studio), places_{"viewport", "rig", "field", "target", "match", "export", "project", "device"} {
    setObjectName("statusLine");
    setAttribute(Qt::WA_StyledBackground);
    setFixedHeight(28);
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(12, 0, 8, 0);
    row->setSpacing(0);
    project_ = addText(*row, "status.project", "file", {}, this);
    hardware_ = addText(*row, "status.hardware", "device", {}, this);
    loop_ = addText(*row, "status.loop", "speed",
                    "How often the device follows the target, and how long finding its levels takes", this);
    loop_->setMinimumWidth(64);
    row->addStretch(1);
    row->addWidget(makeSecondChip(studio, this));
    row->addSpacing(16);
    row->addWidget(makeWatchChip(studio, this));
    row->addSpacing(16);
    row->addWidget(makePatternChip(studio.outputs, this));
    row->addSpacing(16);
    row->addWidget(makeRecordChip(studio.recorder, studio.commands, this));
    row->addSpacing(16);
    row->addWidget(makeJobLine(studio.jobs, this));
    row->addSpacing(16);
    warnings_ = new QPushButton(this);
    warnings_->setObjectName("status.warnings");
    warnings_->setProperty("look", "status");
    row->addWidget(warnings_);
    connect(warnings_, &QPushButton::clicked, this, &StatusLine::listWarnings);
    connect(&studio.document, &StudioDocument::titleChanged, this, &StatusLine::showProject);
    connect(&studio.devices, &DeviceService::changed, this, &StatusLine::showHardware);
    connect(&studio.notices, &Notices::changed, this, [this](const QString& place) {
        if (!place.isEmpty()) places_.insert(place);
        showWarnings();
    });
    connect(&studio.loop, &StudioLoop::framed, this,
            [this] { lastMatch_ = lastMatch(lastMatch_, *studio_.loop.frame()); });
    auto* timer = new QTimer(this);
    connect(timer, &QTimer::timeout, this, [this] {
        showLoop();
        showWarnings();
    });
    timer->start(kRefreshMilliseconds);
    showProject();
    showHardware();
    showLoop();
    showWarnings();
}

void StatusLine::showProject() {
    const StudioDocument& document = studio_.document;
    const QString dot = document.modified() ? QString(" ") + QChar(0x2022) : QString();
    project_->setText(document.name() + dot);
    const QString where = document.file().empty() ? QString("Not saved as a project yet.")
                                                  : QString::fromStdString(document.file().string());
    project_->setToolTip(where + (document.modified() ? "\nChanged since it was saved." : "") +
                         "\nWhat is not saved is kept when you quit, and comes back when you start again.");
}

void StatusLine::showHardware() {
    const QString live = studio_.devices.liveName();
    const QString text = live.isEmpty() ? QString("Virtual lab") : live;
    if (text == hardware_->text()) return;
    hardware_->setText(text);
    hardware_->setToolTip(live.isEmpty()
                              ? "The tablet, its servos and their speed limits are simulated here; nothing real moves."
                              : "Its servos follow the show. The Devices workspace tells all about it.");
}

void StatusLine::showLoop() {
    const auto& frame = studio_.loop.frame();
    if (studio_.loop.showsSource()) return loop_->setText("Replay");
    const QString text = loopText(frame.get(), lastMatch_, studio_.loop.rate(), studio_.loop.stopped());
    if (text != loop_->text()) loop_->setText(text);
}

void StatusLine::showWarnings() {
    const std::vector<QString> ofFrame = frameWarnings(studio_.loop.frame().get());
    if (list_) updateNoticeList(*list_, ofFrame);
    int errors = 0, warnings = static_cast<int>(ofFrame.size()), notes = 0;
    for (const Notice& notice : studio_.notices.at()) {
        errors += notice.level == Notice::Level::error ? 1 : 0;
        warnings += notice.level == Notice::Level::warning ? 1 : 0;
        notes += notice.level == Notice::Level::info ? 1 : 0;
    }
    QStringList parts;
    if (errors > 0) parts << counted(errors, "error");
    if (warnings > 0) parts << counted(warnings, "warning");
    if (parts.isEmpty() && notes > 0) parts << counted(notes, "note");
    const QString text = parts.isEmpty() ? "No warnings" : parts.join(", ");
    if (text == warnings_->text()) return;
    warnings_->setText(text);
    warnings_->setIcon(errors > 0     ? icon("error", IconRole::danger)
                       : warnings > 0 ? icon("warning", IconRole::warning)
                                      : icon(notes > 0 ? "info" : "check", IconRole::muted));
}

void StatusLine::listWarnings() {
    if (list_) {
        list_->close();
        return;
    }
    list_ = makeNoticeList(studio_.notices, places_, frameWarnings(studio_.loop.frame().get()), window());
    const QPoint corner = warnings_->mapTo(window(), QPoint(warnings_->width(), 0));
    openNoticeList(*list_, corner);
}

} // namespace lumorph::studio
