#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "devices/protocol/natnet.h"

namespace {

using namespace lumorph::natnet;

constexpr std::array<Version, 10> kVersions = {
    {{2, 5}, {2, 6}, {2, 7}, {2, 9}, {2, 10}, {3, 0}, {3, 1}, {4, 0}, {4, 1}, {4, 2}}};

void readAny(std::span<const std::byte> payload, Message message, Version version) {
    switch (message) {
    case Message::connect:
        (void)readConnect(payload);
        break;
    case Message::serverInfo:
        (void)readServerInfo(payload);
        break;
    case Message::models:
        (void)readModels(payload, version);
        break;
    case Message::echoResponse:
        (void)readEcho(payload);
        break;
    default:
        break;
    }
}

} // namespace

/// The first byte chooses the version; the rest is a datagram.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    static FrameReader reader; // as in the studio, it keeps its memory
    const auto bytes = std::as_bytes(std::span(data, size)).subspan(1);
    const Version version = kVersions[data[0] % kVersions.size()];
    try {
        const Packet packet = readPacket(bytes);
        readAny(packet.payload, packet.message, version);
        if (packet.message != Message::frame) return 0;
        const Frame& frame = reader.read(packet.payload, version);
        // A packet cannot hold more than its bytes.
        if (frame.bodies.size() * 36 > size || frame.labelled.size() * 20 > size) std::abort();
    } catch (const lumorph::DataError&) {
        // A refusal is what a broken packet is meant to get.
    }
    return 0;
}
