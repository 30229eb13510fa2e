#include "devices/transport/found_devices.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "devices/controllers/controller_kinds.h"
#include "devices/simulator/pty.h"
#include "devices/transport/port_access.h"

namespace lumorph {
namespace {

using testing::HasSubstr;

TEST(FoundDevices, ASerialPortIsNamedByWhatItProbablyIs) {
    struct Row {
        std::uint16_t vendor;
        const char* description;
        const char* name;
        const char* hint;
        ControllerKind kind;
    };
    const Row rows[] = {
        {0x2341, "Arduino Uno", "Arduino Uno on none0", "Arduino", ControllerKind::firmata},
        {0x2341, "", "Arduino on none0", "StandardFirmata", ControllerKind::firmata},
        {0x1a86, "USB Serial", "USB Serial on none0", "Nano", ControllerKind::firmata},
        {0x1a86, "", "CH340 serial adapter on none0", "Nano", ControllerKind::firmata},
        {0x0403, "", "FTDI serial adapter on none0", "Pro Mini", ControllerKind::firmata},
        {0x10c4, "", "CP210x serial adapter on none0", "ESP", ControllerKind::firmata},
        {0x1ffb, "", "Pololu on none0", "Maestro", ControllerKind::maestro},
        {0x9999, "", "serial port on none0", "", ControllerKind::firmata},
    };
    for (const Row& row : rows) {
        const FoundDevice found = describeSerialPort({"/dev/none0", "S1", row.vendor, 1, row.description});
        EXPECT_EQ(found.name, row.name);
        EXPECT_THAT(found.hint, HasSubstr(row.hint));
        EXPECT_EQ(likelyController(found.address + ' ' + found.name + found.hint), row.kind);
        EXPECT_EQ(found.identity, "S1");
        EXPECT_EQ(std::get<SerialAddress>(parseDeviceAddress(found.address)).path, "/dev/none0");
        EXPECT_EQ(found.trouble, notThere("/dev/none0"));
    }
}

TEST(FoundDevices, AnOddPathSurvivesItsAddress) {
    for (const char* path :
         {"/dev/a b", "/dev/a%20b", "/dev/a?baud=1", "/dev/a#b", "/dev/serial/by-id/usb-1a86-if00"}) {
        const FoundDevice found = describeSerialPort({path, "", 0, 0, ""});
        EXPECT_EQ(parseDeviceAddress(found.address), DeviceAddress(SerialAddress{path, 57600})) << found.address;
    }
    const FoundDevice hid = describeHidDevice({"/dev/hidraw9", 0x0483, 0x5750, "S", "LOBOT & arm=50% #1+"});
    EXPECT_EQ(parseDeviceAddress(hid.address), DeviceAddress(HidAddress{0x0483, 0x5750, "LOBOT & arm=50% #1+"}));
}

TEST(FoundDevices, ABoundPortIsSlow) {
    const FoundDevice found = describeBoundPort("/dev/rfcomm3");
    EXPECT_EQ(parseDeviceAddress(found.address), DeviceAddress(SerialAddress{"/dev/rfcomm3", 9600}));
    EXPECT_EQ(found.name, "Bluetooth serial port rfcomm3");
}

TEST(FoundDevices, APortThatCanBeOpenedHasNoTroubleOneInUseHas) {
    const Pty pty;
    EXPECT_EQ(describeSerialPort({pty.path(), "", 0, 0, ""}).trouble, LinkTrouble{});
    const int file = ::open(pty.path().c_str(), O_RDWR | O_NOCTTY); // else its end could end us, too
    ASSERT_GE(file, 0);
    EXPECT_EQ(describeSerialPort({pty.path(), "", 0, 0, ""}).trouble.why,
              "this program uses " + pty.path() + " already");
    ::close(file);
}

TEST(FoundDevices, AHidDeviceIsNotTrustedForItsIds) {
    const FoundDevice arm = describeHidDevice({"/dev/hidraw9", 0x0483, 0x5750, "S1", "LOBOT xArm"});
    EXPECT_EQ(arm.name, "LOBOT xArm on hidraw9");
    EXPECT_THAT(arm.hint, HasSubstr("servo controller"));
    EXPECT_EQ(likelyController(arm.name + arm.hint), ControllerKind::lewansoul);
    const FoundDevice other = describeHidDevice({"/dev/hidraw9", 0x0483, 0x5750, "", "Joystick"});
    EXPECT_THAT(other.hint, HasSubstr("something else"));
    EXPECT_EQ(describeHidDevice({"/dev/hidraw9", 0x0483, 0x5750, "", ""}).address, "hid://0483:5750");
}

TEST(FoundDevices, WhatThisComputerHasCanBeAddressed) {
    for (const FoundDevice& found : findRealDevices()) {
        EXPECT_NO_THROW((void)parseDeviceAddress(found.address)) << found.address;
        EXPECT_FALSE(found.name.empty());
    }
}

} // namespace
} // namespace lumorph
