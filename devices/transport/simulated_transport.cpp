#include "devices/transport/simulated_transport.h"

#include <charconv>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include <QTimer>

#include "core/base/error.h"
#include "devices/simulator/faulty_line.h"
#include "devices/simulator/simulated_bench.h"

namespace lumorph {

namespace {

constexpr std::chrono::milliseconds kStep{2};
constexpr std::size_t kHidReport = 64;
constexpr int kMostGiven = 64; // pieces from the board in one step: a mad board must not hold up the thread

using Bytes = std::vector<std::uint8_t>;

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

BoardFaults faultsOf(const SimulatedAddress& address) {
    for (const auto& [key, value] : address.options)
        if (key != "jitter" && key != "drop" && key != "noise")
            throw InvalidInput("simulated device '" + address.device + "'", "it has no option '" + key + "'",
                               "use jitter (milliseconds), drop and noise (shares of bytes, 0 to 1)");
    BoardFaults faults;
    faults.noise = readOption(address, "noise", 1.0);
    faults.drop = readOption(address, "drop", 1.0);
    faults.jitterMilliseconds = readOption(address, "jitter", 1000.0);
    return faults;
}

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
    void dropUnsent() override { unsent_.clear(); }
    [[nodiscard]] std::size_t unsent() const override;
    [[nodiscard]] std::string identity() const override { return "simulated " + board_->name(); }
    [[nodiscard]] std::string product() const override { return board_->product(); }

private:
    [[nodiscard]] std::optional<LinkTrouble> away() const;
    void step();
    void carryOut(Microseconds now);
    void carryIn(Microseconds now);

    std::shared_ptr<SimulatedBoard> board_;
    BoardFaults options_;
    Events events_;
    std::function<Microseconds()> now_;
    QTimer timer_;
    bool open_ = false;
    std::deque<Bytes> unsent_; ///< held back by a stalled link
    FaultyLine out_{1, board_->isHid()};
    FaultyLine in_{2, board_->isHid()};
};

void SimulatedTransport::open() {
    if (open_) return;
    std::optional<LinkTrouble> trouble = simulatedTrouble(board_->name(), board_->faults());
    if (!trouble) trouble = away();
    if (trouble) {
        events_.closed(*trouble);
        return;
    }
    open_ = true;
    board_->plugged(now_());
    timer_.start();
    events_.opened();
}

/// Why an open link is at its end.
std::optional<LinkTrouble> SimulatedTransport::away() const {
    if (const BoardFaults faults = board_->faults(); faults.unplugged) return simulatedTrouble(board_->name(), faults);
    if (board_->present()) return std::nullopt;
    return LinkTrouble{"the simulated device '" + board_->name() + "' has gone from the USB",
                       "check its power; it is connected again when it is back"};
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
    if (!faults.unplugged && !faults.stalled) carryOut(now_());
}

std::size_t SimulatedTransport::unsent() const {
    std::size_t sum = 0;
    for (const Bytes& bytes : unsent_) sum += bytes.size();
    return sum;
}

void SimulatedTransport::step() {
    if (const std::optional<LinkTrouble> why = away()) {
        close();
        events_.closed(*why);
        return;
    }
    if (board_->faults().stalled) return;
    const Microseconds now = now_();
    carryOut(now);
    carryIn(now);
}

void SimulatedTransport::carryOut(Microseconds now) {
    for (; !unsent_.empty(); unsent_.pop_front()) out_.send(std::move(unsent_.front()), options_, now);
    while (out_.next() && *out_.next() <= now) board_->take(out_.take(), now);
}

void SimulatedTransport::carryIn(Microseconds now) {
    for (int i = 0; i < kMostGiven; ++i) {
        Bytes bytes = board_->give(now);
        if (bytes.empty()) break;
        in_.send(std::move(bytes), options_, now);
    }
    // Whoever receives may close it.
    while (open_ && in_.next() && *in_.next() <= now) events_.received(in_.take());
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
