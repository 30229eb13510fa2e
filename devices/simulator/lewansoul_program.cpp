#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "devices/simulator/board_program.h"

namespace lumorph {

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kServos = 6;
constexpr std::size_t kReportLength = 64;
constexpr int kGreatestUnit = 1000;
constexpr Microseconds kGoalTick{10'000}; // a servo renews its goal so often on its way
constexpr int kFailingUnload = 5;         // one out of so many does nothing

double pulseOfUnits(int units) { return 500.0 + 2.0 * std::min(units, kGreatestUnit); }

int unitsOfPulse(double pulse) {
    return std::clamp(static_cast<int>(std::lround((pulse - 500.0) / 2.0)), 0, kGreatestUnit);
}

/// A move that takes its time.
struct Ramp {
    double from = 0.0;
    double to = 0.0;
    Microseconds begins{0};
    Microseconds ends{0}; ///< as begins: no move

    [[nodiscard]] double at(Microseconds time) const {
        if (time >= ends) return to;
        return from + (to - from) * static_cast<double>((time - begins).count()) /
                          static_cast<double>((ends - begins).count());
    }
};

class Lewansoul final : public BoardProgram {
public:
    explicit Lewansoul(BoardHardware& hardware) : hardware_(hardware) {}

    void receive(std::span<const std::uint8_t> report, Microseconds now) override {
        wake(now);
        if (report.size() == kReportLength + 1 && report[0] == 0)
            report = report.subspan(1); // the absent report number
        if (report.size() < 4 || report[0] != 0x55 || report[1] != 0x55 || report[2] < 2) return;
        const std::size_t parameters = report[2] - 2U;
        if (report.size() < 4 + parameters) return;
        execute(report[3], report.subspan(4, parameters));
    }

    [[nodiscard]] std::optional<Microseconds> alarm() const override {
        std::optional<Microseconds> first;
        for (const Ramp& ramp : ramps_) {
            if (ramp.ends <= now_) continue;
            const Microseconds next = std::min(ramp.ends, now_ + kGoalTick);
            first = first ? std::min(*first, next) : next;
        }
        return first;
    }

    void wake(Microseconds now) override {
        for (std::size_t i = 0; i < kServos; ++i)
            if (ramps_[i].ends > now_) hardware_.servos.setPulse(i, ramps_[i].at(now));
        now_ = now;
    }

private:
    void execute(std::uint8_t command, std::span<const std::uint8_t> data) {
        if (command == 0x0F && data.empty()) sayVoltage();
        if (data.empty()) return;
        const std::size_t count = data[0];
        if (command == 0x03 && data.size() == 3 + 3 * count) move(data);
        if (command == 0x14 && data.size() == 1 + count) unload(data.subspan(1));
        if (command == 0x15 && data.size() == 1 + count) sayPositions(data.subspan(1));
    }

    void move(std::span<const std::uint8_t> data) {
        const auto takes = std::chrono::milliseconds(data[1] | data[2] << 8);
        for (std::size_t i = 3; i < data.size(); i += 3)
            if (hasServo(data[i])) moveOne(data[i] - 1U, pulseOfUnits(data[i + 1] | data[i + 2] << 8), takes);
    }

    void moveOne(std::size_t servo, double pulse, Microseconds takes) {
        const SimulatedServo& truth = hardware_.servos.servos()[servo];
        Ramp& ramp = ramps_[servo];
        const double from = truth.pulse > 0.0 ? ramp.at(now_) : truth.position; // it knows where it is
        ramp = {from, pulse, now_, now_ + takes};
        hardware_.servos.setPulse(servo, ramp.at(now_));
    }

    void unload(std::span<const std::uint8_t> ids) {
        unloads_ = (unloads_ + 1) % kFailingUnload;
        if (unloads_ == 0) return;
        for (const std::uint8_t id : ids) {
            if (!hasServo(id)) continue;
            ramps_[id - 1U].ends = now_;
            hardware_.servos.setPulse(id - 1U, 0.0);
        }
    }

    static bool hasServo(std::uint8_t id) { return id >= 1 && id <= kServos; }

    void sayVoltage() {
        const auto millivolts = static_cast<unsigned>(std::lround(1000.0 * hardware_.volts));
        hardware_.said.push_back({0x55, 0x55, 0x04, 0x0F, static_cast<std::uint8_t>(millivolts & 0xFF),
                                  static_cast<std::uint8_t>(millivolts >> 8)});
    }

    void sayPositions(std::span<const std::uint8_t> ids) {
        Bytes triples;
        for (const std::uint8_t id : ids) {
            if (!hasServo(id)) continue;
            const int units = unitsOfPulse(hardware_.servos.servos()[id - 1U].position);
            triples.insert(triples.end(),
                           {id, static_cast<std::uint8_t>(units & 0xFF), static_cast<std::uint8_t>(units >> 8)});
        }
        Bytes message{0x55, 0x55, static_cast<std::uint8_t>(triples.size() + 3), 0x15,
                      static_cast<std::uint8_t>(triples.size() / 3)};
        message.insert(message.end(), triples.begin(), triples.end());
        if (message.size() <= kReportLength) hardware_.said.push_back(std::move(message));
    }

    BoardHardware& hardware_;
    Microseconds now_{0};
    std::array<Ramp, kServos> ramps_;
    int unloads_ = 0;
};

} // namespace

std::unique_ptr<BoardProgram> makeLewansoulProgram(BoardHardware& hardware) {
    return std::make_unique<Lewansoul>(hardware);
}

} // namespace lumorph
