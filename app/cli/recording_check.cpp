#include "app/cli/recording_check.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include "core/base/error.h"

namespace lumorph::cli {

namespace {

/// A slow link takes a command late, but not later than so.
constexpr Microseconds kLatest{10'000'000};

/// Bit for bit: what is no number equals itself, and -0 is not 0.
bool same(const std::vector<double>& a, const std::vector<double>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

std::vector<ServoTraceRow> traceOf(const Recording& recording) {
    std::vector<ServoTraceRow> trace;
    trace.reserve(recording.servo.size());
    for (const ServoRow& row : recording.servo) trace.push_back({row.time, row.kind, row.bytes});
    return trace;
}

void compareStates(const std::vector<ServoTraceRow>& trace, const std::vector<FrameRow>& frames,
                   RecordingCheck& check) {
    if (frames.empty()) return;
    std::size_t next = 0; // no command is of a frame before this
    for (std::size_t i = 0; i < trace.size(); ++i) {
        const ServoTraceRow& row = trace[i];
        if (row.kind != "command" || row.time < frames.front().time || row.time > frames.back().time + kLatest)
            continue;
        const std::vector<double> strokes = tracedStrokes(row, i);
        ++check.commands;
        while (next < frames.size() && frames[next].time < row.time - kLatest) ++next;
        std::size_t found = next;
        while (found < frames.size() && frames[found].time <= row.time && !same(frames[found].estimated, strokes))
            ++found;
        if (found < frames.size() && frames[found].time <= row.time) {
            ++check.framed;
            next = found;
        } else if (check.firstOther.empty()) {
            char text[80];
            std::snprintf(text, sizeof(text), "the command at %.3f s (row %zu)",
                          1e-6 * static_cast<double>(row.time.count()), i);
            check.firstOther = text;
        }
    }
}

} // namespace

RecordingCheck checkRecording(const Recording& recording) {
    if (recording.servo.empty())
        throw DataError("the recording", "holds no servo traffic", "record a session while a device is connected");
    const std::vector<ServoTraceRow> trace = traceOf(recording);
    RecordingCheck check;
    check.servos = checkTrace(trace);
    compareStates(trace, recording.frames, check);
    return check;
}

} // namespace lumorph::cli
