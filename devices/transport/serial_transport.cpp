#include "devices/transport/serial_transport.h"

#include <array>
#include <cerrno>
#include <optional>
#include <utility>

#include <QSerialPort>
#include <sys/file.h>
#include <sys/ioctl.h>

#include "devices/transport/port_access.h"
#include "devices/transport/serial_ports.h"

namespace lumorph {

namespace {

class SerialTransport final : public Transport {
public:
    SerialTransport(SerialAddress address, Events events);
    ~SerialTransport() override { close(); }
    SerialTransport(const SerialTransport&) = delete;
    SerialTransport& operator=(const SerialTransport&) = delete;

    void open() override;
    void close() override;
    [[nodiscard]] bool isOpen() const override { return open_; }
    void write(std::span<const std::uint8_t> message) override;
    [[nodiscard]] std::size_t unsent() const override;
    [[nodiscard]] std::string identity() const override { return facts_.serialNumber; }
    [[nodiscard]] std::string product() const override { return facts_.description; }
    [[nodiscard]] SharedLink shared() const override { return {open_ ? static_cast<int>(port_.handle()) : -1, 0}; }

private:
    std::optional<LinkTrouble> tryOpen();
    [[nodiscard]] LinkTrouble whyNotOpened() const;
    void read();
    void endOn(QSerialPort::SerialPortError error);

    SerialAddress address_;
    Events events_;
    QSerialPort port_;
    SerialPort facts_;
    bool open_ = false; ///< QSerialPort's own word stays true on a dead port
};

SerialTransport::SerialTransport(SerialAddress address, Events events)
    : address_(std::move(address)), events_(std::move(events)) {
    QObject::connect(&port_, &QSerialPort::readyRead, &port_, [this] { read(); });
    QObject::connect(&port_, &QSerialPort::errorOccurred, &port_, [this](auto error) { endOn(error); });
}

void SerialTransport::open() {
    if (open_) return;
    if (const std::optional<LinkTrouble> trouble = tryOpen()) {
        if (port_.isOpen()) port_.close();
        events_.closed(*trouble);
        return;
    }
    facts_ = serialPortAt(address_.path, serialPorts()).value_or(SerialPort{});
    open_ = true;
    events_.opened();
}

std::optional<LinkTrouble> SerialTransport::tryOpen() {
    if (std::optional<LinkTrouble> trouble = accessTrouble(address_.path)) return trouble;
    if (isHeldByAnother(address_.path)) return inUse(address_.path);
    port_.setPortName(QString::fromStdString(address_.path));
    if (!port_.open(QIODevice::ReadWrite)) return whyNotOpened();
    // Root passes the lock of a terminal (TIOCEXCL), and a link to a port passes the lock file; this one nobody passes.
    if (::flock(port_.handle(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return inUse(address_.path);
    if (!port_.setBaudRate(address_.baud))
        return LinkTrouble{address_.path + " cannot do " + std::to_string(address_.baud) + " baud",
                           "choose 57600, 115200 or 9600 baud"};
    // Boards with a USB port of their own are silent until somebody is there. A pseudo-terminal has no such line.
    port_.setDataTerminalReady(true);
    port_.clearError();
    return std::nullopt;
}

LinkTrouble SerialTransport::whyNotOpened() const {
    // "Permission" is also Qt's word for a port that somebody has locked.
    if (port_.error() == QSerialPort::DeviceNotFoundError) return notThere(address_.path);
    if (port_.error() == QSerialPort::PermissionError)
        return accessTrouble(address_.path).value_or(inUse(address_.path));
    return {address_.path + " cannot be used as a serial port (" + port_.errorString().toStdString() + ")",
            "choose the port of the device, or unplug the device and plug it in again"};
}

void SerialTransport::close() {
    open_ = false;
    if (!port_.isOpen()) return;
    port_.clear(); // else the system waits up to half a minute for bytes that nobody takes
    port_.close();
}

void SerialTransport::write(std::span<const std::uint8_t> message) {
    if (!open_ || message.empty()) return;
    port_.write(reinterpret_cast<const char*>(message.data()), static_cast<qint64>(message.size()));
    // Now, not when the event loop comes round. May find the port dead and close it.
    if (open_) port_.flush();
}

std::size_t SerialTransport::unsent() const {
    if (!open_) return 0;
    int inSystem = 0;
    if (::ioctl(port_.handle(), TIOCOUTQ, &inSystem) != 0 || inSystem < 0) inSystem = 0;
    return static_cast<std::size_t>(port_.bytesToWrite()) + static_cast<std::size_t>(inSystem);
}

void SerialTransport::read() {
    std::array<std::uint8_t, 4096> bytes;
    while (open_) { // whoever receives may close it
        const qint64 count = port_.read(reinterpret_cast<char*>(bytes.data()), bytes.size());
        if (count <= 0) return;
        events_.received(std::span(bytes).first(static_cast<std::size_t>(count)));
    }
}

void SerialTransport::endOn(QSerialPort::SerialPortError error) {
    const bool ends =
        error == QSerialPort::ReadError || error == QSerialPort::WriteError || error == QSerialPort::ResourceError;
    if (!ends || !open_) return;
    close();
    events_.closed(accessTrouble(address_.path)
                       .value_or(LinkTrouble{"the device at " + address_.path + " went away",
                                             "check its cable and its power; it is connected again when it is back"}));
}

} // namespace

std::unique_ptr<Transport> makeSerialTransport(SerialAddress address, Transport::Events events) {
    return std::make_unique<SerialTransport>(std::move(address), std::move(events));
}

} // namespace lumorph
