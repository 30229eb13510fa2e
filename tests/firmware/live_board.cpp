#include "tests/firmware/live_board.h"

#include <algorithm>
#include <chrono>
#include <filesystem>

namespace lumorph::firmware_test {

LiveBoard::LiveBoard() : path_(folder_ / "board") {
    plug();
    thread_ = std::thread([this] { live(); });
}

LiveBoard::~LiveBoard() {
    ends_ = true;
    thread_.join();
    std::filesystem::remove(path_);
}

void LiveBoard::plug() {
    pty_ = std::make_unique<Pty>();
    std::filesystem::remove(path_);
    std::filesystem::create_symlink(pty_->path(), path_);
}

void LiveBoard::live() {
    using Clock = std::chrono::steady_clock;
    Board board("six", 16);
    board.setPinMillivolts(700);
    Bytes said;
    board.onSaid([&](std::uint8_t byte) { said.push_back(byte); });
    auto last = Clock::now();
    while (!ends_) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        const auto now = Clock::now();
        board.run(std::min(20.0, std::chrono::duration<double, std::milli>(now - last).count()));
        last = now;
        if (pty_ && !plugged_) pty_.reset();
        if (!pty_ && plugged_) plug();
        if (pty_) {
            if (!said.empty()) pty_->send(said);
            board.send(pty_->receive());
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
