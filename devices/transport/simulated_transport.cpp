#include "devices/transport/simulated_transport.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <deque>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <QTimer>

#include "core/base/error.h"
#include "devices/simulator/simulated_bench.h"

namespace lumorph {

namespace {

constexpr std::chrono::milliseconds kStep{2};
constexpr std::size_t kHidReport = 64;
constexpr int kMostGiven = 64; // pieces from the board in one step: a mad board must not hold up the thread

using Bytes = std::vector<std::uint8_t>;

/// What a wire does to bytes by chance.
struct WireFaults {
    double noise = 0.0;
    double drop = 0.0;
    double jitterMilliseconds = 0.0;
};

double readOption(const SimulatedAddress& address, const std::string& key, double largest) {
    const auto option = address.options.find(key);
    if (option == address.options.end()) return 0.0;
    const std::string& text = option->second;
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool isNumber = error == std::errc{} && end == text.data() + text.size();
    if (isNumber && value >= 0.0 && value <= largest) return value; // NaN is neither
    throw InvalidInput("simulated device '" + address.device + "'", "its " + key + " is '" + text + "'",
                       "write a number from 0 to " + std::to_string(static_cast<int>(largest)));
}

WireFaults faultsOf(const SimulatedAddress& address) {
    for (const auto& [key, value] : address.options)
        if (key != "jitter" && key != "drop" && key != "noise")
            throw InvalidInput("simulated device '" + address.device + "'", "it has no option '" + key + "'",
                               "use jitter (milliseconds), drop and noise (shares of bytes, 0 to 1)");
    return {readOption(address, "noise", 1.0), readOption(address, "drop", 1.0), readOption(address, "jitter", 1000.0)};
}

/// Bytes on their way in one direction; they keep their order.
class Wire {
public:
    Wire(bool isHid, std::uint32_t seed) : isHid_(isHid), random_(seed) {}

    void push(Bytes bytes, const WireFaults& faults, Microseconds now) {
        spoil(bytes, faults);
        if (bytes.empty()) return;
        const double delay = 1000.0 * faults.jitterMilliseconds * chance_(random_);
        latest_ = std::max(latest_, now + Microseconds(std::llround(delay)));
        onTheWay_.push_back({latest_, std::move(bytes)});
    }
    std::optional<Bytes> pop(Microseconds now) {
        if (onTheWay_.empty() || onTheWay_.front().due > now) return std::nullopt;
        Bytes bytes = std::move(onTheWay_.front().bytes);
        onTheWay_.pop_front();
        return bytes;
    }
    void clear() { onTheWay_.clear(); }

private:
    struct Piece {
        Microseconds due;
        Bytes bytes;
    };

    void spoil(Bytes& bytes, const WireFaults& faults) {
        const auto happens = [&](double share) { return share > 0.0 && chance_(random_) < share; };
        if (isHid_ && happens(faults.drop)) bytes.clear(); // reports come whole or not at all
        if (!isHid_) std::erase_if(bytes, [&](std::uint8_t) { return happens(faults.drop); });
        for (std::uint8_t& byte : bytes)
            if (happens(faults.noise)) byte ^= static_cast<std::uint8_t>(1 + random_() % 255);
    }

    bool isHid_;
    std::mt19937 random_;
    std::uniform_real_distribution<double> chance_{0.0, 1.0};
    Microseconds latest_{0};
    std::deque<Piece> onTheWay_;
};

class SimulatedTransport final : public Transport {
public:
    SimulatedTransport(std::shared_ptr<SimulatedBoard> board, const SimulatedAddress& address, Events events,
                       std::function<Microseconds()> now)
        : board_(std::move(board)), options_(faultsOf(address)), events_(std::move(events)), now_(std::move(now)) {
        timer_.setTimerType(Qt::PreciseTimer);
        timer_.setInterval(kStep);
        timer_.callOnTimeout([this] { step(); });
    }

    void open() override;
    void close() override;
    [[nodiscard]] bool isOpen() const override { return open_; }
    void write(std::span<const std::uint8_t> message) override;
    [[nodiscard]] std::size_t unsent() const override;
    [[nodiscard]] std::string identity() const override { return "simulated " + board_->name(); }
    [[nodiscard]] std::string product() const override { return board_->product(); }

private:
    [[nodiscard]] WireFaults worst(const BoardFaults& faults) const;
    void step();
    void carryOut(const BoardFaults& faults, Microseconds now);
    void carryIn(const BoardFaults& faults, Microseconds now);

    std::shared_ptr<SimulatedBoard> board_;
    WireFaults options_;
    Events events_;
    std::function<Microseconds()> now_;
    QTimer timer_;
    bool open_ = false;
    std::deque<Bytes> unsent_; ///< held back by a stalled link
    Wire out_{board_->isHid(), 1};
    Wire in_{board_->isHid(), 2};
};

void SimulatedTransport::open() {
    if (open_) return;
    if (const std::optional<LinkTrouble> trouble = simulatedTrouble(board_->name(), board_->faults())) {
        events_.closed(*trouble);
        return;
    }
    open_ = true;
    board_->plugged(now_());
    timer_.start();
    events_.opened();
}

void SimulatedTransport::close() {
    open_ = false;
    timer_.stop();
    unsent_.clear();
    out_.clear();
    in_.clear();
}

void SimulatedTransport::write(std::span<const std::uint8_t> message) {
    if (board_->isHid() && message.size() > kHidReport)
        throw InvalidInput("message of " + std::to_string(message.size()) + " bytes", "a USB report holds 64",
                           "send it in parts");
    if (!open_ || message.empty()) return;
    Bytes bytes(message.begin(), message.end());
    if (board_->isHid()) bytes.resize(kHidReport);
    unsent_.push_back(std::move(bytes));
    const BoardFaults faults = board_->faults();
    if (!faults.unplugged) carryOut(faults, now_());
}

std::size_t SimulatedTransport::unsent() const {
    std::size_t sum = 0;
    for (const Bytes& bytes : unsent_) sum += bytes.size();
    return sum;
}

WireFaults SimulatedTransport::worst(const BoardFaults& faults) const {
    return {std::max(options_.noise, faults.noise), std::max(options_.drop, faults.drop),
            std::max(options_.jitterMilliseconds, faults.jitterMilliseconds)};
}

void SimulatedTransport::step() {
    const BoardFaults faults = board_->faults();
    if (faults.unplugged) {
        close();
        events_.closed(*simulatedTrouble(board_->name(), faults));
        return;
    }
    if (faults.stalled) return;
    const Microseconds now = now_();
    carryOut(faults, now);
    carryIn(faults, now);
}

void SimulatedTransport::carryOut(const BoardFaults& faults, Microseconds now) {
    if (faults.stalled) return;
    for (; !unsent_.empty(); unsent_.pop_front()) out_.push(std::move(unsent_.front()), worst(faults), now);
    while (const std::optional<Bytes> bytes = out_.pop(now)) board_->take(*bytes, now);
}

void SimulatedTransport::carryIn(const BoardFaults& faults, Microseconds now) {
    for (int i = 0; i < kMostGiven; ++i) {
        Bytes bytes = board_->give(now);
        if (bytes.empty()) break;
        in_.push(std::move(bytes), worst(faults), now);
    }
    while (open_) { // whoever receives may close it
        const std::optional<Bytes> bytes = in_.pop(now);
        if (!bytes) return;
        events_.received(*bytes);
    }
}

} // namespace

std::optional<LinkTrouble> simulatedTrouble(const std::string& board, const BoardFaults& faults) {
    const std::string name = "the simulated device '" + board + "'";
    if (faults.unplugged) return LinkTrouble{name + " is unplugged", "plug it in on the simulator's panel"};
    if (faults.forbidden)
        return LinkTrouble{"permission denied on " + name, "allow access to it on the simulator's panel"};
    if (faults.busy) return LinkTrouble{"another program uses " + name, "let it go on the simulator's panel"};
    return std::nullopt;
}

std::unique_ptr<Transport> makeSimulatedTransport(std::shared_ptr<SimulatedBoard> board,
                                                  const SimulatedAddress& address, Transport::Events events,
                                                  std::function<Microseconds()> now) {
    return std::make_unique<SimulatedTransport>(std::move(board), address, std::move(events), std::move(now));
}

} // namespace lumorph
