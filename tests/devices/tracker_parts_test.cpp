#include <cmath>
#include <numeric>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/loop/tracked_room.h"
#include "devices/trackers/clock_match.h"
#include "devices/trackers/rate_meter.h"
#include "devices/trackers/simulated_body.h"
#include "devices/trackers/tracker_address.h"
#include "devices/trackers/tracker_advice.h"
#include "devices/trackers/tracker_log.h"

namespace lumorph {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

Microseconds timeAt(double seconds) { return Microseconds(std::llround(1e6 * seconds)); }

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
    match.add(timeAt(1.0), timeAt(1.4), 999'999, 1000); // slow, and far off
    match.add(timeAt(2.0), timeAt(2.002), 5000, 1000);
    match.add(timeAt(3.0), timeAt(3.3), 1, 1000);
    EXPECT_EQ(match.localOf(5000), timeAt(2.001));
    EXPECT_EQ(match.localOf(6500), timeAt(3.501));
    EXPECT_EQ(match.localOf(4000), timeAt(1.001));
    match.clear();
    EXPECT_FALSE(match.localOf(5000));
}

TEST(ClockMatch, OldAnswersAreForgottenAndImpossibleOnesNotTaken) {
    ClockMatch match;
    match.add(timeAt(2.0), timeAt(1.0), 1, 1000); // answered before it was asked
    match.add(timeAt(2.0), timeAt(2.6), 1, 1000); // too slow
    match.add(timeAt(2.0), timeAt(2.1), 1, 0);
    EXPECT_FALSE(match.localOf(1));
    match.add(timeAt(0.0), timeAt(0.001), 0, 1000);
    for (int i = 0; i < 16; ++i)
        match.add(timeAt(10.0 + i), timeAt(10.01 + i), 20'000 + 1000U * static_cast<unsigned>(i), 1000);
    EXPECT_EQ(match.localOf(20'000), timeAt(10.005)) << "the quick one of long ago has drifted away";
    EXPECT_FALSE(match.localOf(~std::uint64_t{0} / 2));
}

TEST(RateMeter, TellsEvenRatesAndForgetsWhatStopped) {
    for (const double hertz : {1.0, 30.0, 120.0, 240.0, 1000.0}) {
        RateMeter meter;
        double now = 5.0;
        for (int i = 0; i < static_cast<int>(3 * hertz); ++i) meter.note(timeAt(now += 1.0 / hertz));
        EXPECT_NEAR(meter.perSecond(timeAt(now)), hertz, 0.02 * hertz);
        EXPECT_EQ(meter.perSecond(timeAt(now + 1.0)), 0.0);
    }
    EXPECT_EQ(RateMeter().perSecond(timeAt(0.1)), 0.0);
}

// --- The simulated body

std::vector<TrackerFrame> framesOf(const SimulatedBodyAddress& address, double seconds) {
    std::vector<TrackerFrame> frames;
    SimulatedBody body(address, timeAt(100.0));
    for (double t = 0.0; t <= seconds + 1e-9; t += 0.004)
        body.advance(timeAt(100.0 + t), [&](const TrackerFrame& frame) { frames.push_back(frame); });
    return frames;
}

TEST(SimulatedBody, ComesAtItsRateWithItsLatency) {
    const auto frames = framesOf({"head", 0.0, 0.0, 40.0, 100.0}, 10.0);
    EXPECT_NEAR(static_cast<double>(frames.size()), 997.0, 1.0);
    for (const TrackerFrame& frame : frames) EXPECT_EQ(frame.arrived - frame.measured, Microseconds{40'000});
    const SimulatedBody body({"head"}, timeAt(100.0));
    const double when = 1e-6 * static_cast<double>((frames[500].measured - timeAt(100.0)).count());
    EXPECT_EQ(frames[500].bodies.at(0).pose, body.path(when));
    EXPECT_EQ(frames[500].bodies.at(0).name, "head");
}

TEST(SimulatedBody, NoiseAndDropsAreAsOrdered) {
    const SimulatedBodyAddress address{"head", 2.0, 0.25, 0.0, 200.0};
    const auto frames = framesOf(address, 50.0);
    EXPECT_NEAR(static_cast<double>(frames.size()), 7500.0, 200.0) << "a quarter is dropped";
    const SimulatedBody body(address, timeAt(100.0));
    double sum = 0.0;
    for (const TrackerFrame& frame : frames) {
        const double when = 1e-6 * static_cast<double>((frame.measured - timeAt(100.0)).count());
        const double off = frame.bodies.at(0).pose.position.x - body.path(when).position.x;
        sum += off * off;
    }
    EXPECT_NEAR(std::sqrt(sum / static_cast<double>(frames.size())), 0.002, 0.0002);
    EXPECT_EQ(framesOf({"head", 0.0, 1.0, 0.0, 100.0}, 5.0).size(), 0U);
}

TEST(SimulatedBody, IsSeenAsTheTrackerOfItsRoomSeesIt) {
    Installation room;
    room.worldFromTracker = glm::mat4_cast(glm::angleAxis(1.1F, glm::vec3(0.0F, 1.0F, 0.0F)));
    room.worldFromTracker[3] = glm::vec4(0.6F, 0.3F, -0.4F, 1.0F);
    room.bodyFromDevice[3] = glm::vec4(0.01F, -0.02F, 0.005F, 1.0F);
    room.pointerTip = {0.0F, -0.16F, 0.01F};
    room.eyeFromHead = {0.02F, -0.03F, 0.08F};
    room.trackerSeconds = 0.012;
    for (const auto& [name, role] :
         {std::pair{"head", PoseRole::head}, {"device", PoseRole::device}, {"pointer", PoseRole::pointer}}) {
        SimulatedBody body({name, 0.0, 0.0, 20.0, 100.0}, timeAt(100.0));
        body.setRoom(std::make_shared<const Installation>(room));
        std::vector<TrackerFrame> frames;
        for (int k = 0; k < 500; ++k)
            body.advance(timeAt(100.0 + 0.01 * k), [&](const TrackerFrame& frame) { frames.push_back(frame); });
        const TrackerFrame& frame = frames.at(300);
        EXPECT_EQ(frame.arrived - frame.measured, Microseconds{20'000}) << "as late as the tracker knows";
        const double when = 1e-6 * static_cast<double>((frame.measured - timeAt(100.0)).count());
        const Pose truly = body.path(when - 0.012);
        Pose seen = inRoom(room, role, frame.bodies.at(0).pose);
        if (role == PoseRole::head) seen.position += seen.rotation * glm::dvec3(room.eyeFromHead);
        EXPECT_LT(glm::distance(seen.position, truly.position), 1e-6) << name;
        EXPECT_GT(std::abs(glm::dot(seen.rotation, truly.rotation)), 1.0 - 1e-9) << name;
        EXPECT_GT(glm::distance(frame.bodies.at(0).pose.position, truly.position), 0.2) << "in its own world";
        EXPECT_EQ(body.truth(frame.measured), body.path(when)) << "the truth is the room's";
    }
}

TEST(SimulatedBody, MovesSlowlyAndSleepsOverAPause) {
    const SimulatedBody head({"head"}, timeAt(0.0));
    for (double t = 0.0; t < 60.0; t += 0.01) {
        EXPECT_LT(glm::distance(head.path(t).position, head.path(t + 0.01).position), 0.005);
        EXPECT_LT(glm::distance(head.path(t).position, {0.0, 0.45, 0.6}), 0.3);
    }
    SimulatedBody body({"device"}, timeAt(0.0));
    int frames = 0;
    body.advance(timeAt(3600.0), [&](const TrackerFrame&) { ++frames; });
    EXPECT_LE(frames, 102) << "at most what a second holds";
    EXPECT_GE(frames, 99);
}

/// All frames of a body from 0 s on, at 100 Hz, while `steer` changes its orders.
template <typename Steer> std::vector<TrackerFrame> steered(double seconds, Steer steer) {
    std::vector<TrackerFrame> frames;
    const SimulatedBodyAddress address{"head"};
    SimulatedBody body(address, timeAt(0.0));
    SimulatedOrders orders = ordersOf(address);
    for (int i = 0; 0.002 * i <= seconds; ++i) {
        steer(orders, 0.002 * i);
        body.order(orders, timeAt(0.002 * i));
        body.advance(timeAt(0.002 * i), [&](const TrackerFrame& frame) { frames.push_back(frame); });
    }
    return frames;
}

TEST(SteeredBody, IsWhereItIsHeldAndComesThatMuchLater) {
    const Pose held{{0.3, 0.2, 0.9}, glm::angleAxis(0.5, glm::dvec3(0, 1, 0))};
    const auto frames = steered(3.0, [&](SimulatedOrders& orders, double t) {
        orders.latencyMilliseconds = 200.0;
        if (t >= 1.0) orders.held = held;
    });
    int before = 0, after = 0;
    for (const TrackerFrame& frame : frames) {
        EXPECT_EQ(frame.arrived - frame.measured, Microseconds{200'000});
        const bool isHeld = frame.bodies[0].pose == held;
        EXPECT_EQ(isHeld, frame.measured >= timeAt(1.0)) << frame.measured.count();
        ++(isHeld ? after : before);
    }
    EXPECT_NEAR(before, 100, 1);
    EXPECT_NEAR(after, 180, 2) << "from 1.0 s to 2.8 s";
}

TEST(SteeredBody, ChangesItsRateInMidStreamWithoutAGap) {
    const auto frames = steered(4.0, [](SimulatedOrders& orders, double t) { orders.rateHertz = t < 2.0 ? 50 : 200; });
    EXPECT_NEAR(static_cast<double>(frames.size()), 100.0 + 400.0, 3.0);
    for (std::size_t i = 1; i < frames.size(); ++i) {
        const double gap = 1e-6 * static_cast<double>((frames[i].measured - frames[i - 1].measured).count());
        EXPECT_NEAR(gap, i <= 101 ? 0.02 : 0.005, 0.016) << i;
        EXPECT_GT(gap, 0.0);
        EXPECT_EQ(frames[i].number, frames[i - 1].number + 1);
    }
}

TEST(SteeredBody, IsSpoiledForTenFramesEachTime) {
    const auto frames = steered(2.0, [](SimulatedOrders& orders, double t) {
        orders.jumps = t < 0.5 ? 0 : 1;
        orders.notNumbers = t < 1.5 ? 0 : 1;
        orders.hidden = t >= 1.9;
    });
    int jumped = 0, lacking = 0, lost = 0;
    const SimulatedBody truth({"head"}, timeAt(0.0));
    for (const TrackerFrame& frame : frames) {
        const TrackedBody& body = frame.bodies[0];
        lost += body.valid ? 0 : 1;
        if (!std::isfinite(body.pose.position.y))
            ++lacking;
        else
            jumped += glm::distance(body.pose.position, truth.truth(frame.measured).position) > 2.9 ? 1 : 0;
    }
    EXPECT_EQ(jumped, 10);
    EXPECT_EQ(lacking, 10);
    EXPECT_NEAR(lost, 11, 1);
}

TEST(TrackerLog, TellsOfABodyThatJumpsAndOfNoneThatRuns) {
    const auto clock = std::make_shared<ManualClock>();
    TrackerLog log("sim://head", clock);
    const auto see = [&](double x, double seconds, bool valid = true) {
        clock->advance(timeAt(seconds));
        log.noteFrame({1, clock->now(), clock->now(), {{7, "hat", valid, {{x, 0, 0}, {1, 0, 0, 0}}}}}, {});
        return log.status().events;
    };
    (void)see(0.0, 5.0);
    for (int i = 1; i <= 50; ++i) EXPECT_EQ(see(0.05 * i, 0.01), 0U) << "5 m/s";
    EXPECT_EQ(see(5.5, 0.01), 1U);
    EXPECT_EQ(log.status().event, "hat jumped by 3.00 m");
    EXPECT_EQ(see(0.0, 0.01), 1U) << "not ten times in a tenth of a second";
    (void)see(0.0, 0.01, false);
    EXPECT_EQ(see(4.0, 0.5), 1U) << "it was lost meanwhile";
    EXPECT_EQ(see(0.0, 5.0), 1U) << "nobody looked for 5 s";
    EXPECT_EQ(see(1.0, 0.01), 2U);
}

TEST(TrackerLog, TellsOfAPoseThatIsNoNumber) {
    const auto clock = std::make_shared<ManualClock>();
    TrackerLog log("natnet://127.0.0.1", clock);
    const auto see = [&](bool isNumber) {
        clock->advance(timeAt(0.01));
        log.noteFrame({1, clock->now(), clock->now(), {{7, "hat", isNumber, {}, isNumber}}}, {});
        return log.status().events;
    };
    EXPECT_EQ(see(true), 0U);
    EXPECT_EQ(see(false), 1U);
    EXPECT_EQ(log.status().event, "the pose of hat is no number, so it counts as not seen");
    EXPECT_EQ(see(false), 1U) << "not a hundred times a second";
    for (int i = 0; i < 100; ++i) (void)see(false);
    EXPECT_LE(log.status().events, 11U);
}

// --- What to do when nothing arrives

NatNetSituation quiet() {
    NatNetSituation s;
    s.hostIsHere = false;
    s.openToNetwork = true;
    s.ownAddresses = "127.0.0.1, 192.168.0.2";
    s.sinceOpened = timeAt(5.0);
    return s;
}

NatNetAddress remote() { return std::get<NatNetAddress>(parseTrackerAddress("natnet://192.168.0.5")); }

TEST(TrackerAdvice, NothingIsSaidWhileAllIsWellOrItIsTooEarly) {
    NatNetSituation s = quiet();
    s.sinceOpened = timeAt(0.5);
    EXPECT_THAT(adviceFor(remote(), s), IsEmpty());
    s.sinceOpened = timeAt(50.0);
    s.sinceFrame = timeAt(0.1);
    EXPECT_THAT(adviceFor(remote(), s), IsEmpty());
    s.sinceFrame = timeAt(12.5);
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

TEST(TrackerAdvice, AServerOnThisMachineMeetsNoFirewallAndNoNetwork) {
    const auto address = std::get<NatNetAddress>(parseTrackerAddress("natnet://127.0.0.1?mode=unicast"));
    NatNetSituation s = quiet();
    s.hostIsHere = true;
    s.openToNetwork = false;
    const std::string silent = adviceFor(address, s);
    EXPECT_THAT(silent, HasSubstr("127.0.0.1, which is this machine"));
    EXPECT_THAT(silent, HasSubstr("runs here"));
    EXPECT_THAT(silent, HasSubstr("by unicast and on the interface 127.0.0.1"));
    s.server = natnet::ServerInfo{"Motive", {2, 1, 0, 0}, {3, 0}, {}};
    const std::string answering = adviceFor(address, s);
    EXPECT_THAT(answering, HasSubstr("not paused; that it sends on the interface 127.0.0.1"));
    for (const char* wrong : {"not on loopback", "firewall", "same network", "leads here"}) {
        EXPECT_THAT(silent, Not(HasSubstr(wrong)));
        EXPECT_THAT(answering, Not(HasSubstr(wrong)));
    }
}

TEST(TrackerAdvice, WhileClosedAGroupIsHeardOnLoopbackAndItIsTold) {
    NatNetAddress address = remote();
    NatNetSituation s = quiet();
    s.hostIsHere = true; // by its address on the network
    s.openToNetwork = false;
    const std::string silent = adviceFor(address, s);
    s.server = natnet::ServerInfo{"Motive", {2, 1, 0, 0}, {3, 0}, {}};
    const std::string answering = adviceFor(address, s);
    for (const std::string& advice : {silent, answering}) {
        EXPECT_THAT(advice, HasSubstr("on the interface 127.0.0.1"));
        EXPECT_THAT(advice, HasSubstr("If it has to send on another interface, open this input to the network"));
    }
    s.openToNetwork = true;
    EXPECT_THAT(adviceFor(address, s), HasSubstr("on the interface 192.168.0.5."));
    address.multicast = false;
    s.openToNetwork = false;
    EXPECT_THAT(adviceFor(address, s), HasSubstr("on the interface 192.168.0.5."));
    EXPECT_THAT(adviceFor(address, s), Not(HasSubstr("another interface")));
}

TEST(TrackerAdvice, SaysHowAnInputIsOpened) {
    NatNetSituation s = quiet();
    s.openToNetwork = false;
    const std::string natnet = adviceFor(remote(), s);
    EXPECT_THAT(natnet, HasSubstr("192.168.0.5 is another machine"));
    for (const std::string& advice : {natnet, adviceFor(OpenTrackAddress{"127.0.0.1", 4242}, s),
                                      adviceFor(OscAddress{"127.0.0.1", 9000}, s, false)}) {
        EXPECT_THAT(advice, HasSubstr("switch on 'Take packets from other machines' and open it again"));
        EXPECT_THAT(advice, HasSubstr("--open"));
    }
}

TEST(TrackerAdvice, ASharedNameIsToldWithTheOtherAndTheRemedy) {
    EXPECT_EQ(adviceFor(SharedName{"head", 0, "sim://head", "a simulated head"}),
              "'head' of this tracker is not followed: sim://head (a simulated head) brings the same name and came "
              "first. Close one of the two trackers, or rename the body in its program.");
    EXPECT_THAT(adviceFor(SharedName{"head", 1, "replay", {}}),
                HasSubstr("'head' and 1 other body of this tracker are not followed: replay brings the same names"));
    EXPECT_THAT(adviceFor(SharedName{"head", 5, "replay", {}}), HasSubstr("'head' and 5 other bodies of"));
}

TEST(TrackerAdvice, NatNetKnowsWhatIsWrong) {
    NatNetAddress address = remote();
    address.local = "10.0.0.9";
    NatNetSituation s = quiet();
    s.localMissing = true;
    EXPECT_THAT(adviceFor(address, s), HasSubstr("no address 10.0.0.9"));
    EXPECT_THAT(adviceFor(address, s), HasSubstr("this machine has 127.0.0.1, 192.168.0.2"));

    s = quiet();
    s.openToNetwork = false;
    EXPECT_THAT(adviceFor(remote(), s), HasSubstr("Open it to the network"));
    s.openToNetwork = true;
    EXPECT_THAT(adviceFor(remote(), s), HasSubstr("Check in this order"));

    s = quiet();
    s.hostIsHere = true;
    s.openToNetwork = false;
    s.dropped = 17;
    s.lastDropped = "192.168.0.77";
    s.sinceDropped = timeAt(0.1);
    EXPECT_THAT(adviceFor(remote(), s), HasSubstr("17 packets of another machine (the last from 192.168.0.77) were"));

    s = quiet();
    s.framesWithoutVersion = true;
    EXPECT_THAT(adviceFor(remote(), s), HasSubstr("does not answer at port 1510"));

    s = quiet();
    s.sinceRejected = timeAt(0.2);
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

TEST(TrackerAdvice, OscTellsOfWhatItRefusesWhilePosesArrive) {
    TrackerSituation s = quiet();
    s.sinceFrame = timeAt(0.01);
    s.sinceRejected = timeAt(0.2);
    s.lastRejected = "from 127.0.0.1 port 5: '/tracking/trackers/head/rotation': a number in it is out of range";
    const OscAddress address{"127.0.0.1", 9000};
    EXPECT_EQ(adviceFor(address, s, false),
              "Poses arrive, but some of what arrives cannot be used: " + s.lastRejected + ".");
    s.sinceRejected = timeAt(60.0);
    EXPECT_THAT(adviceFor(address, s, false), IsEmpty());
}

TEST(TrackerAdvice, ListenersNameTheirPort) {
    TrackerSituation s = quiet();
    s.openToNetwork = false;
    const OpenTrackAddress address{"127.0.0.1", 4242};
    EXPECT_THAT(adviceFor(address, s), HasSubstr("port 4242 of 127.0.0.1"));
    EXPECT_THAT(adviceFor(address, s), HasSubstr("If it runs on another machine, open this input"));
    EXPECT_THAT(adviceFor(OscAddress{"192.168.0.2", 9000}, s, false), HasSubstr("port 9000 of 127.0.0.1"))
        << "while closed it listens nowhere else";
    s.openToNetwork = true;
    EXPECT_THAT(adviceFor(address, s), HasSubstr("firewall blocks UDP port 4242"));
    EXPECT_THAT(adviceFor(OscAddress{"127.0.0.1", 9000}, s, true), HasSubstr("Only rotations arrive"));
    EXPECT_THAT(adviceFor(OscAddress{"127.0.0.1", 9000}, s, false), HasSubstr("port 9000"));
}

} // namespace
} // namespace lumorph
