#include "tests/firmware/twelve.h"

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

} // namespace lumorph::firmware_test
