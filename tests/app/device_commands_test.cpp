#include <chrono>
#include <csignal>
#include <sstream>
#include <stdexcept>
#include <string>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/process.h"

namespace lumorph::test {
namespace {

using ::testing::HasSubstr;

const nlohmann::json* servoOf(const nlohmann::json& report, std::size_t number) { return &report["servos"][number]; }

TEST(DeviceCommands, ListNamesTheSimulatedBoards) {
    const nlohmann::json devices = lumorph({"device", "list", "--json"}).json();
    std::vector<std::string> addresses;
    for (const auto& device : devices) addresses.push_back(device["address"]);
    for (const char* name : {"sim://tablet", "sim://uno", "sim://xarm", "sim://maestro"})
        EXPECT_THAT(addresses, ::testing::Contains(name));
}

TEST(DeviceCommands, ProbeSaysWhatABoardIsAndMovesNothing) {
    const nlohmann::json tablet = lumorph({"device", "probe", "sim://tablet", "--json"}).json();
    EXPECT_EQ(tablet["phase"], "ready");
    EXPECT_EQ(tablet["firmware"], "LumorphTablet 1.2");
    EXPECT_EQ(tablet["failsafe"], true);
    EXPECT_EQ(tablet["volts"], 7.4);
    for (const auto& servo : tablet["servos"]) EXPECT_EQ(servo["attached"], false);
    const nlohmann::json uno = lumorph({"device", "probe", "sim://uno", "--json"}).json();
    EXPECT_EQ(uno["jumpsOnAttach"], true);
    EXPECT_EQ(uno["failsafe"], false);
}

TEST(DeviceCommands, MoveLeadsOneServoToItsLevel) {
    const Outcome refused = lumorph({"device", "move", "sim://tablet", "--actuator", "1", "--level", "16"});
    EXPECT_EQ(refused.exitCode, 1);
    EXPECT_THAT(refused.err, HasSubstr("they may jump"));
    const Outcome outcome =
        lumorph({"device", "move", "sim://tablet", "--actuator", "1", "--level", "16", "--may-jump", "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NEAR((*servoOf(outcome.json(), 1))["microseconds"].get<double>(), 1450.0, 1.0); // the middle of its travel
    EXPECT_EQ((*servoOf(outcome.json(), 0))["microseconds"], 1138.0);
    // This arm reads where its servos stand, so nobody has to be asked.
    const Outcome arm = lumorph({"device", "move", "sim://xarm", "--actuator", "2", "--level", "8", "--json"});
    ASSERT_EQ(arm.exitCode, 0) << arm.err;
    EXPECT_NEAR((*servoOf(arm.json(), 2))["commanded"].get<double>(), 0.25, 0.002);
}

TEST(DeviceCommands, MonitorPrintsTheBytes) {
    const Outcome outcome = lumorph({"device", "monitor", "sim://tablet", "--seconds", "0.5"});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("-> F0 79 F7\n"));
    EXPECT_THAT(outcome.out, HasSubstr("<- F9 02 05"));
    EXPECT_THAT(outcome.out, ::testing::Not(HasSubstr("-> E")));
}

struct Wrong {
    std::vector<std::string> arguments;
    int exitCode;
    const char* says;
};

TEST(DeviceCommands, WrongArgumentsAreTold) {
    const Wrong cases[] = {
        {{"probe", "serial:///dev/ttyNothing"}, 1, "there is no port /dev/ttyNothing"},
        {{"probe", "nonsense"}, 2, "its scheme is unknown"},
        {{"probe", "sim://nobody"}, 1, "nobody"},
        {{"move", "sim://tablet", "--actuator", "6", "--level", "1"}, 2, "the profile has 6 of them"},
        {{"move", "sim://tablet", "--actuator", "0", "--level", "33"}, 2, "there are 33 levels"},
        {{"move", "sim://tablet", "--actuator", "0", "--level", "-1"}, 2, "level -1"},
        {{"probe", "sim://tablet", "--profile", "/nowhere.json"}, 1, "/nowhere.json"},
        {{"probe", "sim://tablet", "--controller", "magic"},
         2,
         "'magic' is no controller that is known here; write "
         "firmata, lewansoul or maestro"},
    };
    for (const Wrong& wrong : cases) {
        SCOPED_TRACE(wrong.says);
        std::vector<std::string> arguments{"device"};
        arguments.insert(arguments.end(), wrong.arguments.begin(), wrong.arguments.end());
        const Outcome outcome = lumorph(arguments);
        EXPECT_EQ(outcome.exitCode, wrong.exitCode) << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr(wrong.says));
    }
}

/// A serial port that is a file: the near end of a pseudo-terminal.
class TestPort {
public:
    TestPort() : far_(::posix_openpt(O_RDWR | O_NOCTTY)) {
        if (far_ < 0 || ::grantpt(far_) != 0 || ::unlockpt(far_) != 0) throw std::runtime_error("no terminal");
        path_ = ::ptsname(far_);
        near_ = ::open(path_.c_str(), O_RDWR | O_NOCTTY);
    }
    ~TestPort() {
        ::close(near_);
        ::close(far_);
    }
    TestPort(const TestPort&) = delete;
    TestPort& operator=(const TestPort&) = delete;

    [[nodiscard]] const std::string& path() const { return path_; }
    /// As a program does that uses it.
    [[nodiscard]] bool lock() const { return ::flock(near_, LOCK_EX | LOCK_NB) == 0; }

private:
    int far_ = -1;
    int near_ = -1;
    std::string path_;
};

constexpr std::chrono::seconds kAtOnce{7};
constexpr const char* kAsNobody = "/usr/bin/setpriv"; ///< root may open every port

/// What no waiting mends is told before an answer of the board is waited for, which takes eight seconds each time. One
/// start of a program may take as long on a machine that is busy otherwise; not three.
void expectToldAtOnce(const std::string& command, const std::string& address, const std::string& why,
                      const std::string& remedy, bool asNobody = false) {
    SCOPED_TRACE(command + ' ' + address);
    std::vector<std::string> arguments{"device", command, address};
    if (command == "move") arguments.insert(arguments.end(), {"--actuator", "0", "--level", "1"});
    if (asNobody) arguments.insert(arguments.begin(), {"--reuid=65534", "--clear-groups", lumorphProgram()});
    Outcome outcome;
    auto took = std::chrono::steady_clock::duration::max();
    for (int tries = 0; tries < 3 && took >= kAtOnce; ++tries) {
        const auto begun = std::chrono::steady_clock::now();
        outcome = Process(asNobody ? kAsNobody : lumorphProgram(), arguments).wait();
        took = std::chrono::steady_clock::now() - begun;
    }
    EXPECT_LT(took, kAtOnce);
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_THAT(outcome.err, HasSubstr(address)) << "what is meant";
    EXPECT_THAT(outcome.err, HasSubstr(why));
    EXPECT_THAT(outcome.err, HasSubstr(remedy));
    EXPECT_THAT(outcome.err, ::testing::Not(HasSubstr("There is no link"))) << "once is enough";
}

TEST(DeviceCommands, APortThatIsNotThereIsToldAtOnce) {
    for (const char* command : {"probe", "monitor", "move"})
        expectToldAtOnce(command, "serial:///dev/ttyNothing", "there is no port /dev/ttyNothing", "plug the device in");
    expectToldAtOnce("probe", "hid://0483:ffff", "no USB device", "plug");
}

TEST(DeviceCommands, APortThatSomebodyUsesIsToldAtOnce) {
    const TestPort port;
    ASSERT_TRUE(port.lock());
    expectToldAtOnce("probe", "serial://" + port.path(), "uses " + port.path(), "close ");
}

TEST(DeviceCommands, APortThatIsNotPermittedIsToldAtOnce) {
    const TestPort port;
    const bool root = ::geteuid() == 0;
    if (root && ::access(kAsNobody, X_OK) != 0) GTEST_SKIP() << "needs to be another user";
    ASSERT_EQ(::chmod(port.path().c_str(), 0), 0);
    expectToldAtOnce("monitor", "serial://" + port.path(), "permission denied on " + port.path(), "add yourself to",
                     root);
}

TEST(TrackCommand, PrintsOneJsonObjectAFrame) {
    const Outcome outcome = lumorph({"track", "monitor", "sim://head?rate=100", "--frames", "5", "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    std::istringstream lines(outcome.out);
    int count = 0;
    for (std::string line; std::getline(lines, line); ++count) {
        const nlohmann::json frame = nlohmann::json::parse(line);
        ASSERT_EQ(frame["bodies"].size(), 1U);
        const auto& body = frame["bodies"][0];
        EXPECT_EQ(body["name"], "head");
        EXPECT_EQ(body["position"].size(), 3U);
        const auto& q = body["rotation"];
        double length = 0.0;
        for (const auto& part : q) length += part.get<double>() * part.get<double>();
        EXPECT_NEAR(length, 1.0, 1e-9);
    }
    EXPECT_EQ(count, 5);
}

TEST(TrackCommand, SaysWhatIsWrongWithAnAddress) {
    const Outcome outcome = lumorph({"track", "monitor", "opentrack://nonsense:x"});
    EXPECT_EQ(outcome.exitCode, 2);
    EXPECT_THAT(outcome.err, HasSubstr("opentrack"));
}

TEST(TrackCommand, CtrlCEndsAMonitorAndIsNoFailure) {
    using namespace std::chrono_literals;
    Process monitor(lumorphProgram(), {"track", "monitor", "board://camera99", "--json"});
    ASSERT_TRUE(monitor.waitForError("There is no camera at /dev/video99", 20s));
    monitor.send(SIGINT);
    const Outcome outcome = monitor.wait(10s);
    EXPECT_EQ(outcome.exitCode, 0);
    EXPECT_THAT(outcome.err, HasSubstr("lumorph: stopped after "));
    EXPECT_THAT(outcome.err, HasSubstr(" s: 0 frames in 0 packets, 0 of them rejected"));
    EXPECT_THAT(outcome.err, ::testing::Not(HasSubstr("nothing was written")));
    EXPECT_THAT(outcome.err, HasSubstr("taken to see 60 degrees")) << "no lens is known";
}

TEST(TrackCommand, CtrlCBeforeAllFramesCameIsOne) {
    using namespace std::chrono_literals;
    Process monitor(lumorphProgram(), {"track", "monitor", "board://camera99", "--json", "--frames", "3"});
    ASSERT_TRUE(monitor.waitForError("There is no camera", 20s));
    monitor.send(SIGINT);
    const Outcome outcome = monitor.wait(10s);
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_THAT(outcome.err, HasSubstr("it was stopped after 0 of 3 frames; There is no camera"));
}

TEST(TrackCommand, WritesABoardToPrint) {
    const Outcome page = lumorph({"track", "board", "-", "--board", "squares=4x6&size=35&marker=25"});
    EXPECT_EQ(page.exitCode, 0) << page.err;
    EXPECT_TRUE(page.out.starts_with("%PDF-1.4"));
    EXPECT_THAT(page.out, HasSubstr("4 x 6 squares of 35 mm"));
    const Outcome wrong = lumorph({"track", "board", "-", "--board", "squares=4x6&cow=1"});
    EXPECT_EQ(wrong.exitCode, 2);
    EXPECT_THAT(wrong.err, HasSubstr("nothing is known of 'cow'"));
    EXPECT_TRUE(lumorph({"track", "cameras", "--json"}).json().is_array());
}

/// A body that swings along x for six seconds, 100 poses a second, with `comma` between the numbers.
std::string swingRows(const char* comma) {
    std::ostringstream rows;
    rows << "# time x y z qx qy qz qw\n" << std::fixed;
    for (int k = 0; k < 600; ++k) {
        const double x = 0.08 * std::sin(0.04 * k);
        rows << 0.01 * k << comma << x << comma << 0.8 << comma << 0 << comma << 0 << comma << 0 << comma << 0 << comma
             << 1 << "\n";
    }
    return rows.str();
}

TEST(TrackCommand, ReplayComparesThePredictionWithConstantVelocity) {
    nlohmann::json before;
    for (const char* comma : {",", " "}) {
        const Outcome outcome =
            lumorph({"track", "replay", "-", "--ahead", "50ms", "--noise", "1mm", "--json"}, swingRows(comma));
        ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
        const nlohmann::json json = outcome.json();
        EXPECT_GT(json["rmsMm"].get<double>(), 0.1);
        EXPECT_LE(json["rmsMm"].get<double>(), 0.7 * json["constantVelocity"]["rmsMm"].get<double>());
        EXPECT_GT(json["p95Mm"].get<double>(), json["rmsMm"].get<double>());
        EXPECT_GT(json["constantVelocity"]["p95Mm"].get<double>(), json["p95Mm"].get<double>());
        if (before.is_object()) {
            EXPECT_EQ(json, before) << "blanks are as good as commas";
        }
        before = json;
    }
    const Outcome seconds =
        lumorph({"track", "replay", "-", "--ahead", "0.05s", "--noise", "0.001m", "--json"}, swingRows(","));
    EXPECT_EQ(seconds.json(), before);
    const Outcome seed = lumorph({"track", "replay", "-", "--seed", "2", "--json"}, swingRows(","));
    EXPECT_NE(seed.json(), before);
    EXPECT_THAT(lumorph({"track", "replay", "-"}, swingRows(",")).out, HasSubstr("constant velocity"));
}

TEST(TrackCommand, ReplaySaysWhatIsWrong) {
    const struct {
        std::vector<std::string> options;
        std::string rows;
        const char* said;
    } wrong[] = {{{}, "", "two poses"},
                 {{}, "0,0,0,0,0,0,0,1\n0.1,0,zero,0,0,0,0,1\n", "line 2"},
                 {{"--ahead", "20s"}, swingRows(","), "a second longer than the time ahead"},
                 {{"--ahead", "50"}, swingRows(","), "ms or s"},
                 {{"--ahead", "-5ms"}, swingRows(","), "ms or s"},
                 {{"--noise", "1cm"}, swingRows(","), "mm or m"}};
    for (const auto& row : wrong) {
        std::vector<std::string> words = {"track", "replay", "-"};
        words.insert(words.end(), row.options.begin(), row.options.end());
        const Outcome outcome = lumorph(words, row.rows);
        EXPECT_NE(outcome.exitCode, 0) << row.said;
        EXPECT_THAT(outcome.err, HasSubstr(row.said));
    }
}

} // namespace
} // namespace lumorph::test
