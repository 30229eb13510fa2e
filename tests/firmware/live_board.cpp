#include "tests/firmware/live_board.h"

#include <algorithm>
#include <chrono>

namespace lumorph::firmware_test {

LiveBoard::LiveBoard() : thread_([this] { live(); }) {}

LiveBoard::~LiveBoard() {
    ends_ = true;
    thread_.join();
}

void LiveBoard::live() {
    using Clock = std::chrono::steady_clock;
    Board board("six", 16);
    board.setPinMillivolts(700);
    Bytes said;
    board.onSaid([&](std::uint8_t byte) { said.push_back(byte); });
    auto last = Clock::now();
    bool plugged = true;
    while (!ends_) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        const auto now = Clock::now();
        board.run(std::min(20.0, std::chrono::duration<double, std::milli>(now - last).count()));
        last = now;
        if (plugged && cut_) {
            pty_.unplug();
            plugged = false;
        }
        if (plugged) {
            if (!said.empty()) pty_.send(said);
            board.send(pty_.receive());
        }
        said.clear();
        const std::vector<Pulse> fresh = board.takePulses();
        const std::scoped_lock lock(mutex_);
        pulses_.insert(pulses_.end(), fresh.begin(), fresh.end());
        now_ = board.now();
    }
}

std::vector<Pulse> LiveBoard::pulses() const {
    const std::scoped_lock lock(mutex_);
    return pulses_;
}

double LiveBoard::widthNow(int pin) const {
    const std::scoped_lock lock(mutex_);
    const auto newest =
        std::find_if(pulses_.rbegin(), pulses_.rend(), [pin](const Pulse& pulse) { return pulse.pin == pin; });
    return newest == pulses_.rend() || newest->start < now_ - 45.0 ? 0.0 : newest->width;
}

double LiveBoard::now() const {
    const std::scoped_lock lock(mutex_);
    return now_;
}

} // namespace lumorph::firmware_test
