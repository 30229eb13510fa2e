#include "devices/controllers/device_profile.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/core/temporary_folder.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;

using ProfileFolder = TemporaryFolder;

DeviceProfile fullProfile() {
    DeviceProfile profile;
    profile.name = "Tablet of the lab";
    profile.address = "serial:///dev/rfcomm0?baud=9600";
    profile.controller = ControllerKind::maestro;
    profile.controllerNumber = 14;
    profile.maestroCrc = true;
    profile.identity = "00123456";
    profile.confirmed = true;
    profile.commandsPerSecond = 25.0;
    profile.staggerSeconds = 0.7;
    profile.slowShare = 0.1;
    profile.restOnExit = false;
    profile.handDistance = 0.25;
    profile.servos = {{3, 600.5, 2400.25, true, -12.5, 0.75, 4.0, 0.5, {0.0, 0.1, 1.0 / 3.0, 1.0}},
                      {7, 1000.0, 2000.0, false, 0.0, 1.0, 8.0, 0.0}};
    return profile;
}

std::string messageOf(const fs::path& file, const std::string& text) {
    std::ofstream(file) << text;
    try {
        (void)readProfile(file);
    } catch (const DataError& error) {
        return error.what();
    }
    return "";
}

TEST(DeviceProfile, ComesBackFromItsFileAsItWas) {
    const ProfileFolder folder;
    writeProfile(fullProfile(), folder / "tablet.json");
    EXPECT_EQ(readProfile(folder / "tablet.json"), fullProfile());
}

TEST(DeviceProfile, OneOfBeforeHasTheUsualValues) {
    const ProfileFolder folder;
    std::ofstream(folder / "old.json")
        << R"({"format": "lumorph device", "servos": [{"channel": 1, "pulseMin": 900, "pulseMax": 2100}]})";
    const DeviceProfile old = readProfile(folder / "old.json");
    EXPECT_EQ(old.handDistance, 0.1);
    EXPECT_EQ(old.servos.at(0).exitStroke, 0.0);
    EXPECT_TRUE(old.restOnExit);
}

TEST(DeviceProfile, TurnsStrokesIntoPulsesWithinTheLimits) {
    struct Row {
        ServoSetup servo;
        double stroke;
        double pulse;
    };
    const ServoSetup plain{.pulseMin = 1000.0, .pulseMax = 2000.0};
    const ServoSetup reversed{.pulseMin = 600.0, .pulseMax = 2400.0, .reversed = true};
    const ServoSetup trimmed{.pulseMin = 1000.0, .pulseMax = 2000.0, .trim = 100.0};
    for (const Row& row : {Row{plain, 0.0, 1000.0}, Row{plain, 0.25, 1250.0}, Row{plain, 1.0, 2000.0},
                           Row{plain, -3.0, 1000.0}, Row{reversed, 0.0, 2400.0}, Row{reversed, 1.0, 600.0},
                           Row{trimmed, 0.0, 1100.0}, Row{trimmed, 0.5, 1600.0}, Row{trimmed, 1.0, 2000.0}})
        EXPECT_DOUBLE_EQ(pulseOf(row.servo, row.stroke), row.pulse) << row.stroke;
    EXPECT_DOUBLE_EQ(strokeOf(plain, 1250.0), 0.25);
    EXPECT_DOUBLE_EQ(strokeOf(reversed, 2400.0), 0.0);
    EXPECT_DOUBLE_EQ(strokeOf(trimmed, 1600.0), 0.5);
}

TEST(DeviceProfile, ALeversCurveBendsTheWayBetweenTheLimits) {
    ServoSetup servo{.pulseMin = 1000.0, .pulseMax = 2000.0, .maxVelocity = 2.0, .curve = {0.0, 0.7, 1.0}};
    for (const auto& [stroke, pulse] : {std::pair{0.0, 1000.0}, {0.25, 1350.0}, {0.5, 1700.0}, {1.0, 2000.0}}) {
        servo.reversed = false;
        EXPECT_DOUBLE_EQ(pulseOf(servo, stroke), pulse);
        EXPECT_DOUBLE_EQ(strokeOf(servo, pulse), stroke);
        servo.reversed = true;
        EXPECT_DOUBLE_EQ(pulseOf(servo, stroke), 3000.0 - pulse);
        EXPECT_DOUBLE_EQ(strokeOf(servo, 3000.0 - pulse), stroke);
    }
    EXPECT_DOUBLE_EQ(fastestPulse(servo), 2.0 * 1.4 * 1000.0);
}

TEST(DeviceProfile, RefusesWhatWouldBreakAServo) {
    struct Row {
        void (*spoil)(DeviceProfile&);
        const char* says;
    };
    const Row rows[] = {
        {[](DeviceProfile& p) { p.servos[1].pulseMin = 499.0; }, "servo 2: the least pulse is 499.0"},
        {[](DeviceProfile& p) { p.servos[0].pulseMax = 2501.0; }, "servo 1: the greatest pulse is 2501.0"},
        {[](DeviceProfile& p) {
             p.servos[1].curve = {0.0, 0.6, 0.5, 1.0};
         },
         "servo 2: its curve does not rise"},
        {[](DeviceProfile& p) { p.servos[0].pulseMax = NAN; }, "servo 1: the greatest pulse is nan"},
        {[](DeviceProfile& p) { p.servos[0].pulseMin = 2400.25; }, "servo 1: its pulses run from"},
        {[](DeviceProfile& p) { p.servos[0].trim = 1e4; }, "servo 1: the trim is 10000.0"},
        {[](DeviceProfile& p) { p.servos[0].trim = NAN; }, "servo 1: the trim"},
        {[](DeviceProfile& p) { p.servos[0].maxVelocity = 0.0; }, "servo 1: the velocity"},
        {[](DeviceProfile& p) { p.servos[0].maxVelocity = INFINITY; }, "servo 1: the velocity"},
        {[](DeviceProfile& p) { p.servos[0].maxAcceleration = -1.0; }, "servo 1: the acceleration"},
        {[](DeviceProfile& p) { p.servos[1].channel = 3; }, "servo 2: channel 3 is already that of servo 1"},
        {[](DeviceProfile& p) { p.servos[1].channel = 24; }, "servo 2: the channel is 24"},
        {[](DeviceProfile& p) { p.servos[1].channel = -1; }, "servo 2: the channel is -1"},
        {[](DeviceProfile& p) { p.servos[0].exitStroke = 1.1; }, "servo 1: the place at the end is 1.1"},
        {[](DeviceProfile& p) { p.servos[1].exitStroke = NAN; }, "servo 2: the place at the end is nan"},
        {[](DeviceProfile& p) { p.handDistance = -0.1; }, "the distance of hands is -0.1"},
        {[](DeviceProfile& p) { p.controllerNumber = 128; }, "'Device number' is 128"},
        {[](DeviceProfile& p) { p.slowShare = 0.0; }, "slow mode"},
        {[](DeviceProfile& p) { p.staggerSeconds = NAN; }, "pause between servo starts"},
        {[](DeviceProfile& p) { p.commandsPerSecond = 1e9; }, "rate of commands"},
        {[](DeviceProfile& p) { p.servos.resize(65); }, "65 servos"},
    };
    for (const Row& row : rows) {
        DeviceProfile profile = fullProfile();
        row.spoil(profile);
        try {
            checkProfile(profile);
            ADD_FAILURE() << "accepted: " << row.says;
        } catch (const InvalidInput& error) {
            EXPECT_NE(std::string(error.what()).find(row.says), std::string::npos) << error.what();
        }
    }
    EXPECT_NO_THROW(checkProfile(fullProfile()));
}

TEST(DeviceProfile, SaysWhereAFileIsWrong) {
    const ProfileFolder folder;
    const fs::path file = folder / "broken.json";
    const std::string head = R"({"format": "lumorph device", "schema": 1, )";
    const std::string servo = R"("channel": 1, "pulseMin": 1000, "pulseMax": 2000)";
    struct Row {
        std::string text;
        const char* says;
    };
    const Row rows[] = {
        {"", "is not valid JSON"},
        {"[]", "is not a device profile"},
        {R"({"format": "lumorph"})", "is not a device profile"},
        {R"({"format": "lumorph device", "schema": 2, "servos": []})", "newer version"},
        {head + R"("name": 3})", "name: is not a text"},
        {head + R"("controller": "arduino", "servos": []})",
         "'arduino' is no controller that is known here; write firmata, lewansoul or maestro"},
        {head + R"("name": "a"})", "servos: is missing"},
        {head + R"("servos": [{"pulseMin": 1000, "pulseMax": 2000}]})", "servos[0].channel: is missing"},
        {head + R"("servos": [{"channel": 1.5, "pulseMin": 1000, "pulseMax": 2000}]})", "servos[0].channel"},
        {head + R"("servos": [{)" + servo + R"(, "maxVelocty": 1}]})", "servos[0].maxVelocty: is not known"},
        {head + R"("servos": [{)" + servo + R"(, "maxVelocity": 1e400}]})", "JSON"},
        {head + R"("servos": [{)" + servo + R"(, "trim": null}]})", "servos[0].trim"},
        {head + R"("servos": [{)" + servo + "}, {" + servo + "}]}", "servo 2: channel 1 is already"},
        {head + R"("servos": [7]})", "servos[0]: is not an object"},
        {head + R"("speed": 1, "servos": []})", "speed: is not known"},
        {head + R"("servos": )" + std::string(50, '[') + std::string(50, ']') + "}", "deeper"},
    };
    for (const Row& row : rows) {
        const std::string said = messageOf(file, row.text);
        EXPECT_NE(said.find(row.says), std::string::npos) << row.text << "\n gave: " << said;
        EXPECT_EQ(said.find(file.string()), 0U) << said;
    }
    EXPECT_THROW((void)readProfile(folder / "none.json"), DataError);
    EXPECT_THROW((void)readProfile("/dev/zero"), DataError);
}

TEST(DeviceProfile, FollowsTheRigsDrives) {
    RigParts parts;
    parts.name = "three";
    parts.restMesh.positions = {{0.0F, 0.0F, 0.0F}, {0.1F, 0.0F, 0.0F}, {0.0F, 0.1F, 0.0F}, {0.0F, 0.0F, 0.1F}};
    parts.restMesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    for (int i = 0; i < 3; ++i) {
        Actuator actuator;
        actuator.name = "hinge " + std::to_string(i);
        Hinge hinge;
        hinge.max = Angle::degrees(45.0);
        hinge.axis = {0.0F, 0.0F, 1.0F};
        actuator.deformer = hinge;
        actuator.influences = {{1, 1.0F}};
        actuator.maxVelocity = 2.0;
        parts.actuators.push_back(actuator);
    }
    parts.actuators[1].drive = {.channel = 5, .pulseMin = 2200.0, .pulseMax = 900.0};
    parts.actuators[2].drive = {.channel = -1, .pulseMin = 1e9, .pulseMax = -1e9};
    const DeviceProfile profile = profileFor(Rig(parts), 4);
    ASSERT_EQ(profile.servos.size(), 3U);
    EXPECT_EQ(profile.servos[0].channel, 4);
    EXPECT_EQ(profile.servos[1].channel, 5);
    EXPECT_EQ(profile.servos[2].channel, 6);
    EXPECT_DOUBLE_EQ(pulseOf(profile.servos[1], 0.0), 2200.0);
    EXPECT_DOUBLE_EQ(pulseOf(profile.servos[1], 1.0), 900.0);
    EXPECT_DOUBLE_EQ(profile.servos[0].maxVelocity, 2.0);
    EXPECT_NO_THROW(checkProfile(profile));
}

} // namespace
} // namespace lumorph
