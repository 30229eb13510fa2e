#include "devices/protocol/natnet.h"

#include <algorithm>
#include <cstring>

#include "devices/protocol/natnet_bytes.h"

namespace lumorph::natnet {

namespace {

constexpr std::size_t kHeaderBytes = 4;
constexpr std::size_t kNameBytes = 256;

std::vector<std::byte> packet(Message message, std::size_t payload) {
    std::vector<std::byte> bytes(kHeaderBytes + payload);
    const auto id = static_cast<std::uint16_t>(message);
    const auto size = static_cast<std::uint16_t>(payload);
    std::memcpy(bytes.data(), &id, sizeof id);
    std::memcpy(bytes.data() + 2, &size, sizeof size);
    return bytes;
}

std::array<std::uint8_t, 4> takeFour(Bytes& bytes) {
    std::array<std::uint8_t, 4> four{};
    std::memcpy(four.data(), bytes.skip(4).data(), 4);
    return four;
}

/// A name in a field of fixed size; behind its zero there may be anything.
std::string takeName(Bytes& bytes) {
    const auto field = bytes.skip(kNameBytes);
    const auto end = std::ranges::find(field, std::byte{0});
    return {reinterpret_cast<const char*>(field.data()), static_cast<std::size_t>(end - field.begin())};
}

ServerInfo takeIntroduction(Bytes& bytes) {
    ServerInfo info;
    info.name = takeName(bytes);
    info.program = takeFour(bytes);
    const auto natnet = takeFour(bytes);
    info.natnet = {natnet[0], natnet[1]};
    return info;
}

} // namespace

Packet readPacket(std::span<const std::byte> datagram) {
    Bytes bytes(datagram);
    if (datagram.size() < kHeaderBytes) refusePacket("it has no header");
    const auto message = static_cast<Message>(bytes.take<std::uint16_t>());
    const auto size = bytes.take<std::uint16_t>();
    if (size > bytes.left())
        refusePacket("its header tells of " + std::to_string(size) + " bytes and " + std::to_string(bytes.left()) +
                     " came");
    return {message, bytes.skip(size)};
}

ServerInfo readServerInfo(std::span<const std::byte> payload) {
    Bytes bytes(payload);
    ServerInfo info = takeIntroduction(bytes);
    if (info.natnet < Version{3, 0}) return info;
    Connection connection;
    connection.clockHertz = bytes.take<std::uint64_t>();
    connection.dataPort = bytes.take<std::uint16_t>();
    connection.multicast = bytes.take<std::uint8_t>() != 0;
    connection.address = takeFour(bytes);
    info.connection = connection;
    return info;
}

ServerInfo readConnect(std::span<const std::byte> payload) {
    Bytes bytes(payload);
    return takeIntroduction(bytes);
}

Echo readEcho(std::span<const std::byte> payload) {
    Bytes bytes(payload);
    Echo echo;
    echo.sent = bytes.take<std::uint64_t>();
    echo.received = bytes.take<std::uint64_t>();
    return echo;
}

std::vector<std::byte> connectPacket(std::string_view name, std::array<std::uint8_t, 4> program) {
    constexpr std::array<std::uint8_t, 4> kNewest = {4, 1, 0, 0};
    std::vector<std::byte> bytes = packet(Message::connect, kNameBytes + 8);
    std::byte* const field = bytes.data() + kHeaderBytes;
    std::memcpy(field, name.data(), std::min(name.size(), kNameBytes - 1));
    std::memcpy(field + kNameBytes, program.data(), program.size());
    std::memcpy(field + kNameBytes + 4, kNewest.data(), kNewest.size());
    return bytes;
}

std::vector<std::byte> keepAlivePacket() { return packet(Message::keepAlive, 0); }

std::vector<std::byte> modelsRequestPacket() { return packet(Message::requestModels, 0); }

std::vector<std::byte> echoPacket(std::uint64_t number) {
    std::vector<std::byte> bytes = packet(Message::echoRequest, sizeof number);
    std::memcpy(bytes.data() + kHeaderBytes, &number, sizeof number);
    return bytes;
}

} // namespace lumorph::natnet
