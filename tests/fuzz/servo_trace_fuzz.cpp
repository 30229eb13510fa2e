#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "devices/controllers/servo_trace_rows.h"

/// Rows behind a sound beginning: each has a byte for its kind, one for the milliseconds since the last (signed), one
/// for its length, and its bytes. A row that is taken is written as it was; the same rows give the same result.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lumorph;
    DeviceProfile profile;
    profile.address = "sim://tablet";
    profile.controller = static_cast<ControllerKind>(size > 0 ? data[0] % 3 : 0);
    profile.servos = {{.channel = 2}, {.channel = 3}};
    std::vector<ServoTraceRow> trace{servo_trace::machineRow(profile, {})};
    Microseconds time{0};
    for (std::size_t at = 1; at + 3 <= size;) {
        ServoTraceRow row;
        row.kind = servo_trace::kKinds[data[at] % servo_trace::kKinds.size()];
        time += Microseconds{1000 * static_cast<std::int8_t>(data[at + 1])};
        row.time = time;
        const std::size_t length = std::min<std::size_t>(data[at + 2], size - at - 3);
        row.bytes.assign(data + at + 3, data + at + 3 + length);
        at += 3 + length;
        trace.push_back(row);
    }
    try {
        const TraceCheck first = checkTrace(trace);
        for (ServoTraceRow& row : trace) row.time += Microseconds{12'345};
        const TraceCheck second = checkTrace(trace);
        if (first.inputs != second.inputs || first.bytesSent != second.bytesSent ||
            first.difference.has_value() != second.difference.has_value())
            std::abort();
    } catch (const DataError&) {
    }
    return 0;
}
