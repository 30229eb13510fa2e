#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/workspaces/devices/device_words.h"
#include "app/workspaces/devices/devices_docks.h"
#include "app/workspaces/rig/actuator_item.h"
#include "devices/controllers/controller_kinds.h"

namespace lumorph::studio {
namespace {

QString detailOf(const FoundDevice& device) {
    if (!device.trouble.why.empty()) return sentence(device.trouble.why);
    return QString::fromStdString(device.hint.empty() ? device.address : device.hint);
}

QString foundIcon(const FoundDevice& device) {
    if (!device.trouble.why.empty()) return "warning";
    return device.address.starts_with("sim://") ? "lab" : "device";
}

class FoundDock : public QWidget {
public:
    explicit FoundDock(Studio& studio) : studio_(studio), list_(new QListWidget), address_(new QLineEdit) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(0);
        layout->addWidget(makeNoticeBar(studio.notices, "devices"));
        const Column column = makeColumn(this);
        layout->addWidget(column.widget, 1);
        column.layout->setAlignment({});
        addList(*column.layout);
        addAddress(*column.layout);
        addButtons(*column.layout);
        connect(&studio.devices, &DeviceService::foundChanged, this, [this] { list(); });
        connect(&studio.devices, &DeviceService::profileChanged, this, [this] { showProfile(); });
        connect(&studio.devices, &DeviceService::changed, this, [this] { refresh(); });
        showProfile();
        list();
        refresh();
    }

private:
    void addList(QVBoxLayout& layout) {
        list_->setObjectName("devices.list");
        list_->setAccessibleName("Devices that were found");
        list_->setItemDelegate(new ActuatorItem(list_));
        list_->setUniformItemSizes(true);
        list_->setMouseTracking(true);
        list_->setMinimumHeight(140);
        trouble_ = new QLabel;
        trouble_->setObjectName("devices.trouble");
        trouble_->setProperty("look", "warning");
        trouble_->setWordWrap(true);
        layout.addWidget(list_, 1);
        layout.addWidget(trouble_);
        layout.addWidget(makeCommandButton(studio_.commands.find("device.bluetooth"), "devices.bluetooth", this));
        connect(list_, &QListWidget::currentRowChanged, this, [this](int row) { choose(row); });
        connect(list_, &QListWidget::itemActivated, this, [this] { connectNow(); });
    }

    void addAddress(QVBoxLayout& layout) {
        layout.addWidget(makeHeading("Or by address"));
        address_->setObjectName("devices.address");
        address_->setAccessibleName("Address");
        address_->setPlaceholderText("serial:///dev/rfcomm0?baud=9600");
        address_->setToolTip("serial:///dev/ttyUSB0?baud=57600\nbt://98:D3:31:F4:12:AB\n"
                             "hid://0483:5750?product=LOBOT\nsim://tablet");
        layout.addWidget(address_);
        kind_ = new QComboBox;
        kind_->setObjectName("devices.kind");
        kind_->setToolTip("What language the board speaks. Chosen by itself where the name tells.");
        for (const KnownController& known : knownControllers())
            kind_->addItem(QString::fromUtf8(known.title), static_cast<int>(known.kind));
        layout.addWidget(makeRow("&Speaks", kind_));
        connect(address_, &QLineEdit::returnPressed, this, [this] { connectNow(); });
        connect(address_, &QLineEdit::textEdited, this, [this](const QString& text) {
            showKind(likelyController(text.toStdString()));
            list_->setCurrentRow(rowOf(text));
            refresh();
        });
    }

    void showKind(ControllerKind kind) { kind_->setCurrentIndex(kind_->findData(static_cast<int>(kind))); }

    void addButtons(QVBoxLayout& layout) {
        connect_ = new QPushButton("Connect");
        connect_->setObjectName("devices.connect");
        connect_->setToolTip(
            "Opens the link. Nothing is driven yet; servos that something else has switched on are let go.");
        connect(connect_, &QPushButton::clicked, this, [this] { connectNow(); });
        auto* row = new QHBoxLayout;
        row->setSpacing(8);
        row->addWidget(connect_, 1);
        disconnect_ = makeCommandButton(studio_.commands.find("device.disconnect"), "devices.disconnect", this);
        row->addWidget(disconnect_, 1);
        layout.addLayout(row);
    }

    void list() {
        const auto& found = studio_.devices.found();
        const QString before = address_->text();
        const QSignalBlocker quiet(list_);
        list_->clear();
        for (const FoundDevice& device : found) {
            auto* item = new QListWidgetItem(QString::fromStdString(device.name), list_);
            const QString detail = detailOf(device);
            item->setData(kActuatorDetail, detail);
            item->setData(kActuatorIcon, foundIcon(device));
            item->setData(Qt::AccessibleDescriptionRole, detail);
            item->setToolTip(QString::fromStdString(device.address) + '\n' + detail);
        }
        list_->setCurrentRow(rowOf(before));
        showTrouble();
        refresh();
    }

    [[nodiscard]] int rowOf(const QString& address) const {
        const auto& found = studio_.devices.found();
        for (std::size_t k = 0; k < found.size(); ++k)
            if (found[k].address == address.toStdString()) return static_cast<int>(k);
        return -1;
    }

    void choose(int row) {
        const auto& found = studio_.devices.found();
        if (row >= 0 && static_cast<std::size_t>(row) < found.size()) {
            const FoundDevice& device = found[static_cast<std::size_t>(row)];
            address_->setText(QString::fromStdString(device.address));
            showKind(likelyController(address_->text().toStdString() + " " + device.name + device.hint));
        }
        showTrouble();
        refresh();
    }

    void showTrouble() {
        const auto& found = studio_.devices.found();
        const int row = list_->currentRow();
        const bool chosen = row >= 0 && static_cast<std::size_t>(row) < found.size();
        const LinkTrouble trouble = chosen ? found[static_cast<std::size_t>(row)].trouble : LinkTrouble{};
        trouble_->setText((sentence(trouble.why) + ' ' + sentence(trouble.remedy)).trimmed());
        trouble_->setVisible(!trouble.why.empty());
    }

    void showProfile() {
        const DeviceProfile& profile = studio_.devices.profile();
        const QString address = QString::fromStdString(profile.address);
        if (address.isEmpty() || address_->hasFocus()) return;
        address_->setText(address);
        showKind(profile.controller);
        const QSignalBlocker quiet(list_);
        list_->setCurrentRow(rowOf(address));
        showTrouble();
    }

    void connectNow() {
        if (!address_->text().trimmed().isEmpty())
            studio_.devices.connectTo(address_->text(), static_cast<ControllerKind>(kind_->currentData().toInt()));
    }

    void refresh() {
        const LinkStatus& link = studio_.devices.status();
        const bool here = link.phase != LinkPhase::off &&
                          address_->text().trimmed().toStdString() == studio_.devices.profile().address;
        const bool rig = studio_.document.state().rig.rig != nullptr;
        connect_->setEnabled(rig && !here && !address_->text().trimmed().isEmpty());
        QPushButton* search = findChild<QPushButton*>("devices.bluetooth");
        search->setEnabled(!studio_.devices.searchingBluetooth());
        search->setText(studio_.devices.searchingBluetooth() ? "Searching..." : "Search Bluetooth");
        disconnect_->setText("Disconnect");
    }

    Studio& studio_;
    QListWidget* list_;
    QLineEdit* address_;
    QComboBox* kind_ = nullptr;
    QLabel* trouble_ = nullptr;
    QPushButton* connect_ = nullptr;
    QPushButton* disconnect_ = nullptr;
};

} // namespace

QWidget* makeFoundDock(Studio& studio) { return new FoundDock(studio); }

} // namespace lumorph::studio
