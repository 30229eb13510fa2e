#include "devices/firmware/pin_header.h"

#include <cmath>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/firmware/twelve.h"

namespace lumorph {
namespace {

using testing::HasSubstr;
using testing::Not;

DeviceProfile profileOf(std::initializer_list<int> pins) {
    DeviceProfile profile;
    for (const int pin : pins) {
        ServoSetup servo;
        servo.channel = pin;
        profile.servos.push_back(servo);
    }
    return profile;
}

std::string refusalOf(const DeviceProfile& profile) {
    try {
        (void)channelsHeader(profile);
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "none";
}

TEST(PinHeader, TheSketchHasTheTabletsOfItsOwn) {
    std::ifstream file(LUMORPH_SOURCE_DIR "/devices/firmware/tablet/channels.h");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    EXPECT_EQ(channelsHeader(firmware_test::sixServos()), text);
}

TEST(PinHeader, TellsPinsLimitsAndBaud) {
    DeviceProfile profile = profileOf({2, 13, 15, 19});
    profile.address = "serial:///dev/rfcomm0?baud=9600";
    profile.servos[2].pulseMin = 500.2;
    profile.servos[2].pulseMax = 2499.9;
    const std::string text = channelsHeader(profile);
    for (const char* row : {"{2, 1000, 2000},  // servo 1\n", "{13, 1000, 2000}, // servo 2\n",
                            "{15, 501, 2499},  // servo 3\n", "{19, 1000, 2000}, // servo 4\n"})
        EXPECT_THAT(text, HasSubstr(row));
    EXPECT_THAT(text, HasSubstr("kBaud = 9600;"));
    profile.address = "bt://98:D3:31:F4:12:AB";
    EXPECT_THAT(channelsHeader(profile), HasSubstr("kBaud = 9600;"));
    profile.address.clear();
    EXPECT_THAT(channelsHeader(profile), HasSubstr("kBaud = 57600;"));
}

TEST(PinHeader, RefusesWhatTheBoardCannotDo) {
    EXPECT_THAT(refusalOf(profileOf({})), HasSubstr("no servo"));
    EXPECT_THAT(refusalOf(profileOf({2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 15})), HasSubstr("12 servos, not 13"));
    EXPECT_EQ(refusalOf(profileOf({2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13})), "none");
    EXPECT_THAT(refusalOf(profileOf({3, 5, 3})), HasSubstr("servo 3: pin 3 has another servo"));
    for (const int pin : {-1, 0, 1, 14, 20, 255, 258})
        EXPECT_THAT(refusalOf(profileOf({3, pin})), HasSubstr("servo 2"));
}

TEST(PinHeader, RefusesLimitsAndLinesThatCannotBe) {
    const auto withLimits = [](double least, double greatest) {
        DeviceProfile profile = profileOf({3});
        profile.servos[0].pulseMin = least;
        profile.servos[0].pulseMax = greatest;
        return refusalOf(profile);
    };
    EXPECT_EQ(withLimits(500.0, 2500.0), "none");
    EXPECT_THAT(withLimits(499.0, 2000.0), HasSubstr("servo 1"));
    EXPECT_THAT(withLimits(1000.0, 2501.0), HasSubstr("servo 1"));
    EXPECT_THAT(withLimits(1500.0, 1400.0), HasSubstr("servo 1"));
    EXPECT_THAT(withLimits(std::nan(""), 1400.0), HasSubstr("servo 1"));
    EXPECT_THAT(withLimits(1000.0, INFINITY), HasSubstr("servo 1"));
    DeviceProfile profile = profileOf({3});
    profile.address = "serial:///dev/ttyUSB0?baud=14400";
    EXPECT_THAT(refusalOf(profile), HasSubstr("14400"));
}

TEST(PinHeader, ANameCannotLeaveItsComment) {
    DeviceProfile profile = profileOf({3});
    profile.name = "x\nint evil;\\\r\n?\?/";
    const std::string text = channelsHeader(profile);
    EXPECT_EQ(text.find("#pragma once"), text.find('\n') + 1);
    EXPECT_THAT(text.substr(0, text.find('\n')), Not(HasSubstr("\\")));
}

} // namespace
} // namespace lumorph
