#include <cmath>
#include <numeric>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "devices/trackers/clock_match.h"
#include "devices/trackers/rate_meter.h"
#include "devices/trackers/simulated_body.h"
#include "devices/trackers/tracker_address.h"
#include "devices/trackers/tracker_advice.h"

namespace lumorph {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

Microseconds at(double seconds) { return Microseconds(std::llround(1e6 * seconds)); }

TEST(TrackerAddress, ReadsEveryKind) {
    NatNetAddress natnet;
    natnet.host = "192.168.0.5";
    EXPECT_EQ(parseTrackerAddress("natnet://192.168.0.5"), TrackerAddress(natnet));
    natnet.multicast = false;
    natnet.data = 1611;
    natnet.dataGiven = true;
    natnet.command = 1610;
    natnet.local = "192.168.0.2";
    natnet.group = "239.1.2.3";
    natnet.version = natnet::Version{2, 10};
    EXPECT_EQ(parseTrackerAddress("natnet://192.168.0.5?mode=unicast&data=1611&command=1610&local=192.168.0.2&"
                                  "multicast=239.1.2.3&version=2.10"),
              TrackerAddress(natnet));
    EXPECT_EQ(parseTrackerAddress("opentrack://127.0.0.1:5555"), TrackerAddress(OpenTrackAddress{"127.0.0.1", 5555}));
    EXPECT_EQ(parseTrackerAddress("opentrack://localhost"), TrackerAddress(OpenTrackAddress{"127.0.0.1", 4242}));
    EXPECT_EQ(parseTrackerAddress("osc://0.0.0.0:9001/"), TrackerAddress(OscAddress{"0.0.0.0", 9001}));
    EXPECT_EQ(parseTrackerAddress("sim://head?noise=0.5&drop=0.1&latency=40&rate=240"),
              TrackerAddress(SimulatedBodyAddress{"head", 0.5, 0.1, 40.0, 240.0}));
}

TEST(TrackerAddress, RefusesWhatIsNoneAndNamesIt) {
    for (const char* uri : {"",
                            "head",
                            "ftp://127.0.0.1",
                            "natnet://",
                            "natnet://motive.local",
                            "natnet://10.1",
                            "natnet://::1",
                            "natnet://127.0.0.1?mode=broadcast",
                            "natnet://127.0.0.1?data=0",
                            "natnet://127.0.0.1?command=65536",
                            "natnet://127.0.0.1?local=here",
                            "natnet://127.0.0.1?multicast=10.0.0.1",
                            "natnet://127.0.0.1?version=2.1",
                            "natnet://127.0.0.1?version=x",
                            "natnet://127.0.0.1?prot=1",
                            "opentrack://127.0.0.1:",
                            "opentrack://127.0.0.1:70000",
                            "opentrack://:4242",
                            "osc://127.0.0.1:9000?x=1",
                            "sim://",
                            "sim://cow",
                            "sim://head?noise=-1",
                            "sim://head?drop=1.5",
                            "sim://head?latency=nan",
                            "sim://head?rate=0"}) {
        try {
            (void)parseTrackerAddress(uri);
            ADD_FAILURE() << uri;
        } catch (const InvalidInput& error) {
            EXPECT_THAT(error.what(), HasSubstr(std::string("'") + uri + "'"));
        }
    }
}

TEST(ClockMatch, TheQuickestAnswerIsBelieved) {
    ClockMatch match;
    EXPECT_FALSE(match.localOf(5000));
    match.add(at(1.0), at(1.4), 999'999, 1000); // slow, and far off
    match.add(at(2.0), at(2.002), 5000, 1000);
    match.add(at(3.0), at(3.3), 1, 1000);
    EXPECT_EQ(match.localOf(5000), at(2.001));
    EXPECT_EQ(match.localOf(6500), at(3.501));
    EXPECT_EQ(match.localOf(4000), at(1.001));
    match.clear();
    EXPECT_FALSE(match.localOf(5000));
}

TEST(ClockMatch, OldAnswersAreForgottenAndImpossibleOnesNotTaken) {
    ClockMatch match;
    match.add(at(2.0), at(1.0), 1, 1000); // answered before it was asked
    match.add(at(2.0), at(2.6), 1, 1000); // too slow
    match.add(at(2.0), at(2.1), 1, 0);
    EXPECT_FALSE(match.localOf(1));
    match.add(at(0.0), at(0.001), 0, 1000);
    for (int i = 0; i < 16; ++i)
        match.add(at(10.0 + i), at(10.01 + i), 20'000 + 1000U * static_cast<unsigned>(i), 1000);
    EXPECT_EQ(match.localOf(20'000), at(10.005)) << "the quick one of long ago has drifted away";
    EXPECT_FALSE(match.localOf(~std::uint64_t{0} / 2));
}

TEST(RateMeter, TellsEvenRatesAndForgetsWhatStopped) {
    for (const double hertz : {1.0, 30.0, 120.0, 240.0, 1000.0}) {
        RateMeter meter;
        double now = 5.0;
        for (int i = 0; i < static_cast<int>(3 * hertz); ++i) meter.note(at(now += 1.0 / hertz));
        EXPECT_NEAR(meter.perSecond(at(now)), hertz, 0.02 * hertz);
        EXPECT_EQ(meter.perSecond(at(now + 1.0)), 0.0);
    }
    EXPECT_EQ(RateMeter().perSecond(at(0.1)), 0.0);
}

// --- The simulated body

std::vector<TrackerFrame> framesOf(const SimulatedBodyAddress& address, double seconds) {
    std::vector<TrackerFrame> frames;
    SimulatedBody body(address, at(100.0));
    for (double t = 0.0; t <= seconds + 1e-9; t += 0.004)
        body.advance(at(100.0 + t), [&](const TrackerFrame& frame) { frames.push_back(frame); });
    return frames;
}

TEST(SimulatedBody, ComesAtItsRateWithItsLatency) {
    const auto frames = framesOf({"head", 0.0, 0.0, 40.0, 100.0}, 10.0);
    EXPECT_NEAR(static_cast<double>(frames.size()), 997.0, 1.0);
    for (const TrackerFrame& frame : frames) EXPECT_EQ(frame.arrived - frame.measured, Microseconds{40'000});
    const SimulatedBody body({"head"}, at(100.0));
    const double when = 1e-6 * static_cast<double>((frames[500].measured - at(100.0)).count());
    EXPECT_EQ(frames[500].bodies.at(0).pose, body.truth(when));
    EXPECT_EQ(frames[500].bodies.at(0).name, "head");
}

TEST(SimulatedBody, NoiseAndDropsAreAsOrdered) {
    const SimulatedBodyAddress address{"head", 2.0, 0.25, 0.0, 200.0};
    const auto frames = framesOf(address, 50.0);
    EXPECT_NEAR(static_cast<double>(frames.size()), 7500.0, 200.0) << "a quarter is dropped";
    const SimulatedBody body(address, at(100.0));
    double sum = 0.0;
    for (const TrackerFrame& frame : frames) {
        const double when = 1e-6 * static_cast<double>((frame.measured - at(100.0)).count());
        const double off = frame.bodies.at(0).pose.position.x - body.truth(when).position.x;
        sum += off * off;
    }
    EXPECT_NEAR(std::sqrt(sum / static_cast<double>(frames.size())), 0.002, 0.0002);
    EXPECT_EQ(framesOf({"head", 0.0, 1.0, 0.0, 100.0}, 5.0).size(), 0U);
}

TEST(SimulatedBody, MovesSlowlyAndSleepsOverAPause) {
    const SimulatedBody head({"head"}, at(0.0));
    for (double t = 0.0; t < 60.0; t += 0.01) {
        EXPECT_LT(glm::distance(head.truth(t).position, head.truth(t + 0.01).position), 0.005);
        EXPECT_LT(glm::distance(head.truth(t).position, {0.0, 0.45, 0.6}), 0.3);
    }
    SimulatedBody body({"device"}, at(0.0));
    int frames = 0;
    body.advance(at(3600.0), [&](const TrackerFrame&) { ++frames; });
    EXPECT_LE(frames, 102) << "at most what a second holds";
    EXPECT_GE(frames, 99);
}

// --- What to do when nothing arrives

NatNetSituation quiet() {
    NatNetSituation s;
    s.hostIsHere = true;
    s.ownAddresses = "127.0.0.1, 192.168.0.2";
    s.sinceOpened = at(5.0);
    return s;
}

NatNetAddress remote() { return std::get<NatNetAddress>(parseTrackerAddress("natnet://192.168.0.5")); }

TEST(TrackerAdvice, NothingIsSaidWhileAllIsWellOrItIsTooEarly) {
    NatNetSituation s = quiet();
    s.sinceOpened = at(0.5);
    EXPECT_THAT(adviceFor(remote(), s), IsEmpty());
    s.sinceOpened = at(50.0);
    s.sinceFrame = at(0.1);
    EXPECT_THAT(adviceFor(remote(), s), IsEmpty());
    s.sinceFrame = at(12.5);
    EXPECT_THAT(adviceFor(remote(), s), HasSubstr("No pose has arrived for 12 s"));
}

TEST(TrackerAdvice, NatNetSaysWhatToCheckInOrder) {
    const std::string advice = adviceFor(remote(), quiet());
    std::size_t before = 0;
    for (const char* part :
         {"192.168.0.5 is the address of the machine on which Motive runs", "streaming is switched on",
          "firewall blocks UDP ports 1510 and 1511", "127.0.0.1, 192.168.0.2"}) {
        const std::size_t where = advice.find(part);
        ASSERT_NE(where, std::string::npos) << part << " in " << advice;
        EXPECT_GT(where, before);
        before = where;
    }
}

TEST(TrackerAdvice, NatNetKnowsWhatIsWrong) {
    NatNetAddress address = remote();
    address.local = "10.0.0.9";
    NatNetSituation s = quiet();
    s.localMissing = true;
    EXPECT_THAT(adviceFor(address, s), HasSubstr("no address 10.0.0.9"));
    EXPECT_THAT(adviceFor(address, s), HasSubstr("this machine has 127.0.0.1, 192.168.0.2"));

    s = quiet();
    s.hostIsHere = false;
    EXPECT_THAT(adviceFor(remote(), s), HasSubstr("Open it to the network"));
    s.openToNetwork = true;
    EXPECT_THAT(adviceFor(remote(), s), HasSubstr("Check in this order"));

    s = quiet();
    s.dropped = 17;
    s.lastDropped = "192.168.0.77";
    s.sinceDropped = at(0.1);
    EXPECT_THAT(adviceFor(remote(), s), HasSubstr("17 packets of another machine (the last from 192.168.0.77) were"));

    s = quiet();
    s.framesWithoutVersion = true;
    EXPECT_THAT(adviceFor(remote(), s), HasSubstr("does not answer at port 1510"));

    s = quiet();
    s.sinceRejected = at(0.2);
    s.lastRejected = "from 127.0.0.1 port 5: it ends too early";
    EXPECT_THAT(adviceFor(remote(), s), HasSubstr("it ends too early"));
}

TEST(TrackerAdvice, NatNetComparesWhatTheServerSaysWithTheAddress) {
    NatNetSituation s = quiet();
    s.server =
        natnet::ServerInfo{"Motive", {2, 1, 0, 0}, {3, 0}, natnet::Connection{1, 1511, true, {239, 255, 42, 99}}};
    EXPECT_THAT(adviceFor(remote(), s), HasSubstr("Motive at 192.168.0.5 answers, but sends no frames"));
    s.server->connection->dataPort = 1600;
    EXPECT_THAT(adviceFor(remote(), s), HasSubstr("sends to port 1600, but the address listens to data=1511"));
    s.server->connection->address = {239, 1, 1, 1};
    s.server->connection->dataPort = 1511;
    EXPECT_THAT(adviceFor(remote(), s), HasSubstr("group 239.1.1.1"));
    s.server->connection->multicast = false;
    EXPECT_THAT(adviceFor(remote(), s), HasSubstr("by unicast, but the address says mode=multicast"));
}

TEST(TrackerAdvice, ListenersNameTheirPort) {
    TrackerSituation s = quiet();
    const OpenTrackAddress address{"127.0.0.1", 4242};
    EXPECT_THAT(adviceFor(address, s), HasSubstr("port 4242 of 127.0.0.1"));
    EXPECT_THAT(adviceFor(address, s), HasSubstr("If it runs on another machine, open this input"));
    s.openToNetwork = true;
    EXPECT_THAT(adviceFor(address, s), HasSubstr("firewall blocks UDP port 4242"));
    EXPECT_THAT(adviceFor(OscAddress{"127.0.0.1", 9000}, s, true), HasSubstr("Only rotations arrive"));
    EXPECT_THAT(adviceFor(OscAddress{"127.0.0.1", 9000}, s, false), HasSubstr("port 9000"));
}

} // namespace
} // namespace lumorph
