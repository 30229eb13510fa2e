#include <optional>
#include <utility>

#include <QBluetoothDeviceDiscoveryAgent>
#include <QBluetoothLocalDevice>
#include <QObject>
#include <QTimer>

#include "devices/transport/bluetooth_trouble.h"
#include "devices/transport/discovery.h"

namespace lumorph {

namespace {

using Agent = QBluetoothDeviceDiscoveryAgent;

/// Old modules (HC-06) tell nothing but a name, so a device of unknown kind may be one; a phone or a headset is none.
bool maySpeakSerial(const QBluetoothDeviceInfo& info) {
    if (info.serviceUuids().contains(QBluetoothUuid(QBluetoothUuid::ServiceClassUuid::SerialPort))) return true;
    return info.majorDeviceClass() == QBluetoothDeviceInfo::UncategorizedDevice ||
           info.majorDeviceClass() == QBluetoothDeviceInfo::MiscellaneousDevice;
}

BluetoothObstacle obstacleOf(Agent::Error error) {
    switch (error) {
    case Agent::PoweredOffError:
        return BluetoothObstacle::switchedOff;
    case Agent::MissingPermissionsError:
        return BluetoothObstacle::notAllowed;
    default:
        return BluetoothObstacle::noAdapter;
    }
}

} // namespace

struct BluetoothSearch::Data {
    Events events;
    QObject receiver; ///< signals reach us while it lives
    std::optional<Agent> agent;

    void begin();
    void tell(const QBluetoothDeviceInfo& info) const;
};

void BluetoothSearch::Data::begin() {
    if (!hasBluetoothAdapter()) {
        events.ended(bluetoothTrouble(BluetoothObstacle::noAdapter, {}));
        return;
    }
    agent.emplace();
    QObject::connect(&*agent, &Agent::deviceDiscovered, &receiver, [this](const auto& info) { tell(info); });
    QObject::connect(&*agent, &Agent::finished, &receiver, [this] { events.ended({}); });
    QObject::connect(&*agent, &Agent::errorOccurred, &receiver,
                     [this](Agent::Error error) { events.ended(bluetoothTrouble(obstacleOf(error), {})); });
    agent->start(Agent::ClassicMethod);
}

void BluetoothSearch::Data::tell(const QBluetoothDeviceInfo& info) const {
    if (!maySpeakSerial(info)) return;
    const std::string mac = info.address().toString().toStdString();
    const std::string name = info.name().isEmpty() ? mac : info.name().toStdString();
    FoundDevice device{"bt://" + mac, name + " (Bluetooth)", {}, mac, {}};
    if (QBluetoothLocalDevice().pairingStatus(info.address()) == QBluetoothLocalDevice::Unpaired) {
        device.hint = pairingHint();
        device.trouble = bluetoothTrouble(BluetoothObstacle::notPaired, name);
    }
    events.found(device);
}

BluetoothSearch::BluetoothSearch(Events events) : data_(std::make_unique<Data>()) {
    data_->events = std::move(events);
    // Not before its owner has it in hand.
    QTimer::singleShot(0, &data_->receiver, [data = data_.get()] { data->begin(); });
}

BluetoothSearch::~BluetoothSearch() = default;

} // namespace lumorph
