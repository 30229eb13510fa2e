#include "devices/simulator/board_at_port.h"

#include <algorithm>
#include <iterator>
#include <span>

#include "core/base/error.h"

namespace lumorph {

namespace {

using namespace std::chrono_literals;

/// Of "55 55 length ...", to its end.
std::size_t frameBytes(const std::vector<std::uint8_t>& bytes) { return bytes.size() < 3 ? 3 : bytes[2] + 2U; }

} // namespace

BoardAtPort::BoardAtPort(const std::string& name)
    : board_(bench_.board(name)), pump_([this](const std::stop_token& end) {
          board_->plugged(bench_.now());
          while (!end.stop_requested()) {
              port_.waitForBytes(5ms);
              pass();
          }
      }) {}

std::size_t BoardAtPort::driven() const {
    const std::vector<SimulatedServo> servos = board_->servos();
    return static_cast<std::size_t>(
        std::ranges::count_if(servos, [](const SimulatedServo& servo) { return servo.pulse > 0.0; }));
}

void BoardAtPort::pass() {
    const std::vector<std::uint8_t> bytes = port_.receive();
    if (board_->isHid()) {
        waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
        takeFrames();
    } else if (!bytes.empty()) {
        board_->take(bytes, bench_.now());
    }
    for (std::vector<std::uint8_t> said = board_->give(bench_.now()); !said.empty();
         said = board_->give(bench_.now())) {
        if (board_->isHid()) said.resize(std::min(frameBytes(said), said.size()));
        try {
            port_.send(said);
        } catch (const DeviceError&) {
            break; // nobody reads it
        }
    }
    if (driven() > 0) lastDriven_ = Clock::now();
}

void BoardAtPort::takeFrames() {
    for (;;) {
        constexpr std::uint8_t kHead[] = {0x55, 0x55};
        const auto begin = std::search(waiting_.begin(), waiting_.end(), std::begin(kHead), std::end(kHead));
        waiting_.erase(waiting_.begin(), begin);
        if (waiting_.size() < frameBytes(waiting_)) return;
        const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(frameBytes(waiting_));
        board_->take(std::vector<std::uint8_t>(waiting_.begin(), end), bench_.now());
        waiting_.erase(waiting_.begin(), end);
    }
}

} // namespace lumorph
