#include "devices/simulator/wired_board.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "devices/simulator/faulty_line.h"

namespace lumorph {

namespace {

constexpr double kBrownOutVolts = 5.2;
constexpr std::size_t kBrownOutServos = 3;     // that many at once draw more than a weak battery gives
constexpr std::size_t kReport = 64;            // bytes
constexpr const char* kAdapter = "USB Serial"; // what adapters call themselves, whatever is behind them
constexpr double kLongestJitter = 60000.0;     // milliseconds
constexpr double kHighestVolts = 16.0;

/// What cannot be is taken for the nearest that can; no number for none.
double within(double value, double high) { return value > 0.0 ? std::min(value, high) : 0.0; }

/// A board and its wire. What was due is worked off when somebody looks, in the order in which it would have happened.
class Machine {
public:
    Machine(const BoardKind& kind, std::uint64_t seed, Microseconds now)
        : kind_(kind), time_(now), hardware_{ServoBank(kind.servos, kind.hornSpeed), BoardFaults{}.volts, {}},
          program_(kind.makeProgram(hardware_)), toBoard_(2 * seed, kind.isHid), toStudio_(2 * seed + 1, kind.isHid) {
        hardware_.servos.advance(now);
    }
    Machine(const Machine&) = delete; // its program holds its hardware
    Machine& operator=(const Machine&) = delete;

    [[nodiscard]] const BoardFaults& faults() const { return faults_; }
    [[nodiscard]] bool running() const { return program_ != nullptr; }
    [[nodiscard]] const std::vector<SimulatedServo>& servos() const { return hardware_.servos.servos(); }

    void advance(Microseconds now) {
        while (const auto next = nextEvent()) {
            if (next->second > now) break;
            moveTo(next->second);
            happen(next->first);
            settle();
        }
        moveTo(now);
    }

    void setFaults(const BoardFaults& faults) {
        faults_ = faults;
        faults_.noise = within(faults.noise, 1.0);
        faults_.drop = within(faults.drop, 1.0);
        faults_.jitterMilliseconds = within(faults.jitterMilliseconds, kLongestJitter);
        faults_.volts = within(faults.volts, kHighestVolts);
        hardware_.volts = faults_.volts;
        hardware_.servos.hold(faults_.held);
        settle();
        advance(time_);
    }

    void loseEverything() {
        program_.reset();
        hardware_.servos.allLimp();
        hardware_.said.clear();
        startsAt_ = time_ + kind_.startsIn;
    }

    void newLink() {
        toBoard_.clear();
        toStudio_.clear();
    }

    void take(std::span<const std::uint8_t> bytes) {
        toBoard_.send({bytes.begin(), bytes.end()}, faults_, time_);
        advance(time_);
    }

    [[nodiscard]] std::vector<std::uint8_t> give() {
        std::vector<std::uint8_t> bytes;
        while (!faults_.stalled && toStudio_.next() && *toStudio_.next() <= time_) {
            std::vector<std::uint8_t> message = toStudio_.take();
            if (kind_.isHid) return message;
            bytes.insert(bytes.end(), message.begin(), message.end());
        }
        return bytes;
    }

private:
    enum class Event { arrival, alarm, start };

    [[nodiscard]] std::optional<std::pair<Event, Microseconds>> nextEvent() const {
        std::optional<std::pair<Event, Microseconds>> first;
        const auto offer = [&first](Event event, std::optional<Microseconds> time) {
            if (time && (!first || *time < first->second)) first = {event, *time};
        };
        if (!faults_.stalled) offer(Event::arrival, toBoard_.next());
        if (program_)
            offer(Event::alarm, program_->alarm());
        else
            offer(Event::start, startsAt_);
        return first;
    }

    void moveTo(Microseconds time) {
        time_ = std::max(time_, time);
        hardware_.servos.advance(time_);
    }

    void happen(Event event) {
        if (event == Event::arrival) {
            const std::vector<std::uint8_t> bytes = toBoard_.take();
            if (program_) program_->receive(bytes, time_);
        } else if (event == Event::alarm) {
            program_->wake(time_);
        } else {
            program_ = kind_.makeProgram(hardware_);
            program_->greet();
        }
    }

    /// What follows from what has just happened: the supply may break down, answers go their way.
    void settle() {
        const bool overloaded = faults_.volts < kBrownOutVolts && hardware_.servos.moving() >= kBrownOutServos;
        if (program_ && overloaded) loseEverything();
        for (std::vector<std::uint8_t>& message : hardware_.said) {
            if (kind_.isHid) message.resize(kReport);
            if (!faults_.silent) toStudio_.send(std::move(message), faults_, time_);
        }
        hardware_.said.clear();
    }

    const BoardKind kind_;
    BoardFaults faults_;
    Microseconds time_;
    BoardHardware hardware_;
    std::unique_ptr<BoardProgram> program_; ///< none: it is starting
    Microseconds startsAt_{0};
    FaultyLine toBoard_;
    FaultyLine toStudio_;
};

/// One at a time has the machine, and it is up to date then.
class WiredBoard final : public SimulatedBoard {
public:
    WiredBoard(BoardKind kind, std::uint64_t seed, std::shared_ptr<const Clock> clock)
        : kind_(std::move(kind)), clock_(std::move(clock)), machine_(kind_, seed, clock_->now()) {}

    [[nodiscard]] std::string name() const override { return kind_.name; }
    [[nodiscard]] std::string product() const override { return faults().nameless ? kAdapter : kind_.product; }
    [[nodiscard]] bool isHid() const override { return kind_.isHid; }

    [[nodiscard]] bool present() const override {
        const std::scoped_lock lock(mutex_);
        machine_.advance(clock_->now());
        return machine_.running() || !kind_.isHid;
    }

    [[nodiscard]] BoardFaults faults() const override {
        const std::scoped_lock lock(mutex_);
        return machine_.faults();
    }

    [[nodiscard]] std::vector<SimulatedServo> servos() const override {
        const std::scoped_lock lock(mutex_);
        machine_.advance(clock_->now());
        return machine_.servos();
    }

    void setFaults(const BoardFaults& faults) override {
        const std::scoped_lock lock(mutex_);
        machine_.advance(clock_->now());
        machine_.setFaults(faults);
    }

    void reboot() override {
        const std::scoped_lock lock(mutex_);
        machine_.advance(clock_->now());
        machine_.loseEverything();
    }

    void plugged(Microseconds now) override {
        const std::scoped_lock lock(mutex_);
        machine_.advance(now);
        machine_.newLink();
    }

    void take(std::span<const std::uint8_t> bytes, Microseconds now) override {
        const std::scoped_lock lock(mutex_);
        machine_.advance(now);
        machine_.take(bytes);
    }

    [[nodiscard]] std::vector<std::uint8_t> give(Microseconds now) override {
        const std::scoped_lock lock(mutex_);
        machine_.advance(now);
        return machine_.give();
    }

private:
    const BoardKind kind_;
    const std::shared_ptr<const Clock> clock_;
    mutable std::mutex mutex_;
    mutable Machine machine_; ///< looking at it makes it go on
};

} // namespace

std::shared_ptr<SimulatedBoard> makeBoard(BoardKind kind, std::uint64_t seed, std::shared_ptr<const Clock> clock) {
    return std::make_shared<WiredBoard>(std::move(kind), seed, std::move(clock));
}

} // namespace lumorph
