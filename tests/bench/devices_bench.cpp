#include <cmath>
#include <memory>
#include <thread>

#include <QCoreApplication>

#include "core/base/resources.h"
#include "core/base/statistics.h"
#include "core/rig/rig_file.h"
#include "devices/controllers/servo_link.h"
#include "devices/protocol/natnet_writer.h"
#include "devices/simulator/simulated_bench.h"
#include "devices/trackers/natnet_client.h"
#include "devices/trackers/tracker_hub.h"
#include "tests/bench/bench_groups.h"
#include "tests/bench/bench_timing.h"

namespace lumorph::bench {

namespace {

constexpr int kBodies = 24;
constexpr int kRate = 240;

natnet::Frame frameAt(int number) {
    natnet::Frame frame;
    frame.number = number;
    frame.timestamp = static_cast<double>(number) / kRate;
    frame.ticks.emplace();
    const auto way = static_cast<float>(0.2 * std::sin(0.01 * number));
    for (int id = 1; id <= kBodies; ++id)
        frame.bodies.push_back({id, {way, 1.0F, 0.1F * static_cast<float>(id)}, {0, 0, 0, 1}, 0.0F, true});
    return frame;
}

// Ten seconds of a motion capture system's packets, from the bytes to poses on the board.
void benchTracking(Report& report) {
    const natnet::Version version{3, 1};
    NatNetWriter writer(version);
    std::vector<natnet::Model> models;
    RoleMap roles;
    for (int id = 1; id <= kBodies; ++id) {
        const std::string name = "body " + std::to_string(id);
        models.push_back({natnet::Model::Kind::rigidBody, name, id, {{name, id, -1, {}}}, {}});
        roles[name] = PoseRole::pointer;
    }
    std::vector<std::vector<std::byte>> packets;
    for (int i = 0; i < 10 * kRate; ++i) packets.push_back(writer.frame(frameAt(i)));
    const auto clock = std::make_shared<ManualClock>();
    const auto board = std::make_shared<PoseBoard>();
    TrackerHub hub(board, clock);
    hub.setRoles(roles);
    NatNetClient client(true, version, [](std::span<const std::byte>) {});
    static_cast<void>(client.take(writer.models(models), clock->now()));
    std::vector<double> seconds;
    for (int round = 0; round < 5; ++round)
        seconds.push_back(secondsOf([&] {
            for (const auto& packet : packets) {
                clock->advance(Microseconds{1'000'000 / kRate});
                static_cast<void>(client.take(packet, clock->now()));
                hub.take("natnet://127.0.0.1", client.frame());
            }
        }));
    if (board->entries().size() != kBodies) report.fail("track-natnet", "not all bodies came to the board");
    const double share = 100.0 * median(seconds) / 10.0;
    report.add({"track-natnet",
                "240 Hz of 24 rigid bodies, from the packet to filtered poses",
                share,
                "% of a core",
                atMost(2.0),
                {},
                {fixed(1e6 * median(seconds) / (10.0 * kRate), 1) + " us a frame; the socket is left out"}});
}

// Commands as the loop gives them, to the simulated tablet through the link's own thread.
void benchServoLatency(Report& report) {
    int count = 1;
    char name[] = "lumorph-bench";
    char* words[] = {name, nullptr};
    const QCoreApplication application(count, words);
    SimulatedBench boards;
    DeviceProfile profile = profileFor(readRig(resourceFile("models/tablet.glb")));
    for (std::size_t i = 0; i < profile.servos.size(); ++i) profile.servos[i].channel = 2 + static_cast<int>(i);
    profile.address = "sim://tablet";
    profile.staggerSeconds = 0.05;
    LinkOptions options;
    options.bench = &boards;
    ServoLink link(profile, options);
    const auto reached = [&link](LinkPhase phase) {
        for (int i = 0; i < 1000 && link.status().phase != phase; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        return link.status().phase == phase;
    };
    link.connect();
    bool live = reached(LinkPhase::disarmed);
    link.arm(true);
    live = live && reached(LinkPhase::live);
    std::vector<double> medians;
    for (int i = 0; i < 300; ++i) {
        const std::vector<double> strokes(profile.servos.size(), 0.5 + 0.3 * std::sin(0.05 * i));
        link.command(strokes);
        std::this_thread::sleep_for(std::chrono::milliseconds(16));
        if (i >= 100) medians.push_back(link.status().latencyMilliseconds);
    }
    if (!live) {
        report.fail("servo-latency", "the simulated tablet did not start");
        return;
    }
    report.add({"servo-latency",
                "from a command to its first byte on the wire, beyond the rate cap",
                median(medians),
                "ms",
                atMost(2.0),
                {},
                {"simulated tablet at 57600 baud, 60 commands a second"}});
}

} // namespace

void benchDevices(const Filter& filter, Report& report) {
    if (filter.wants("track-natnet")) benchTracking(report);
    if (filter.wants("servo-latency")) benchServoLatency(report);
}

} // namespace lumorph::bench
