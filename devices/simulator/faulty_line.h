#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <random>
#include <vector>

#include "core/base/clock.h"
#include "devices/simulator/simulated_bench.h"

namespace lumorph {

/// One way of a wire: what is sent arrives in order, but late, broken or not at all, as the faults say. The same seed
/// and the same messages give the same faults.
class FaultyLine {
public:
    /// `wholeReports`: a loss takes a whole message, as on USB.
    FaultyLine(std::uint64_t seed, bool wholeReports) : random_(seed), wholeReports_(wholeReports) {}

    void send(std::vector<std::uint8_t> message, const BoardFaults& faults, Microseconds now);
    /// When the first message that is under way arrives.
    [[nodiscard]] std::optional<Microseconds> next() const;
    /// That message. There must be one.
    [[nodiscard]] std::vector<std::uint8_t> take();
    void clear();

private:
    struct Message {
        Microseconds arrives{0};
        std::vector<std::uint8_t> bytes;
    };

    double chance(); ///< in [0, 1)
    void lose(std::vector<std::uint8_t>& message, double share);
    void garble(std::vector<std::uint8_t>& message, double share);

    std::mt19937_64 random_;
    bool wholeReports_;
    std::deque<Message> messages_;
    std::size_t queued_ = 0; ///< bytes
};

} // namespace lumorph
