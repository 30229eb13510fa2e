#include "app/studio/shell/record_chip.h"

#include <QMenu>
#include <QPushButton>
#include <QToolButton>

#include "app/studio/look/icons.h"
#include "app/studio/recording/recording_service.h"

namespace lumorph::studio {
namespace {

QString nameOf(const RecordingService& record) { return QString::fromStdString(record.file().stem().string()); }

} // namespace

QWidget* makeRecordButton(RecordingService& record, Commands& commands, QWidget* parent) {
    auto* button = new QToolButton(parent);
    button->setObjectName("bar.record");
    button->setIconSize(QSize(18, 18));
    button->setFocusPolicy(Qt::StrongFocus);
    QAction* start = commands.find("record.start");
    QAction* stop = commands.find("record.stop");
    QObject::connect(button, &QToolButton::clicked, button, [&record, start, stop] {
        record.phase() == RecordingService::Phase::idle ? start->trigger() : stop->trigger();
    });
    const auto show = [button, &record, start, stop] {
        const bool on = record.phase() != RecordingService::Phase::idle;
        button->setIcon(icon("record", on ? IconRole::danger : IconRole::control));
        button->setToolButtonStyle(on ? Qt::ToolButtonTextBesideIcon : Qt::ToolButtonIconOnly);
        button->setText(on ? clockText(record.seconds()) : QString());
        button->setToolTip(on ? QString("Stop recording (%1)").arg(stop->shortcut().toString())
                              : QString("Record the show (%1)").arg(start->shortcut().toString()));
        button->setAccessibleName(on ? "Stop recording" : "Record");
    };
    QObject::connect(&record, &RecordingService::changed, button, show);
    show();
    return button;
}

QWidget* makeRecordChip(RecordingService& record, Commands& commands, QWidget* parent) {
    auto* chip = new QPushButton(parent);
    chip->setObjectName("status.record");
    chip->setProperty("look", "status");
    auto* menu = new QMenu(chip);
    for (const char* id : {"record.mark", "record.folder", "record.stop"}) menu->addAction(commands.find(id));
    chip->setMenu(menu);
    const auto show = [chip, &record] {
        const bool on = record.phase() != RecordingService::Phase::idle;
        chip->setVisible(on);
        if (!on) return;
        chip->setIcon(icon("record", IconRole::danger));
        chip->setText(
            QString("%1   %2   %3").arg(clockText(record.seconds()), nameOf(record), bytesText(record.bytes())));
        chip->setToolTip("Recording to " + QString::fromStdString(record.file().string()));
    };
    QObject::connect(&record, &RecordingService::changed, chip, show);
    show();
    return chip;
}

} // namespace lumorph::studio
