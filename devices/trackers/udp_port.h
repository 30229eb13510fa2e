#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <QHostAddress>
#include <QUdpSocket>

namespace lumorph {

/// The IPv4 addresses of this machine.
[[nodiscard]] std::vector<QHostAddress> ownAddresses();
/// "192.168.0.5, 127.0.0.1".
[[nodiscard]] std::string listOf(const std::vector<QHostAddress>& addresses);

/// Lets packets of this machine through, and others only where the user opened the way.
class PacketGate {
public:
    explicit PacketGate(bool openToNetwork) : open_(openToNetwork) { refresh(); }
    /// Networks come and go.
    void refresh() { own_ = ownAddresses(); }
    [[nodiscard]] bool isOpen() const noexcept { return open_; }
    [[nodiscard]] bool isOwn(const QHostAddress& sender) const;
    [[nodiscard]] bool lets(const QHostAddress& sender) const { return open_ || isOwn(sender); }
    [[nodiscard]] const std::vector<QHostAddress>& own() const noexcept { return own_; }

private:
    bool open_;
    std::vector<QHostAddress> own_;
};

struct UdpBinding {
    QHostAddress local;
    quint16 port = 0;    ///< 0: one that the system chooses
    bool shared = false; ///< others may listen too, as to a multicast group
};

/// A UDP socket in a thread with an event loop; hands over what comes, one datagram after the other.
class UdpPort {
public:
    using OnPacket = std::function<void(std::span<const std::byte>, const QHostAddress& sender, quint16 port)>;

    /// Throws DeviceError that says who has the port, as far as the system tells.
    UdpPort(const UdpBinding& binding, OnPacket onPacket);
    /// From then on what is sent to the group comes too, but only by the interface with that address, or by the one
    /// that the system chooses where `local` is null. Throws DeviceError where the group cannot be joined there.
    void join(const QHostAddress& group, const QHostAddress& local);
    void send(std::span<const std::byte> bytes, const QHostAddress& to, quint16 port);
    [[nodiscard]] quint16 port() const { return socket_.localPort(); }

private:
    void read();

    QUdpSocket socket_;
    OnPacket onPacket_;
    std::vector<std::byte> buffer_;
};

} // namespace lumorph
