#include "app/table/servo_port.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <utility>
#include <vector>

#include "core/rig/pulse_curve.h"
#include "core/scene/measured_servos.h"
#include "devices/controllers/controller_kinds.h"
#include "devices/controllers/device_profile.h"

namespace lumorph::table {

namespace {

constexpr std::chrono::milliseconds kPause{5};
constexpr std::size_t kFaulty = 1;
constexpr double kStop = 0.55; // of a stroke
constexpr double kThere = 2.0; // microseconds of pulse

/// The stroke that a horn's place means, by the wiring of the rig.
double toldStroke(const ServoSetup& setup, double pulse) {
    const double share = std::clamp((pulse - setup.pulseMin) / (setup.pulseMax - setup.pulseMin), 0.0, 1.0);
    return strokeWhereTurned(setup.curve, setup.reversed ? 1.0 - share : share);
}

/// It stands where a pulse wants it.
bool hasFollowed(const SimulatedServo& horn) {
    return horn.pulse > 0.0 && std::abs(horn.pulse - horn.position) < kThere;
}

} // namespace

ServoPort::ServoPort(Table& table) : table_(table), thread_([this](const std::stop_token& stop) { follow(stop); }) {}

void ServoPort::follow(const std::stop_token& stop) {
    const TableTruth& truth = table_.truth();
    const int first = firstChannel(ControllerKind::firmata);
    const std::vector<ServoSetup> setups = profileFor(*truth.rig, first).servos;
    const SteadyClock clock;
    std::vector<double> real(setups.size(), 0.0);
    std::vector<std::deque<std::pair<Microseconds, double>>> told(setups.size()); // on their way, by time
    // A new board has its horns in the middle. The device lies at rest, whatever that is, until its servo has once been
    // where a pulse told it to be.
    std::vector<bool> isDriven(setups.size(), false);
    while (!stop.stop_requested()) {
        const Microseconds now = clock.now();
        const std::vector<SimulatedServo> horns = board_.board()->servos();
        for (std::size_t i = 0; i < setups.size(); ++i) {
            const auto horn = static_cast<std::size_t>(std::max(0, setups[i].channel - first));
            if (horn >= horns.size()) continue;
            const MeasuredServo& servo = truth.room.servos[i];
            if (!isDriven[i]) isDriven[i] = hasFollowed(horns[horn]);
            if (!isDriven[i]) continue;
            double stroke = toldStroke(setups[i], horns[horn].position);
            if (i == kFaulty && fault_ == Fault::reversed) stroke = 1.0 - stroke;
            told[i].emplace_back(now, stroke);
            const Microseconds due = now - Microseconds(std::llround(1e6 * servo.lagSeconds));
            while (told[i].size() > 1 && told[i][1].first <= due) told[i].pop_front();
            real[i] = realStroke(servo, told[i].front().second, real[i]);
            if (i == kFaulty && fault_ == Fault::jammed) real[i] = std::min(real[i], kStop);
        }
        table_.setStrokes(real);
        std::this_thread::sleep_for(kPause);
    }
}

} // namespace lumorph::table
