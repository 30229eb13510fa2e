#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "devices/controllers/servo_trace_rows.h"

namespace lumorph {

/// The history of one ServoEngine, packed (a few bytes a row), and handed on row by row to whoever wants it.
class ServoTraceLog {
public:
    using Sink = std::function<void(const ServoTraceRow&)>;
    static constexpr std::size_t kMostBytes = std::size_t{64} << 20U;

    explicit ServoTraceLog(std::size_t mostBytes = kMostBytes) : most_(mostBytes) {}

    void made(const DeviceProfile& profile, Microseconds now) { add(servo_trace::machineRow(profile, now)); }
    /// Ticks are gathered for up to a second.
    void took(const ServoInput& input, Microseconds now);
    /// All that came out of the last input, joined.
    void sent(std::vector<std::uint8_t> bytes, Microseconds now);

    /// Rows go to it, from the first on, as far as they are kept; an empty one ends the one before once it has all.
    void setSink(Sink sink);
    /// Hands on so many rows at most.
    void hand(std::size_t most);
    /// Whether rows wait for a sink.
    [[nodiscard]] bool hasMore() const noexcept { return sink_ && !atEnd(); }

private:
    /// Where the next row is read.
    struct Place {
        std::size_t chunk = 0;
        std::size_t offset = 0;
        std::int64_t time = 0;
    };
    void add(const ServoTraceRow& row);
    void closeTicks();
    void forgetAll();
    [[nodiscard]] bool atEnd() const noexcept;
    [[nodiscard]] ServoTraceRow next();

    std::size_t most_;
    std::deque<std::vector<std::uint8_t>> chunks_;
    std::size_t bytes_ = 0;
    std::int64_t lastTime_ = 0;
    bool whole_ = true;
    std::vector<servo_trace::TimedTick> ticks_;
    Sink sink_;
    bool ending_ = false;
    Sink following_; ///< once the one before has all
    Place place_;
};

} // namespace lumorph
