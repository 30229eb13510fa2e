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
constexpr std::size_t kBrownOutServos = 3; // that many at once draw more than a weak battery gives
constexpr std::size_t kReport = 64;        // bytes
constexpr double kLongestJitter = 60000.0; // milliseconds

/// What cannot be is taken for the nearest that can; no number for none.
double within(double value, double high) { return value > 0.0 ? std::min(value, high) : 0.0; }

class WiredBoard final : public SimulatedBoard {
public:
    WiredBoard(BoardKind kind, std::uint64_t seed, std::shared_ptr<const Clock> clock)
        : kind_(std::move(kind)), clock_(std::move(clock)),
          time_(clock_->now()), hardware_{ServoBank(kind_.servos, kind_.hornSpeed), BoardFaults{}.volts, {}},
          program_(kind_.makeProgram(hardware_)), toBoard_(2 * seed, kind_.isHid),
          toStudio_(2 * seed + 1, kind_.isHid) {
        hardware_.servos.advance(time_);
    }

    [[nodiscard]] std::string name() const override { return kind_.name; }
    [[nodiscard]] std::string product() const override { return kind_.product; }
    [[nodiscard]] bool isHid() const override { return kind_.isHid; }

    [[nodiscard]] BoardFaults faults() const override {
        const std::scoped_lock lock(mutex_);
        return faults_;
    }

    void setFaults(const BoardFaults& faults) override {
        const std::scoped_lock lock(mutex_);
        advance(clock_->now());
        faults_ = faults;
        faults_.noise = within(faults.noise, 1.0);
        faults_.drop = within(faults.drop, 1.0);
        faults_.jitterMilliseconds = within(faults.jitterMilliseconds, kLongestJitter);
        faults_.volts = within(faults.volts, 16.0);
        hardware_.volts = faults_.volts;
        settle();
    }

    void reboot() override {
        const std::scoped_lock lock(mutex_);
        advance(clock_->now());
        loseEverything();
    }

    [[nodiscard]] std::vector<SimulatedServo> servos() const override {
        const std::scoped_lock lock(mutex_);
        advance(clock_->now());
        return hardware_.servos.servos();
    }

    void plugged(Microseconds now) override {
        const std::scoped_lock lock(mutex_);
        advance(now);
        toBoard_.clear();
        toStudio_.clear();
    }

    void take(std::span<const std::uint8_t> bytes, Microseconds now) override {
        const std::scoped_lock lock(mutex_);
        advance(now);
        toBoard_.send({bytes.begin(), bytes.end()}, faults_, time_);
        advance(now);
    }

    [[nodiscard]] std::vector<std::uint8_t> give(Microseconds now) override {
        const std::scoped_lock lock(mutex_);
        advance(now);
        std::vector<std::uint8_t> bytes;
        while (!faults_.stalled && toStudio_.next() && *toStudio_.next() <= time_) {
            const std::vector<std::uint8_t> message = toStudio_.take();
            if (kind_.isHid) return message;
            bytes.insert(bytes.end(), message.begin(), message.end());
        }
        return bytes;
    }

private:
    enum class Event { arrival, alarm, start };

    // The past is worked off when somebody looks, in the order in which it would have happened: hence the mutables.
    void advance(Microseconds now) const {
        while (const auto next = nextEvent()) {
            if (next->second > now) break;
            moveTo(next->second);
            happen(next->first);
            settle();
        }
        moveTo(now);
    }

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

    void moveTo(Microseconds time) const {
        time_ = std::max(time_, time);
        hardware_.servos.advance(time_);
    }

    void happen(Event event) const {
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
    void settle() const {
        const bool overloaded = faults_.volts < kBrownOutVolts && hardware_.servos.moving() >= kBrownOutServos;
        if (program_ && overloaded) loseEverything();
        for (std::vector<std::uint8_t>& message : hardware_.said) {
            if (kind_.isHid) message.resize(kReport);
            if (!faults_.silent) toStudio_.send(std::move(message), faults_, time_);
        }
        hardware_.said.clear();
    }

    void loseEverything() const {
        program_.reset();
        hardware_.servos.allLimp();
        hardware_.said.clear();
        startsAt_ = time_ + kind_.startsIn;
    }

    const BoardKind kind_;
    const std::shared_ptr<const Clock> clock_;
    mutable std::mutex mutex_;
    BoardFaults faults_;
    mutable Microseconds time_;
    mutable BoardHardware hardware_;
    mutable std::unique_ptr<BoardProgram> program_; ///< none: it is starting
    mutable Microseconds startsAt_{0};
    mutable FaultyLine toBoard_;
    mutable FaultyLine toStudio_;
};

} // namespace

std::shared_ptr<SimulatedBoard> makeBoard(BoardKind kind, std::uint64_t seed, std::shared_ptr<const Clock> clock) {
    return std::make_shared<WiredBoard>(std::move(kind), seed, std::move(clock));
}

} // namespace lumorph
