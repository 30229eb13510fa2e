#include "tests/firmware/twelve.h"

#include <string>
#include <vector>

namespace lumorph::firmware_test {

DeviceProfile twelveServos() {
    DeviceProfile profile;
    profile.name = "Twelve";
    const int pins[] = {2, 3, 4, 5, 6, 7, 8, 9, 13, 15, 17, 19};
    for (const int pin : pins) {
        ServoSetup servo;
        servo.channel = pin;
        servo.pulseMin = pin == 9 ? 1200.0 : 500.0;
        servo.pulseMax = pin == 9 ? 1800.0 : 2500.0;
        profile.servos.push_back(servo);
    }
    return profile;
}

DeviceProfile sixServos() {
    DeviceProfile profile;
    profile.name = "Tablet";
    profile.address = "serial:///dev/ttyUSB0?baud=57600";
    for (const int pin : {3, 5, 6, 9, 10, 11}) {
        ServoSetup servo;
        servo.channel = pin;
        profile.servos.push_back(servo);
    }
    return profile;
}

namespace {

std::vector<double> alike(std::size_t count, double first, double last) {
    std::vector<double> strokes;
    for (std::size_t k = 0; k < count; ++k)
        strokes.push_back(first + (last - first) * static_cast<double>(k) / static_cast<double>(count - 1));
    return strokes;
}

Variant withButton() {
    Variant made{twelveServos(), BoardSequence{}};
    for (std::size_t k = 0; k < made.profile.servos.size(); ++k) {
        ServoSetup& servo = made.profile.servos[k];
        servo.reversed = k == 3;
        servo.maxVelocity = 0.8 + 0.1 * static_cast<double>(k);
        servo.maxAcceleration = 3.0 + static_cast<double>(k);
        servo.exitStroke = k == 5 ? 0.4 : 0.0;
    }
    made.profile.staggerSeconds = 0.1;
    PoseSequence& sequence = made.poses->sequence;
    sequence.poses = {{"open", alike(12, 1.0, 0.2)}, {"unused", alike(12, 0.0, 1.0)}, {"shut \\", alike(12, 0.1, 0.7)}};
    sequence.steps = {{"open", 0.2, 0.3, Easing::minimumJerk},
                      {"shut \\", 3.0, 0.0, Easing::smooth},
                      {"open", 0.5, 0.1, Easing::linear},
                      {"open", 0.0, 0.0, Easing::smooth},
                      {"shut \\", 0.0, 0.25, Easing::minimumJerk}};
    made.poses->button = 10;
    return made;
}

Variant fromPower() {
    Variant made{sixServos(), BoardSequence{}};
    made.profile.staggerSeconds = 0.05;
    made.poses->sequence.poses = {{"up", alike(6, 0.9, 0.3)}, {"down", alike(6, 0.0, 0.5)}};
    made.poses->sequence.steps = {{"up", 1.0, 0.2}, {"down", 1.0, 0.1}};
    return made;
}

Variant full() {
    Variant made = withButton();
    PoseSequence& sequence = made.poses->sequence;
    sequence.steps.clear();
    for (int k = 0; k < 250; ++k) {
        const std::string name = "pose " + std::to_string(k);
        if (sequence.poses.size() < kMaxPoses) sequence.poses.push_back({name, alike(12, 0.004 * k, 0.5)});
    }
    // A step for each pose that has a row, and more of the same until the board is full.
    while (sequence.steps.size() < kMaxPoseSteps) {
        sequence.steps.push_back({sequence.poses[sequence.steps.size() % sequence.poses.size()].name, 1.0, 0.5});
    }
    return made;
}

} // namespace

Variant variantOf(const std::string& name) {
    if (name == "button") return withButton();
    if (name == "power") return fromPower();
    if (name == "full") return full();
    return {twelveServos(), std::nullopt};
}

} // namespace lumorph::firmware_test
