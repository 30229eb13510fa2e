#include "devices/controllers/controller_kinds.h"

#include <gtest/gtest.h>

namespace lumorph {
namespace {

TEST(ControllerKinds, AreToldByAddressAndName) {
    EXPECT_EQ(likelyController("serial:///dev/ttyUSB0?baud=57600 CH340"), ControllerKind::firmata);
    EXPECT_EQ(likelyController("hid://0483:5750?product=LOBOT"), ControllerKind::lewansoul);
    EXPECT_EQ(likelyController("serial:///dev/ttyACM0 Pololu Mini Maestro 12"), ControllerKind::maestro);
    EXPECT_EQ(likelyController("sim://XARM"), ControllerKind::lewansoul);
    EXPECT_EQ(likelyController(""), ControllerKind::firmata);
}

TEST(ControllerKinds, ChannelsAreCountedFromWhereTheBoardBegins) {
    DeviceProfile profile;
    for (const int channel : {4, 3, 8}) profile.servos.push_back({channel});
    countChannelsFrom(profile, firstChannel(ControllerKind::firmata));
    EXPECT_EQ(profile.servos[0].channel, 3);
    EXPECT_EQ(profile.servos[1].channel, 2);
    EXPECT_EQ(profile.servos[2].channel, 7);
    profile.servos.clear();
    countChannelsFrom(profile, 5);
    EXPECT_TRUE(profile.servos.empty());
}

} // namespace
} // namespace lumorph
