#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "devices/controllers/servo_trace_rows.h"
#include "tests/support/simulated_devices.h"

/// How rows of a servo trace lie in a fuzzer's input: a byte chooses the board; then each row has a byte for its kind,
/// one for the milliseconds since the last (signed), two for its length (little endian), and its bytes.
namespace lumorph::servo_trace_input {

inline DeviceProfile profileOf(std::uint8_t board) {
    return test::profileOf(test::kSimulatedDevices[board % test::kSimulatedDevices.size()]);
}

inline void append(std::vector<std::uint8_t>& to, const ServoTraceRow& row, Microseconds sinceTheLast) {
    const auto kind = std::find(servo_trace::kKinds.begin(), servo_trace::kKinds.end(), row.kind);
    const long milliseconds = std::clamp<long>(sinceTheLast.count() / 1000, -128, 127);
    const std::size_t length = std::min<std::size_t>(row.bytes.size(), 0xFFFF);
    to.insert(to.end(),
              {static_cast<std::uint8_t>(kind - servo_trace::kKinds.begin()), static_cast<std::uint8_t>(milliseconds),
               static_cast<std::uint8_t>(length), static_cast<std::uint8_t>(length >> 8U)});
    to.insert(to.end(), row.bytes.begin(), row.bytes.begin() + static_cast<std::ptrdiff_t>(length));
}

inline std::vector<ServoTraceRow> rowsOf(std::span<const std::uint8_t> input) {
    std::vector<ServoTraceRow> rows;
    Microseconds time{0};
    while (input.size() >= 4) {
        ServoTraceRow row;
        row.kind = servo_trace::kKinds[input[0] % servo_trace::kKinds.size()];
        time += Microseconds{1000 * static_cast<std::int8_t>(input[1])};
        row.time = time;
        const std::size_t length = std::min<std::size_t>(input[2] | input[3] << 8U, input.size() - 4);
        row.bytes.assign(input.begin() + 4, input.begin() + 4 + static_cast<std::ptrdiff_t>(length));
        input = input.subspan(4 + length);
        rows.push_back(std::move(row));
    }
    return rows;
}

} // namespace lumorph::servo_trace_input
