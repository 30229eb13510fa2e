#include "devices/transport/bluetooth_scan.h"

#include <string>
#include <utility>

#include <QBluetoothDeviceDiscoveryAgent>
#include <QBluetoothLocalDevice>
#include <QObject>

#include "devices/transport/bluetooth_trouble.h"

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

class AgentScan final : public BluetoothScan {
public:
    explicit AgentScan(BluetoothSearch::Events events);
    /// The adapter would go on looking.
    ~AgentScan() override { agent_.stop(); }
    AgentScan(const AgentScan&) = delete;
    AgentScan& operator=(const AgentScan&) = delete;

private:
    void tell(const QBluetoothDeviceInfo& info) const;

    BluetoothSearch::Events events_;
    Agent agent_;
};

AgentScan::AgentScan(BluetoothSearch::Events events) : events_(std::move(events)) {
    QObject::connect(&agent_, &Agent::deviceDiscovered, &agent_, [this](const auto& info) { tell(info); });
    QObject::connect(&agent_, &Agent::finished, &agent_, [this] { events_.ended({}); });
    QObject::connect(&agent_, &Agent::errorOccurred, &agent_,
                     [this](Agent::Error error) { events_.ended(bluetoothTrouble(obstacleOf(error), {})); });
    agent_.start(Agent::ClassicMethod);
}

void AgentScan::tell(const QBluetoothDeviceInfo& info) const {
    if (!maySpeakSerial(info)) return;
    const std::string mac = info.address().toString().toStdString();
    const std::string name = info.name().isEmpty() ? mac : info.name().toStdString();
    FoundDevice device{"bt://" + mac, name + " (Bluetooth)", {}, mac, {}};
    if (QBluetoothLocalDevice().pairingStatus(info.address()) == QBluetoothLocalDevice::Unpaired) {
        device.hint = pairingHint();
        device.trouble = bluetoothTrouble(BluetoothObstacle::notPaired, name);
    }
    events_.found(device);
}

} // namespace

std::unique_ptr<BluetoothScan> beginBluetoothScan(BluetoothSearch::Events events) {
    if (hasBluetoothAdapter()) return std::make_unique<AgentScan>(std::move(events));
    events.ended(bluetoothTrouble(BluetoothObstacle::noAdapter, {}));
    return nullptr;
}

} // namespace lumorph
