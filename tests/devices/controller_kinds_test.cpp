#include "devices/controllers/controller_kinds.h"

#include <map>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/devices/engine_bench.h"

namespace lumorph {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
namespace in = servo_input;

TEST(ControllerKinds, AreToldByAddressAndName) {
    EXPECT_EQ(likelyController("serial:///dev/ttyUSB0?baud=57600 CH340"), ControllerKind::firmata);
    EXPECT_EQ(likelyController("hid://0483:5750?product=LOBOT"), ControllerKind::lewansoul);
    EXPECT_EQ(likelyController("serial:///dev/ttyACM0 Pololu Mini Maestro 12"), ControllerKind::maestro);
    EXPECT_EQ(likelyController("hid://1ffb:0089?product=Maestro"), ControllerKind::maestro)
        << "the longest word decides";
    EXPECT_EQ(likelyController("sim://XARM"), ControllerKind::lewansoul);
    EXPECT_EQ(likelyController(""), ControllerKind::firmata);
}

TEST(ControllerKinds, NoTwoShareAKeyATitleAWordOrASimulatedBoard) {
    std::set<std::string_view> seen;
    std::set<ControllerKind> kinds;
    std::set<std::string_view> boards;
    for (const KnownController& known : knownControllers()) {
        EXPECT_TRUE(kinds.insert(known.kind).second);
        EXPECT_FALSE(known.key.empty() || known.title.empty() || known.words.empty() || known.simulators.empty());
        EXPECT_TRUE(seen.insert(known.title).second) << known.title;
        for (const std::string_view word : known.words) EXPECT_TRUE(seen.insert(word).second) << word;
        for (const std::string_view board : known.simulators) EXPECT_TRUE(boards.insert(board).second) << board;
    }
    for (const std::string& board : SimulatedBench().names())
        EXPECT_TRUE(boards.erase(board) == 1) << board << " is of no kind that is known";
    EXPECT_THAT(boards, ::testing::IsEmpty()) << "not on the bench";
}

DeviceProfile profileOn(const KnownController& known, std::string_view board) {
    DeviceProfile profile;
    profile.controller = known.kind;
    profile.address = "sim://" + std::string(board);
    profile.staggerSeconds = 0.05;
    profile.servos = {{.channel = known.firstChannel}, {.channel = known.firstChannel + 2}};
    return profile;
}

TEST(ControllerKinds, EachIsGuessedByItsWordsAndItsSimulatedBoards) {
    for (const KnownController& known : knownControllers()) {
        for (const std::string_view word : known.words)
            EXPECT_EQ(likelyController("a " + std::string(word) + " board"), known.kind) << word;
        for (const std::string_view board : known.simulators) {
            EXPECT_EQ(likelyController("sim://" + std::string(board)), known.kind) << board;
            EXPECT_EQ(likelyController("SIM://" + std::string(board) + "?jitter=5"), known.kind) << board;
        }
    }
}

/// The board's own truth about its servos says which of them is the first, and whether it moved and was let go.
TEST(ControllerKinds, EachDrivesItsSimulatedBoardsFromTheFirstChannelOn) {
    for (const KnownController& known : knownControllers())
        for (const std::string_view name : known.simulators) {
            SCOPED_TRACE(name);
            EngineBench bench(profileOn(known, name));
            ASSERT_TRUE(bench.connect());
            bench.tell(in::Command{{1.0, 0.25}});
            bench.tell(in::Arm{true});
            ASSERT_TRUE(bench.reaches(LinkPhase::live));
            bench.run(4.0);
            const std::vector<SimulatedServo> servos = bench.board->servos();
            EXPECT_NEAR(servos.at(0).position, 2000.0, 3.0);
            EXPECT_EQ(servos.at(1).pulse, 0.0) << "nobody asked for it";
            EXPECT_NEAR(servos.at(2).position, 1250.0, 3.0);
            bench.tell(in::Stop{});
            bench.run(0.2);
            for (const SimulatedServo& servo : bench.board->servos()) EXPECT_EQ(servo.pulse, 0.0);
        }
}

/// Other than it is by itself, within its limits.
void changeOption(DeviceProfile& profile, const ControllerOption& option) {
    if (const auto* number = std::get_if<int DeviceProfile::*>(&option.member)) {
        const int most = static_cast<int>(option.limits.most);
        profile.** number = profile.**number == most ? most - 1 : most;
    } else {
        bool& flag = profile.*std::get<bool DeviceProfile::*>(option.member);
        flag = !flag;
    }
}

TEST(ControllerKinds, EachComesBackFromAProfileWithItsOptions) {
    const std::map<ControllerKind, std::string> keys = {{ControllerKind::firmata, "firmata"},
                                                        {ControllerKind::lewansoul, "lewansoul"},
                                                        {ControllerKind::maestro, "maestro"}};
    for (const KnownController& known : knownControllers()) {
        SCOPED_TRACE(known.key);
        DeviceProfile profile = profileOn(known, known.simulators.front());
        const std::string before = profileText(profile);
        ASSERT_TRUE(keys.contains(known.kind)) << "name its key here: profiles of users hold it for ever";
        EXPECT_THAT(before, HasSubstr("\"controller\":\"" + keys.at(known.kind) + "\""));
        for (const ControllerOption& option : known.options) {
            const DeviceProfile unchanged = profile;
            changeOption(profile, option);
            EXPECT_FALSE(profile == unchanged);
            EXPECT_FALSE(sameOptions(profile, unchanged)) << option.key;
            EXPECT_THAT(profileText(profile), HasSubstr('"' + std::string(option.key) + "\":"));
        }
        EXPECT_TRUE(sameOptions(profile, profile));
        EXPECT_EQ(parseProfile(profileText(profile), "it"), profile);
        profile.servos[1].channel = known.lastChannel;
        EXPECT_NO_THROW((void)makeController(profile, parseDeviceAddress(profile.address)));
        EXPECT_EQ(parseProfile(profileText(profile), "it"), profile);
        profile.servos[1].channel = known.lastChannel + 1;
        EXPECT_THROW((void)makeController(profile, parseDeviceAddress(profile.address)), InvalidInput);
        EXPECT_THROW((void)parseProfile(profileText(profile), "it"), DataError);
    }
}

TEST(ControllerKinds, AnUnknownOneIsRefusedAndTheKnownOnesAreNamed) {
    const auto namesAll = AllOf(HasSubstr("firmata"), HasSubstr("lewansoul"), HasSubstr("maestro"));
    const auto messageOf = [](const auto& act) -> std::string {
        try {
            act();
        } catch (const Error& error) {
            return error.what();
        }
        return "it was taken";
    };
    for (const char* key : {"arduino", "Firmata", "firmat", "firmata ", "", "0"}) {
        const std::string text =
            R"({"format": "lumorph device", "schema": 1, "controller": ")" + std::string(key) + R"(", "servos": []})";
        EXPECT_THAT(messageOf([&] { (void)parseProfile(text, "lab.json"); }), AllOf(HasSubstr("lab.json"), namesAll));
        EXPECT_THAT(messageOf([&] { (void)knownController(key); }), namesAll) << key;
    }
    DeviceProfile profile = profileOn(knownControllers().front(), "tablet");
    profile.controller = static_cast<ControllerKind>(99);
    EXPECT_THAT(messageOf([&] { (void)makeController(profile, parseDeviceAddress(profile.address)); }), namesAll);
    EXPECT_THAT(messageOf([&] { checkProfile(profile); }), namesAll);
    EXPECT_THAT(messageOf([&] { (void)profileText(profile); }), namesAll);
}

} // namespace
} // namespace lumorph
