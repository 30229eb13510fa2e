#include "devices/controllers/servo_trace_rows.h"

#include <algorithm>
#include <bit>
#include <string>

#include "core/base/error.h"
#include "devices/controllers/servo_engine.h"

namespace lumorph::servo_trace {
namespace {

constexpr const char* kRemedy = "take the recording from a copy, or record the session again";
constexpr std::size_t kMostStrokes = 4096;
constexpr std::int64_t kMostTime = 1'000'000'000'000'000; // microseconds: no machine has run for thirty years

using Bytes = std::vector<std::uint8_t>;

std::uint64_t zigzag(std::int64_t value) {
    return (static_cast<std::uint64_t>(value) << 1U) ^ static_cast<std::uint64_t>(value >> 63);
}
std::int64_t fromZigzag(std::uint64_t value) { return static_cast<std::int64_t>((value >> 1U) ^ (~(value & 1U) + 1U)); }
/// Times of a damaged row may be anything: a difference wraps around.
std::int64_t difference(std::int64_t a, std::int64_t b) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

class Writer {
public:
    void flag(bool on) { bytes.push_back(on ? 1 : 0); }
    void count(std::uint64_t value) {
        for (; value >= 0x80; value >>= 7U) bytes.push_back(static_cast<std::uint8_t>(value | 0x80U));
        bytes.push_back(static_cast<std::uint8_t>(value));
    }
    void real(double value) {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        for (unsigned shift = 0; shift < 64; shift += 8) bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
    }
    void text(std::string_view text) {
        count(text.size());
        rest(text);
    }
    void rest(std::string_view text) { bytes.insert(bytes.end(), text.begin(), text.end()); }

    Bytes bytes;
};

class Reader {
public:
    Reader(const ServoTraceRow& row, std::size_t number) : row_(row), left_(row.bytes), number_(number) {}

    [[nodiscard]] std::string subject() const {
        return "row " + std::to_string(number_) + " of the servo trace (" + row_.kind.substr(0, 20) + ")";
    }
    [[noreturn]] void refuse(const std::string& why) const { throw DataError(subject(), why, kRemedy); }

    bool flag() {
        const std::uint8_t value = byte();
        if (value > 1) refuse("holds " + std::to_string(value) + " where yes or no belongs");
        return value == 1;
    }
    std::uint64_t count() {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 64; shift += 7) {
            const std::uint8_t next = byte();
            if (shift == 63 && next > 1) break;
            value |= static_cast<std::uint64_t>(next & 0x7FU) << shift;
            if (next < 0x80) return value;
        }
        refuse("holds a number that is too large");
    }
    double real() {
        std::uint64_t bits = 0;
        for (unsigned shift = 0; shift < 64; shift += 8) bits |= static_cast<std::uint64_t>(byte()) << shift;
        return std::bit_cast<double>(bits);
    }
    std::string text() {
        const std::uint64_t size = count();
        if (size > left_.size()) refuse("ends in the middle of a text");
        std::string text(left_.begin(), left_.begin() + static_cast<std::ptrdiff_t>(size));
        left_ = left_.subspan(size);
        return text;
    }
    Bytes rest() {
        Bytes bytes(left_.begin(), left_.end());
        left_ = {};
        return bytes;
    }
    void checkTime(std::int64_t time) const {
        if (time < -kMostTime || time > kMostTime) refuse("tells a time that no clock shows");
    }
    [[nodiscard]] bool atEnd() const { return left_.empty(); }
    void end() const {
        if (!atEnd()) refuse("holds " + std::to_string(left_.size()) + " bytes too many");
    }
    /// A profile that an engine can be made for.
    DeviceProfile profile() {
        const Bytes text = rest();
        DeviceProfile profile =
            parseProfile({reinterpret_cast<const char*>(text.data()), text.size()}, subject() + ": its profile");
        try {
            (void)makeController(profile, parseDeviceAddress(profile.address));
        } catch (const InvalidInput& error) {
            refuse(error.subject() + ": " + error.why());
        }
        return profile;
    }

private:
    std::uint8_t byte() {
        if (left_.empty()) refuse("is cut short");
        const std::uint8_t value = left_.front();
        left_ = left_.subspan(1);
        return value;
    }

    const ServoTraceRow& row_;
    std::span<const std::uint8_t> left_;
    std::size_t number_;
};

namespace in = servo_input;

void write(Writer& to, const in::Arm& arm) { to.flag(arm.jumpAllowed); }
void write(Writer& to, const in::Command& command) {
    for (const double stroke : command.strokes) to.real(stroke);
}
void write(Writer& to, const in::Wiggle& wiggle) { to.count(wiggle.servo); }
void write(Writer& to, const in::Slow& slow) { to.flag(slow.on); }
void write(Writer& to, const in::Profile& order) { to.rest(profileText(order.profile)); }
void write(Writer& to, const in::Opened& opened) {
    to.text(opened.product);
    to.text(opened.identity);
}
void write(Writer& to, const in::Received& received) { to.bytes = received.bytes; }
void write(Writer& to, const in::Lost& lost) {
    to.text(lost.why.why);
    to.text(lost.why.remedy);
}
template <typename Nothing> void write(Writer&, const Nothing&) {}

std::string_view kindOf(const ServoInput& input) {
    // In the order of the variant.
    static constexpr std::string_view kNames[] = {"connect",  "disconnect", "confirm",  "arm",     "disarm", "stop",
                                                  "command",  "wiggle",     "slow",     "profile", "quit",   "opened",
                                                  "received", "lost",       "released", "ticks"};
    static_assert(std::size(kNames) == std::variant_size_v<ServoInput>);
    return kNames[input.index()];
}

in::Command readCommand(Reader& from) {
    in::Command command;
    while (!from.atEnd()) {
        if (command.strokes.size() == kMostStrokes) from.refuse("holds more strokes than any device has servos");
        command.strokes.push_back(from.real());
    }
    return command;
}

ServoInput readInput(const std::string& kind, Reader& from) {
    if (kind == "connect") return in::Connect{};
    if (kind == "disconnect") return in::Disconnect{};
    if (kind == "confirm") return in::Confirm{};
    if (kind == "arm") return in::Arm{from.flag()};
    if (kind == "disarm") return in::Disarm{};
    if (kind == "stop") return in::Stop{};
    if (kind == "command") return readCommand(from);
    if (kind == "wiggle") return in::Wiggle{from.count()};
    if (kind == "slow") return in::Slow{from.flag()};
    if (kind == "profile") return in::Profile{from.profile()};
    if (kind == "quit") return in::Quit{};
    if (kind == "released") return in::Released{};
    if (kind == "received") return in::Received{from.rest()};
    if (kind == "opened") {
        in::Opened opened;
        opened.product = from.text();
        opened.identity = from.text();
        return opened;
    }
    if (kind == "lost") {
        in::Lost lost;
        lost.why.why = from.text();
        lost.why.remedy = from.text();
        return lost;
    }
    from.refuse("is of a kind that is not known here");
}

std::vector<TimedInput> readTicks(Reader& from, Microseconds time) {
    std::vector<TimedInput> ticks;
    std::int64_t at = time.count();
    do {
        at = static_cast<std::int64_t>(static_cast<std::uint64_t>(at) +
                                       static_cast<std::uint64_t>(fromZigzag(from.count())));
        from.checkTime(at);
        ticks.push_back({Microseconds{at}, in::Tick{from.count()}});
    } while (!from.atEnd());
    return ticks;
}

} // namespace

ServoTraceRow machineRow(const DeviceProfile& profile, Microseconds time) {
    Writer to;
    to.bytes.push_back(ServoEngine::kVersion);
    to.rest(profileText(profile));
    return {time, std::string(kMachine), std::move(to.bytes)};
}

ServoTraceRow inputRow(const ServoInput& input, Microseconds time) {
    Writer to;
    std::visit([&to](const auto& one) { write(to, one); }, input);
    return {time, std::string(kindOf(input)), std::move(to.bytes)};
}

ServoTraceRow ticksRow(std::span<const TimedTick> ticks) {
    Writer to;
    Microseconds before = ticks.front().time;
    for (const TimedTick& tick : ticks) {
        to.count(zigzag(difference(tick.time.count(), before.count())));
        to.count(tick.unsent);
        before = tick.time;
    }
    return {ticks.front().time, "ticks", std::move(to.bytes)};
}

DeviceProfile machineProfile(const ServoTraceRow& row, std::size_t number) {
    Reader from(row, number);
    if (row.bytes.empty()) from.refuse("is cut short");
    if (row.bytes.front() != ServoEngine::kVersion)
        throw DataError(from.subject(),
                        "is of version " + std::to_string(row.bytes.front()) + " of the machine, and this is " +
                            std::to_string(ServoEngine::kVersion),
                        "check it with the version of Lumorph that recorded it");
    const ServoTraceRow rest{row.time, row.kind, {row.bytes.begin() + 1, row.bytes.end()}};
    return Reader(rest, number).profile();
}

std::vector<TimedInput> inputsOf(const ServoTraceRow& row, std::size_t number) {
    Reader from(row, number);
    from.checkTime(row.time.count());
    if (row.kind == "ticks") return readTicks(from, row.time);
    std::vector<TimedInput> inputs{{row.time, readInput(row.kind, from)}};
    from.end();
    return inputs;
}

} // namespace lumorph::servo_trace
