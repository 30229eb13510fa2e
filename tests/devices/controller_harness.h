#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "devices/controllers/controller_base.h"
#include "tests/devices/guard_key.h"

namespace lumorph {

namespace test {

using Bytes = std::vector<std::uint8_t>;
using Messages = std::vector<Bytes>;

inline DeviceProfile profileOn(ControllerKind kind, const std::vector<int>& channels) {
    DeviceProfile profile;
    profile.controller = kind;
    for (const int channel : channels) {
        ServoSetup servo;
        servo.channel = channel;
        profile.servos.push_back(servo);
    }
    return profile;
}

/// A controller, the time it is told, and what it writes.
class ControllerTrial {
public:
    ControllerTrial(const DeviceProfile& profile, const std::string& uri)
        : controller_(makeController(profile, parseDeviceAddress(uri))) {}

    void open(const std::string& product = {}) { controller_->opened(product, now_); }
    void receive(const Bytes& bytes) { controller_->received(bytes, now_); }
    /// Pulses that no guard has made: tests of controllers alone have none.
    void send(const std::vector<GuardedPulse>& pulses) { controller_->send({testGuardKey(), pulses}, now_); }
    /// Ticks every 5 ms; what is written meanwhile is kept.
    void wait(int milliseconds) {
        for (int passed = 0; passed < milliseconds; passed += 5) {
            now_ += Microseconds(5000);
            controller_->tick(now_);
            collect();
        }
    }
    /// Messages since the last call.
    Messages written() {
        collect();
        return std::exchange(messages_, {});
    }
    /// The same without questions: those that begin as one of `questions` does.
    Messages writtenBut(const Messages& questions) {
        Messages rest;
        for (const Bytes& message : written()) {
            bool isQuestion = false;
            for (const Bytes& question : questions)
                isQuestion = isQuestion || (message.size() >= question.size() &&
                                            std::equal(question.begin(), question.end(), message.begin()));
            if (!isQuestion) rest.push_back(message);
        }
        return rest;
    }
    [[nodiscard]] const ControllerState& state() const { return controller_->state(); }
    [[nodiscard]] ServoController& controller() { return *controller_; }
    [[nodiscard]] Microseconds now() const { return now_; }
    void jump(Microseconds to) { now_ = to; }

private:
    void collect() {
        for (Bytes& message : controller_->takeOutput()) messages_.push_back(std::move(message));
    }
    std::unique_ptr<ServoController> controller_;
    Microseconds now_{1'000'000};
    Messages messages_;
};

} // namespace test
} // namespace lumorph
