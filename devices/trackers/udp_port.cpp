#include "devices/trackers/udp_port.h"

#include <algorithm>
#include <utility>

#include <netinet/in.h>
#include <sys/socket.h>

#include <QNetworkInterface>

#include "core/base/error.h"
#include "devices/trackers/port_owner.h"

namespace lumorph {

namespace {

constexpr std::size_t kLargestDatagram = 65536;
constexpr int kAtOnce = 256; ///< a flood leaves time for the rest of the thread

QNetworkInterface interfaceOf(const QHostAddress& local) {
    for (const QNetworkInterface& candidate : QNetworkInterface::allInterfaces())
        for (const QNetworkAddressEntry& entry : candidate.addressEntries())
            if (entry.ip() == local) return candidate;
    return {};
}

/// Otherwise a socket hears a group on every interface on which any program of this machine has joined it.
bool receiveOnlyWhereJoined(const QUdpSocket& socket) {
    const int all = 0;
    return ::setsockopt(static_cast<int>(socket.socketDescriptor()), IPPROTO_IP, IP_MULTICAST_ALL, &all, sizeof all) ==
           0;
}

[[noreturn]] void refusePort(const UdpBinding& binding, const QUdpSocket& socket) {
    const std::string subject = "UDP port " + std::to_string(binding.port);
    if (socket.error() == QAbstractSocket::AddressInUseError) {
        const std::string owner = programAtUdpPort(binding.port);
        throw DeviceError(subject, owner.empty() ? "another program has it" : owner + " has it",
                          "close that program, or choose another port on both sides");
    }
    if (socket.error() == QAbstractSocket::SocketAddressNotAvailableError)
        throw DeviceError(subject, binding.local.toString().toStdString() + " is no address of this machine",
                          "use one of " + listOf(ownAddresses()));
    throw DeviceError(subject, socket.errorString().toStdString(), "choose another port, above 1023");
}

} // namespace

std::vector<QHostAddress> ownAddresses() {
    std::vector<QHostAddress> own;
    for (const QHostAddress& address : QNetworkInterface::allAddresses())
        if (address.protocol() == QAbstractSocket::IPv4Protocol) own.push_back(address);
    return own;
}

std::string listOf(const std::vector<QHostAddress>& addresses) {
    std::string list;
    for (const QHostAddress& address : addresses) list += (list.empty() ? "" : ", ") + address.toString().toStdString();
    return list;
}

bool PacketGate::isOwn(const QHostAddress& sender) const {
    return sender.isLoopback() || std::ranges::find(own_, sender) != own_.end();
}

UdpPort::UdpPort(const UdpBinding& binding, OnPacket onPacket)
    : onPacket_(std::move(onPacket)), buffer_(kLargestDatagram) {
    const QUdpSocket::BindMode mode = binding.shared ? QUdpSocket::ShareAddress | QUdpSocket::ReuseAddressHint
                                                     : QUdpSocket::BindMode(QUdpSocket::DontShareAddress);
    if (!socket_.bind(binding.local, binding.port, mode)) refusePort(binding, socket_);
    QObject::connect(&socket_, &QUdpSocket::readyRead, &socket_, [this] { read(); });
}

void UdpPort::join(const QHostAddress& group, const QHostAddress& local) {
    const auto refuse = [&](const std::string& why) {
        throw DeviceError("multicast group " + group.toString().toStdString(), why,
                          "say which network to use with local=, one of " + listOf(ownAddresses()));
    };
    const QNetworkInterface network = local.isNull() ? QNetworkInterface() : interfaceOf(local);
    // Qt would let the system choose, where the one that is meant is missing.
    if (!local.isNull() && !network.isValid())
        refuse(local.toString().toStdString() + " is no address of this machine");
    if (!receiveOnlyWhereJoined(socket_)) refuse("it cannot be kept to one network");
    const bool joined = local.isNull() ? socket_.joinMulticastGroup(group) : socket_.joinMulticastGroup(group, network);
    if (!joined) refuse(socket_.errorString().toStdString());
}

void UdpPort::send(std::span<const std::byte> bytes, const QHostAddress& to, quint16 port) {
    // What cannot be sent is as good as lost on the way; the answer that stays away tells.
    socket_.writeDatagram(reinterpret_cast<const char*>(bytes.data()), static_cast<qint64>(bytes.size()), to, port);
}

void UdpPort::read() {
    QHostAddress sender;
    quint16 port = 0;
    // One is read in any case: the socket does not tell of others before.
    for (int i = 0; i < kAtOnce && (i == 0 || socket_.hasPendingDatagrams()); ++i) {
        const qint64 size = socket_.readDatagram(reinterpret_cast<char*>(buffer_.data()),
                                                 static_cast<qint64>(buffer_.size()), &sender, &port);
        if (size < 0) continue; // a machine answered that nobody listens there
        onPacket_(std::span<const std::byte>(buffer_).first(static_cast<std::size_t>(size)), sender, port);
    }
}

} // namespace lumorph
