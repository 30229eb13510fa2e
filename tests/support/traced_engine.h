#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "devices/controllers/servo_engine.h"
#include "devices/controllers/servo_trace_log.h"

namespace lumorph::test {

/// A ServoEngine, and the trace of all that it takes and sends.
class TracedEngine {
public:
    TracedEngine(const DeviceProfile& profile, Microseconds now) : engine(profile) {
        log_.setSink([this](const ServoTraceRow& row) { rows.push_back(row); });
        log_.made(profile, now);
        log_.hand(1);
    }
    TracedEngine(const TracedEngine&) = delete;
    TracedEngine& operator=(const TracedEngine&) = delete;

    std::vector<ServoOutput> take(const ServoInput& input, Microseconds now) {
        log_.took(input, now);
        engine.take(input, now);
        std::vector<ServoOutput> outputs = engine.takeOutput();
        std::vector<std::uint8_t> sent;
        for (const ServoOutput& output : outputs)
            if (const auto* write = std::get_if<servo_output::Write>(&output))
                sent.insert(sent.end(), write->bytes.begin(), write->bytes.end());
        if (!sent.empty()) log_.sent(sent, now);
        log_.hand(1'000'000);
        return outputs;
    }

    ServoEngine engine;
    std::vector<ServoTraceRow> rows;

private:
    ServoTraceLog log_;
};

} // namespace lumorph::test
