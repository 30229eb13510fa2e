#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "devices/simulator/simulated_bench.h"
#include "tests/support/traced_engine.h"

namespace lumorph {

/// A ServoEngine at a simulated board, without threads, in a time that a test turns itself, and all that is traced.
class EngineBench {
public:
    using Bytes = std::vector<std::uint8_t>;

    explicit EngineBench(const DeviceProfile& profile)
        : traced_(profile, clock_->now()), engine(traced_.engine), rows(traced_.rows),
          board(bench_.board(profile.address.substr(6))) {}
    EngineBench(const EngineBench&) = delete;
    EngineBench& operator=(const EngineBench&) = delete;

    void tell(const ServoInput& input) {
        const std::vector<ServoOutput> outputs = traced_.take(input, now());
        for (const ServoOutput& output : outputs) std::visit([this](const auto& one) { perform(one); }, output);
    }
    /// Time passes for all; the engine sees it at the end.
    void pass(long microseconds) {
        clock_->advance(Microseconds{microseconds});
        const BoardFaults faults = board->faults();
        if (open_ && faults.unplugged) {
            open_ = false;
            tell(servo_input::Lost{{"the cable is out", "plug it in"}});
        } else if (wanted_ && !open_ && !faults.unplugged) {
            open_ = true;
            board->plugged(clock_->now());
            tell(servo_input::Opened{board->product(), "the very board"});
        }
        for (Bytes answer = listen(); !answer.empty(); answer = listen()) tell(servo_input::Received{answer});
        if (!engine.idle()) tell(servo_input::Tick{unsent});
    }
    /// In ticks of 5 ms.
    void run(double seconds) {
        for (double t = 0.0; t < seconds; t += 0.005) pass(5'000);
    }
    template <typename Condition> bool runUntil(Condition condition, double atMost = 20.0) {
        for (double t = 0.0; t < atMost && !condition(); t += 0.005) pass(5'000);
        return condition();
    }
    bool reaches(LinkPhase phase) {
        return runUntil([&] { return engine.status().phase == phase; });
    }
    /// Until it is ready to be armed, whatever must be confirmed.
    bool connect() {
        tell(servo_input::Connect{});
        return becomesReady();
    }
    bool becomesReady() {
        return runUntil([&] {
            const LinkPhase phase = engine.status().phase;
            if (phase == LinkPhase::unidentified) tell(servo_input::Confirm{});
            return phase == LinkPhase::disarmed || phase == LinkPhase::stopped;
        });
    }
    template <typename Change> void fault(Change change) {
        BoardFaults faults = board->faults();
        change(faults);
        board->setFaults(faults);
    }
    [[nodiscard]] bool saidAnything(const std::string& words) const { return said.find(words) != std::string::npos; }
    /// By the engine's clock, which may be set.
    [[nodiscard]] Microseconds now() const { return clock_->now() + clockIsAhead; }
    [[nodiscard]] bool isOpen() const { return open_; }

    std::string said; ///< to the user
    Microseconds clockIsAhead{0};
    std::uint64_t unsent = 0;
    std::function<void(const Bytes&)> onWrite; ///< a message, before the board has it

private:
    void perform(const servo_output::Write& write) {
        if (!open_) return;
        if (onWrite) onWrite(write.bytes);
        board->take(write.bytes, clock_->now());
    }
    void perform(const servo_output::Reach&) {}
    void perform(const servo_output::Open&) { wanted_ = true; }
    void perform(const servo_output::Close&) { wanted_ = open_ = false; }
    void perform(const servo_output::Drop& drop) {
        open_ = false;
        tell(servo_input::Lost{drop.why});
    }
    void perform(const servo_output::Tell& tell) { said += tell.event.text + " (" + tell.event.remedy + ")\n"; }
    Bytes listen() { return open_ ? board->give(clock_->now()) : Bytes{}; }

    static std::shared_ptr<ManualClock> clockThatHasRun() {
        auto clock = std::make_shared<ManualClock>();
        clock->advance(Microseconds{1'000'000});
        return clock;
    }

    std::shared_ptr<ManualClock> clock_ = clockThatHasRun();
    SimulatedBench bench_{clock_};
    test::TracedEngine traced_;
    bool wanted_ = false;
    bool open_ = false;

public:
    ServoEngine& engine;
    std::vector<ServoTraceRow>& rows;
    std::shared_ptr<SimulatedBoard> board;
};

} // namespace lumorph
