#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "core/base/error.h"
#include "tests/fuzz/servo_trace_input.h"
#include "tests/support/traced_engine.h"

namespace {

using namespace lumorph;

/// Rows as they come, behind a sound beginning: they are taken or refused, and shifted ones give the same result.
void checkAsTheyAre(const DeviceProfile& profile, const std::vector<ServoTraceRow>& rows) {
    std::vector<ServoTraceRow> trace{servo_trace::machineRow(profile, {})};
    trace.insert(trace.end(), rows.begin(), rows.end());
    try {
        const TraceCheck first = checkTrace(trace);
        for (ServoTraceRow& row : trace) row.time += Microseconds{12'345};
        const TraceCheck second = checkTrace(trace);
        if (first.inputs != second.inputs || first.bytesSent != second.bytesSent ||
            first.difference.has_value() != second.difference.has_value())
            std::abort();
    } catch (const DataError&) {
    }
}

/// A session of their inputs: its trace is equal bit for bit when it is run again.
void runAsASession(const DeviceProfile& profile, const std::vector<ServoTraceRow>& rows) {
    test::TracedEngine traced(profile, {});
    for (const ServoTraceRow& row : rows) {
        if (row.kind == servo_trace::kMachine || row.kind == servo_trace::kSent || row.kind == servo_trace::kMissing)
            continue;
        try {
            for (const servo_trace::TimedInput& timed : servo_trace::inputsOf(row, 0))
                (void)traced.take(timed.input, timed.time);
        } catch (const DataError&) {
        }
    }
    if (checkTrace(traced.rows).difference) std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const DeviceProfile profile = servo_trace_input::profileOf(data[0]);
    const std::vector<ServoTraceRow> rows = servo_trace_input::rowsOf({data + 1, size - 1});
    checkAsTheyAre(profile, rows);
    runAsASession(profile, rows);
    return 0;
}
