#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "core/base/clock.h"
#include "core/base/statistics.h"

namespace lumorph {

/// When commands went out, for the live table.
class LinkTraffic {
public:
    void commanded(Microseconds at) {
        if (!waiting_) waiting_ = at;
    }
    void settled() { waiting_.reset(); }
    /// Pulses were written. What the rate cap made them wait does not count.
    void wrote(Microseconds now, Microseconds period) {
        if (waiting_) {
            latencies_.push_back(now - std::max(*waiting_, last_ ? *last_ + period : *waiting_));
            if (latencies_.size() > kLatencies) latencies_.pop_front();
            waiting_.reset();
        }
        last_ = now;
        written_.push_back(now);
    }
    double perSecond(Microseconds now) {
        while (!written_.empty() && now - written_.front() > Microseconds{1'000'000}) written_.pop_front();
        return static_cast<double>(written_.size());
    }
    [[nodiscard]] double medianMilliseconds() const {
        const Microseconds usual = median(std::vector<Microseconds>(latencies_.begin(), latencies_.end()));
        return std::max(0.0, 1e-3 * static_cast<double>(usual.count()));
    }

private:
    static constexpr std::size_t kLatencies = 101; ///< so many are remembered

    std::optional<Microseconds> waiting_; ///< since when a command waits for its bytes
    std::optional<Microseconds> last_;
    std::deque<Microseconds> latencies_;
    std::deque<Microseconds> written_;
};

} // namespace lumorph
