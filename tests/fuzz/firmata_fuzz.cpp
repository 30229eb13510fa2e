#include <cstddef>
#include <cstdint>

#include "devices/protocol/firmata.h"
#include "tests/fuzz/slices.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::span<const std::uint8_t> bytes(data, size);
    lumorph::fuzz::expectSameInSlices(lumorph::firmata::Parser(), bytes);
    // Whatever came before, a version that follows is understood.
    lumorph::firmata::Parser parser;
    (void)parser.feed(bytes);
    const std::uint8_t version[] = {0xF9, 0x02, 0x05};
    const auto messages = parser.feed(version);
    if (messages.size() != 1 || !(messages[0] == lumorph::firmata::Message(lumorph::firmata::Version{2, 5})))
        std::abort();
    return 0;
}
