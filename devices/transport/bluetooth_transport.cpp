#include "devices/transport/bluetooth_transport.h"

#include <array>
#include <chrono>
#include <optional>
#include <utility>

#include <QBluetoothLocalDevice>
#include <QBluetoothSocket>
#include <QTimer>

#include "devices/transport/bluetooth_trouble.h"

namespace lumorph {

namespace {

constexpr std::chrono::seconds kPatience{15}; // for a connection: paging a device out of range takes five to ten

/// What its socket's error means while it connects.
BluetoothObstacle obstacleOf(QBluetoothSocket::SocketError error) {
    switch (error) {
    case QBluetoothSocket::SocketError::MissingPermissionsError:
        return BluetoothObstacle::notAllowed;
    case QBluetoothSocket::SocketError::ServiceNotFoundError:
        return BluetoothObstacle::noSerialPort;
    default:
        return BluetoothObstacle::outOfRange;
    }
}

class BluetoothTransport final : public Transport {
public:
    BluetoothTransport(BluetoothAddress address, Events events);
    ~BluetoothTransport() override { close(); }
    BluetoothTransport(const BluetoothTransport&) = delete;
    BluetoothTransport& operator=(const BluetoothTransport&) = delete;

    void open() override;
    void close() override;
    [[nodiscard]] bool isOpen() const override { return open_; }
    void write(std::span<const std::uint8_t> message) override;
    [[nodiscard]] std::size_t unsent() const override;
    [[nodiscard]] std::string identity() const override { return address_.mac; }
    [[nodiscard]] std::string product() const override { return name_; }

private:
    [[nodiscard]] std::optional<BluetoothObstacle> obstacle() const;
    void connectSocket();
    void read();
    void endFor(BluetoothObstacle obstacle);

    BluetoothAddress address_;
    Events events_;
    std::unique_ptr<QBluetoothSocket> socket_; ///< one for each open(): a used one does not connect reliably
    QTimer patience_;
    std::string name_;
    bool open_ = false;
};

BluetoothTransport::BluetoothTransport(BluetoothAddress address, Events events)
    : address_(std::move(address)), events_(std::move(events)) {
    patience_.setSingleShot(true);
    patience_.setInterval(kPatience);
    patience_.callOnTimeout([this] { endFor(BluetoothObstacle::outOfRange); });
}

void BluetoothTransport::open() {
    if (socket_) return;
    if (const std::optional<BluetoothObstacle> found = obstacle()) {
        events_.closed(bluetoothTrouble(*found, address_.mac));
        return;
    }
    connectSocket();
}

std::optional<BluetoothObstacle> BluetoothTransport::obstacle() const {
    if (!hasBluetoothAdapter()) return BluetoothObstacle::noAdapter;
    const QBluetoothLocalDevice adapter;
    if (!adapter.isValid()) return BluetoothObstacle::noAdapter;
    if (adapter.hostMode() == QBluetoothLocalDevice::HostPoweredOff) return BluetoothObstacle::switchedOff;
    const QBluetoothAddress device(QString::fromStdString(address_.mac));
    if (adapter.pairingStatus(device) == QBluetoothLocalDevice::Unpaired) return BluetoothObstacle::notPaired;
    return std::nullopt;
}

void BluetoothTransport::connectSocket() {
    socket_ = std::make_unique<QBluetoothSocket>(QBluetoothServiceInfo::RfcommProtocol);
    QBluetoothSocket* socket = socket_.get();
    QObject::connect(socket, &QBluetoothSocket::connected, socket, [this] {
        patience_.stop();
        open_ = true;
        name_ = socket_->peerName().toStdString();
        events_.opened();
    });
    QObject::connect(socket, &QBluetoothSocket::readyRead, socket, [this] { read(); });
    QObject::connect(socket, &QBluetoothSocket::disconnected, socket, [this] { endFor(BluetoothObstacle::brokenOff); });
    QObject::connect(socket, &QBluetoothSocket::errorOccurred, socket, [this](QBluetoothSocket::SocketError error) {
        endFor(open_ ? BluetoothObstacle::brokenOff : obstacleOf(error));
    });
    patience_.start();
    socket->connectToService(QBluetoothAddress(QString::fromStdString(address_.mac)),
                             QBluetoothUuid(QBluetoothUuid::ServiceClassUuid::SerialPort));
}

void BluetoothTransport::close() {
    open_ = false;
    patience_.stop();
    if (!socket_) return;
    // We may be called by one of its signals: it says no more, and goes when it has returned.
    QBluetoothSocket* socket = socket_.release();
    socket->disconnect();
    socket->abort();
    socket->deleteLater();
}

void BluetoothTransport::write(std::span<const std::uint8_t> message) {
    if (open_) socket_->write(reinterpret_cast<const char*>(message.data()), static_cast<qint64>(message.size()));
}

std::size_t BluetoothTransport::unsent() const { return open_ ? static_cast<std::size_t>(socket_->bytesToWrite()) : 0; }

void BluetoothTransport::read() {
    std::array<std::uint8_t, 4096> bytes;
    while (open_) { // whoever receives may close it
        const qint64 count = socket_->read(reinterpret_cast<char*>(bytes.data()), bytes.size());
        if (count <= 0) return;
        events_.received(std::span(bytes).first(static_cast<std::size_t>(count)));
    }
}

void BluetoothTransport::endFor(BluetoothObstacle obstacle) {
    if (!socket_) return;
    close();
    events_.closed(bluetoothTrouble(obstacle, name_.empty() ? address_.mac : name_));
}

} // namespace

std::unique_ptr<Transport> makeBluetoothTransport(BluetoothAddress address, Transport::Events events) {
    return std::make_unique<BluetoothTransport>(std::move(address), std::move(events));
}

} // namespace lumorph
