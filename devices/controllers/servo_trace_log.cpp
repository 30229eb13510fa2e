#include "devices/controllers/servo_trace_log.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace lumorph {
namespace {

constexpr std::size_t kChunk = 1U << 16U; // bytes; growing one array would copy megabytes at once
constexpr std::size_t kMostTicks = 256;   // of a row
constexpr Microseconds kLongestRow{1'000'000};

void putCount(std::vector<std::uint8_t>& bytes, std::uint64_t value) {
    for (; value >= 0x80; value >>= 7U) bytes.push_back(static_cast<std::uint8_t>(value | 0x80U));
    bytes.push_back(static_cast<std::uint8_t>(value));
}

std::uint64_t takeCount(const std::vector<std::uint8_t>& bytes, std::size_t& at) {
    std::uint64_t value = 0;
    for (unsigned shift = 0;; shift += 7) {
        const std::uint8_t next = bytes[at++];
        value |= static_cast<std::uint64_t>(next & 0x7FU) << shift;
        if (next < 0x80) return value;
    }
}

} // namespace

void ServoTraceLog::took(const ServoInput& input, Microseconds now) {
    const auto* tick = std::get_if<servo_input::Tick>(&input);
    if (!tick) {
        closeTicks();
        add(servo_trace::inputRow(input, now));
        return;
    }
    ticks_.push_back({now, tick->unsent});
    const bool isLong = now < ticks_.front().time || now - ticks_.front().time >= kLongestRow;
    if (isLong || ticks_.size() >= kMostTicks) closeTicks();
}

void ServoTraceLog::sent(std::vector<std::uint8_t> bytes, Microseconds now) {
    closeTicks();
    if (!bytes.empty()) add({now, std::string(servo_trace::kSent), std::move(bytes)});
}

void ServoTraceLog::closeTicks() {
    if (ticks_.empty()) return;
    add(servo_trace::ticksRow(ticks_));
    ticks_.clear();
}

void ServoTraceLog::add(const ServoTraceRow& row) {
    if (!whole_ && !sink_) return; // nobody could do anything with it
    if (bytes_ + row.bytes.size() > most_) forgetAll();
    if (chunks_.empty() || chunks_.back().size() + row.bytes.size() + 32 > kChunk) {
        chunks_.emplace_back();
        chunks_.back().reserve(std::max(kChunk, row.bytes.size() + 32));
    }
    std::vector<std::uint8_t>& chunk = chunks_.back();
    const std::size_t before = chunk.size();
    const auto* const kind = std::ranges::find(servo_trace::kKinds, row.kind);
    chunk.push_back(static_cast<std::uint8_t>(kind - servo_trace::kKinds.begin()));
    // Unsigned, so that it wraps: times may be anything.
    const std::uint64_t gap = static_cast<std::uint64_t>(row.time.count()) - static_cast<std::uint64_t>(lastTime_);
    putCount(chunk, (gap << 1U) ^ (~(gap >> 63U) + 1U)); // zigzag
    putCount(chunk, row.bytes.size());
    chunk.insert(chunk.end(), row.bytes.begin(), row.bytes.end());
    lastTime_ = row.time.count();
    bytes_ += chunk.size() - before;
}

/// Who is listening gets the rest; who comes later is told that there was something.
void ServoTraceLog::forgetAll() {
    hand(std::numeric_limits<std::size_t>::max());
    chunks_.clear();
    bytes_ = 0;
    place_ = {.chunk = 0, .offset = 0, .time = lastTime_};
    whole_ = false;
}

void ServoTraceLog::setSink(Sink sink) {
    closeTicks();
    if (!sink_) {
        sink_ = std::move(sink);
        place_ = {};
        if (!sink_ || whole_) return;
        sink_({Microseconds{lastTime_}, std::string(servo_trace::kMissing), {}});
        chunks_.clear();
        bytes_ = 0;
        place_.time = lastTime_;
        return;
    }
    ending_ = true;
    following_ = std::move(sink);
}

void ServoTraceLog::hand(std::size_t most) {
    if (!sink_) return;
    for (; most > 0 && !atEnd(); --most) sink_(next());
    if (!ending_ || !atEnd()) return;
    sink_ = {};
    ending_ = false;
    if (following_) setSink(std::exchange(following_, {}));
}

bool ServoTraceLog::atEnd() const noexcept {
    if (place_.chunk >= chunks_.size()) return true;
    return place_.chunk + 1 == chunks_.size() && place_.offset >= chunks_.back().size();
}

ServoTraceRow ServoTraceLog::next() {
    if (place_.offset >= chunks_[place_.chunk].size()) {
        ++place_.chunk;
        place_.offset = 0;
    }
    const std::vector<std::uint8_t>& chunk = chunks_[place_.chunk];
    ServoTraceRow row;
    row.kind = servo_trace::kKinds[chunk[place_.offset++]];
    const std::uint64_t gap = takeCount(chunk, place_.offset);
    const std::uint64_t change = (gap >> 1U) ^ (~(gap & 1U) + 1U);
    place_.time = static_cast<std::int64_t>(static_cast<std::uint64_t>(place_.time) + change);
    row.time = Microseconds{place_.time};
    const std::uint64_t size = takeCount(chunk, place_.offset);
    const auto begin = chunk.begin() + static_cast<std::ptrdiff_t>(place_.offset);
    row.bytes.assign(begin, begin + static_cast<std::ptrdiff_t>(size));
    place_.offset += size;
    return row;
}

} // namespace lumorph
