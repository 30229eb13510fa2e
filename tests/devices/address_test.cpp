#include "devices/transport/address.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace lumorph {
namespace {

TEST(DeviceAddress, ReadsEveryKind) {
    EXPECT_EQ(parseDeviceAddress("serial:///dev/rfcomm0?baud=9600"),
              DeviceAddress(SerialAddress{"/dev/rfcomm0", 9600}));
    EXPECT_EQ(parseDeviceAddress("serial:///dev/ttyUSB0"), DeviceAddress(SerialAddress{"/dev/ttyUSB0", 57600}));
    EXPECT_EQ(parseDeviceAddress("bt://98:d3:31:F4:12:AB"), DeviceAddress(BluetoothAddress{"98:D3:31:F4:12:AB"}));
    EXPECT_EQ(parseDeviceAddress("hid://0483:5750?product=LOBOT"), DeviceAddress(HidAddress{0x0483, 0x5750, "LOBOT"}));
    EXPECT_EQ(parseDeviceAddress("sim://tablet?jitter=5&drop=0.1"),
              DeviceAddress(SimulatedAddress{"tablet", {{"jitter", "5"}, {"drop", "0.1"}}}));
}

TEST(DeviceAddress, OptionsAreTextsAsTheyWereMeant) {
    EXPECT_EQ(parseDeviceAddress("hid://0483:5750?product=LOBOT%20xArm%26Co"),
              DeviceAddress(HidAddress{0x0483, 0x5750, "LOBOT xArm&Co"}));
    EXPECT_EQ(parseDeviceAddress("hid://0483:5750"), DeviceAddress(HidAddress{0x0483, 0x5750, ""}));
    EXPECT_EQ(parseDeviceAddress("sim://uno?jitter=&noise=a%3Db&drop=+1"),
              DeviceAddress(SimulatedAddress{"uno", {{"jitter", ""}, {"noise", "a=b"}, {"drop", "+1"}}}));
    EXPECT_EQ(parseDeviceAddress("sim://uno"), DeviceAddress(SimulatedAddress{"uno", {}}));
    EXPECT_EQ(parseDeviceAddress("serial:///dev/serial/by-id/usb-1a86_USB-if00-port0?baud=115200"),
              DeviceAddress(SerialAddress{"/dev/serial/by-id/usb-1a86_USB-if00-port0", 115200}));
}

TEST(DeviceAddress, RefusesWhatItCannotReachAndNamesIt) {
    for (const char* uri :
         {"", "tablet", "ftp://x", "serial://", "serial:///dev/ttyUSB0?baud=fast", "serial:///dev/ttyUSB0?baud=-9600",
          "bt://98:D3:31", "hid://483:5750", "sim://", "serial:///dev/ttyUSB0?bauds=9600",
          "serial:///dev/ttyUSB0?baud=", "serial://dev/ttyUSB0", "serial:///dev/tty%00USB0",
          "serial:///dev/ttyUSB0?baud=9600&parity=even", "bt://98:D3:31:F4:12:AB:00", "bt://98:D3:31:F4:12:AB?pin=1234",
          "hid://0483:5750:1", "hid://0483:5750?name=LOBOT"}) {
        try {
            (void)parseDeviceAddress(uri);
            FAIL() << uri;
        } catch (const InvalidInput& error) {
            EXPECT_NE(std::string(error.what()).find(std::string("'") + uri + "'"), std::string::npos);
        }
    }
}

} // namespace
} // namespace lumorph
