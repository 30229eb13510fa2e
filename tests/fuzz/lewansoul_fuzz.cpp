#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "devices/protocol/lewansoul.h"
#include "tests/fuzz/slices.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lumorph;
    const std::span<const std::uint8_t> bytes(data, size);
    fuzz::expectSameInSlices(lewansoul::Parser(), bytes);
    // Whatever reports came before, the next is understood.
    lewansoul::Parser parser;
    for (std::size_t at = 0; at < size; at += lewansoul::kReportBytes)
        (void)parser.report(bytes.subspan(at, std::min(lewansoul::kReportBytes, size - at)));
    const std::uint8_t report[lewansoul::kReportBytes] = {0x55, 0x55, 0x04, 0x0F, 0xE8, 0x1C};
    const auto messages = parser.report(report);
    if (messages.size() != 1 || !(messages[0] == lewansoul::Message(lewansoul::Voltage{7.4}))) std::abort();
    return 0;
}
