#include "devices/controllers/servo_link_watch.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lumorph {
namespace {

TEST(LinkWatch, ALowBatteryDoesNotDrownWhatTheBoardSays) {
    std::string said;
    LinkWatch watch([&](LinkEvent::Kind, const std::string& text, const std::string&) { said += text + "\n"; });
    ControllerState state;
    state.phase = ControllerPhase::ready;
    state.volts = 5.5;
    state.trouble = LinkTrouble{"battery at 5.5 V", "charge it"};
    state.batteryTrouble = true;
    watch.opened(state);
    watch.look(state, Microseconds(0));
    EXPECT_THAT(said, testing::HasSubstr("The battery is low: 5.5 V."));
    EXPECT_THAT(said, testing::Not(testing::HasSubstr("Trouble with the board"))) << "it has words of its own";
    state.trouble = LinkTrouble{"the board says 'Silence: servos let go'", "start the servos again"};
    state.batteryTrouble = false;
    watch.look(state, Microseconds(1));
    EXPECT_THAT(said, testing::HasSubstr("Trouble with the board: the board says 'Silence"));
}

} // namespace
} // namespace lumorph
