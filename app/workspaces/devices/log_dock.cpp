#include <QLabel>
#include <QListWidget>
#include <QVBoxLayout>

#include "app/studio/look/icons.h"
#include "app/workspaces/devices/devices_docks.h"

namespace lumorph::studio {
namespace {

class LogDock : public QWidget {
public:
    explicit LogDock(Studio& studio) : studio_(studio), list_(new QListWidget(this)), empty_(new QLabel(this)) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(8, 8, 8, 8);
        list_->setObjectName("devices.log");
        list_->setAccessibleName("What happened, newest first");
        list_->setWordWrap(true);
        list_->setResizeMode(QListView::Adjust); // a scroll bar makes lines narrower, and more of them
        list_->setTextElideMode(Qt::ElideNone);
        list_->setSelectionMode(QAbstractItemView::ExtendedSelection);
        list_->setVerticalScrollMode(QAbstractItemView::ScrollPerPixel);
        list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
        list_->setMinimumHeight(56);
        empty_->setText("What happens with the device is told here, in plain words.");
        empty_->setProperty("look", "muted");
        empty_->setAlignment(Qt::AlignCenter);
        empty_->setWordWrap(true);
        layout->addWidget(list_, 1);
        layout->addWidget(empty_, 1);
        connect(&studio.devices, &DeviceService::logged, this, [this](int lines) { take(lines); });
        take(static_cast<int>(studio.devices.log().size()));
    }

    [[nodiscard]] QSize sizeHint() const override { return {600, 112}; }

private:
    void take(int lines) {
        const auto& log = studio_.devices.log();
        const int fresh = std::min(lines, static_cast<int>(log.size()));
        for (int k = fresh - 1; k >= 0; --k) list_->insertItem(0, makeItem(log[static_cast<std::size_t>(k)]));
        while (list_->count() > static_cast<int>(log.size())) delete list_->takeItem(list_->count() - 1);
        list_->setVisible(list_->count() > 0);
        empty_->setVisible(list_->count() == 0);
    }

    static QListWidgetItem* makeItem(const DeviceLogLine& line) {
        QString text = line.time.toString("HH:mm:ss") + "   " + line.text;
        if (!line.remedy.isEmpty()) text += ' ' + line.remedy;
        auto* item = new QListWidgetItem(text);
        switch (line.kind) {
        case LinkEvent::Kind::information:
            item->setIcon(icon("info", IconRole::muted));
            break;
        case LinkEvent::Kind::warning:
            item->setIcon(icon("warning", IconRole::warning));
            break;
        case LinkEvent::Kind::failure:
            item->setIcon(icon("error", IconRole::danger));
            break;
        }
        return item;
    }

    Studio& studio_;
    QListWidget* list_;
    QLabel* empty_;
};

} // namespace

QWidget* makeDeviceLog(Studio& studio) { return new LogDock(studio); }

} // namespace lumorph::studio
