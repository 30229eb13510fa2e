#include "devices/simulator/faulty_line.h"

#include <algorithm>
#include <utility>

namespace lumorph {

namespace {

constexpr std::size_t kBuffer = 65536; // bytes that a stalled link keeps; what comes after them is lost

} // namespace

void FaultyLine::send(std::vector<std::uint8_t> message, const BoardFaults& faults, Microseconds now) {
    if (faults.drop > 0.0) lose(message, faults.drop);
    if (faults.noise > 0.0) garble(message, faults.noise);
    const double delay = faults.jitterMilliseconds > 0.0 ? 1000.0 * faults.jitterMilliseconds * chance() : 0.0;
    if (message.empty() || queued_ + message.size() > kBuffer) return;
    queued_ += message.size();
    Microseconds arrives = now + Microseconds(static_cast<Microseconds::rep>(delay));
    if (!messages_.empty()) arrives = std::max(arrives, messages_.back().arrives);
    messages_.push_back({arrives, std::move(message)});
}

void FaultyLine::lose(std::vector<std::uint8_t>& message, double share) {
    if (wholeReports_) {
        if (chance() < share) message.clear();
    } else {
        std::erase_if(message, [&](std::uint8_t) { return chance() < share; });
    }
}

void FaultyLine::garble(std::vector<std::uint8_t>& message, double share) {
    for (std::uint8_t& byte : message)
        if (chance() < share) byte = static_cast<std::uint8_t>(byte ^ (1U + random_() % 255U));
}

double FaultyLine::chance() { return static_cast<double>(random_() >> 11U) * 0x1p-53; }

std::optional<Microseconds> FaultyLine::next() const {
    if (messages_.empty()) return std::nullopt;
    return messages_.front().arrives;
}

std::vector<std::uint8_t> FaultyLine::take() {
    std::vector<std::uint8_t> bytes = std::move(messages_.front().bytes);
    messages_.pop_front();
    queued_ -= bytes.size();
    return bytes;
}

void FaultyLine::clear() {
    messages_.clear();
    queued_ = 0;
}

} // namespace lumorph
