#include "devices/controllers/servo_trace.h"

#include <algorithm>
#include <cstdio>
#include <memory>

#include "core/base/error.h"
#include "devices/controllers/servo_engine.h"
#include "devices/controllers/servo_trace_rows.h"

namespace lumorph {
namespace {

constexpr const char* kSubject = "the servo trace";

/// "E2 5C 0B", the first few.
std::string hexText(std::span<const std::uint8_t> bytes) {
    constexpr std::size_t kMost = 16;
    if (bytes.empty()) return "nothing";
    std::string text;
    for (const std::uint8_t byte : bytes.first(std::min(bytes.size(), kMost))) {
        char hex[4];
        std::snprintf(hex, sizeof(hex), "%02X", byte);
        text += (text.empty() ? "" : " ") + std::string(hex);
    }
    return bytes.size() > kMost ? text + " ... (" + std::to_string(bytes.size()) + " bytes)" : text;
}

/// The machine that a trace is run through, and what it sent that the trace has not told yet.
class TraceRun {
public:
    void row(const ServoTraceRow& row, std::size_t number) {
        if (row.kind == servo_trace::kSent) return compare(row, number);
        if (!pending_.empty())
            return differ(number, row.time, "the machine sends " + hexText(pending_) + " here, and the trace nothing");
        if (row.kind == servo_trace::kMachine) {
            engine_ = std::make_unique<ServoEngine>(servo_trace::machineProfile(row, number));
            return;
        }
        if (row.kind == servo_trace::kMissing)
            throw DataError(kSubject, "begins too late: the session had outgrown what is kept of it",
                            "begin the recording when the device is connected, or within the first hours");
        if (!engine_)
            throw DataError(kSubject, "does not begin with its machine", "give it whole, from its first row on");
        for (const servo_trace::TimedInput& timed : servo_trace::inputsOf(row, number)) {
            if (!pending_.empty())
                return differ(number, timed.time,
                              "the machine sends " + hexText(pending_) + " between two ticks, and the trace nothing");
            take(timed);
        }
    }

    TraceCheck check;

private:
    void take(const servo_trace::TimedInput& timed) {
        ++check.inputs;
        engine_->take(timed.input, timed.time);
        for (const ServoOutput& output : engine_->takeOutput())
            if (const auto* write = std::get_if<servo_output::Write>(&output))
                pending_.insert(pending_.end(), write->bytes.begin(), write->bytes.end());
    }
    void compare(const ServoTraceRow& row, std::size_t number) {
        const std::size_t size = std::min(row.bytes.size(), pending_.size());
        const auto [ours, theirs] =
            std::mismatch(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(size), row.bytes.begin());
        if (theirs != row.bytes.end())
            return differ(number, row.time,
                          "the trace has " + hexText(row.bytes) + ", and the machine sends " + hexText(pending_) +
                              "; byte " + std::to_string(theirs - row.bytes.begin() + 1) +
                              " is the first that differs");
        check.bytesSent += row.bytes.size();
        pending_.erase(pending_.begin(), ours);
    }
    void differ(std::size_t number, Microseconds time, std::string text) {
        check.difference = TraceCheck::Difference{number, time, std::move(text)};
    }

    std::unique_ptr<ServoEngine> engine_;
    std::vector<std::uint8_t> pending_;
};

} // namespace

TraceCheck checkTrace(std::span<const ServoTraceRow> trace) {
    if (trace.empty()) throw DataError(kSubject, "is empty", "record a session with a device that is connected");
    TraceRun run;
    for (std::size_t i = 0; i < trace.size() && !run.check.difference; ++i) run.row(trace[i], i);
    return run.check;
}

std::vector<double> tracedStrokes(const ServoTraceRow& row, std::size_t number) {
    std::vector<servo_trace::TimedInput> inputs = servo_trace::inputsOf(row, number);
    if (const auto* command = std::get_if<servo_input::Command>(&inputs.front().input)) return command->strokes;
    throw InvalidInput("row " + std::to_string(number), "is no command", "choose one of that kind");
}

} // namespace lumorph
