#include <atomic>
#include <cstdlib>
#include <functional>
#include <memory>
#include <new>
#include <vector>

#include <gtest/gtest.h>

#include "devices/protocol/natnet.h"
#include "devices/protocol/natnet_writer.h"
#include "devices/trackers/natnet_client.h"
#include "devices/trackers/tracker_hub.h"
#include "tests/support/natnet_frames.h"

namespace {

std::atomic<long> allocations{0};

void* allocate(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
    throw std::bad_alloc();
}

} // namespace

void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace lumorph {
namespace {

TEST(TrackerAllocations, TheCounterCounts) {
    const long before = allocations;
    const auto memory = std::make_unique<int>(1);
    EXPECT_EQ(allocations - before, 1) << *memory;
}

TEST(TrackerAllocations, FramesAreReadIntoTheSameMemory) {
    for (const natnet::Version version : test::kNatNetVersions) {
        const std::vector<std::byte> datagram = NatNetWriter(version).frame(test::RandomFrames(11).frame(version));
        natnet::FrameReader reader;
        for (int i = 0; i < 2; ++i) (void)reader.read(natnet::readPacket(datagram).payload, version);
        const long before = allocations;
        for (int i = 0; i < 100; ++i) (void)reader.read(natnet::readPacket(datagram).payload, version);
        EXPECT_EQ(allocations - before, 0) << version.major << "." << version.minor;
    }
}

TEST(TrackerAllocations, PosesComeToTheBoardWithoutAny) {
    const natnet::Version version{3, 1};
    NatNetWriter writer(version);
    natnet::Frame frame;
    frame.timestamp = 1.0;
    frame.ticks.emplace();
    std::vector<natnet::Model> models;
    RoleMap roles;
    for (int id = 1; id <= 24; ++id) {
        frame.bodies.push_back({id, {0.1F * static_cast<float>(id), 0, 0}, {1, 0, 0, 0}, 0.0F, true});
        const std::string name = "a body with a rather long name " + std::to_string(id);
        models.push_back({natnet::Model::Kind::rigidBody, name, id, {{name, id, -1, {}}}, {}});
        roles[name] = PoseRole::pointer;
    }
    const std::vector<std::byte> datagram = writer.frame(frame);
    const auto clock = std::make_shared<ManualClock>();
    const auto board = std::make_shared<PoseBoard>();
    TrackerHub hub(board, clock);
    hub.setRoles(roles);
    NatNetClient client(true, version, [](std::span<const std::byte>) {});
    (void)client.take(writer.models(models), clock->now());
    const std::string source = "natnet://127.0.0.1";
    const auto takeOne = [&] {
        clock->advance(Microseconds{4'167});
        (void)client.take(datagram, clock->now());
        hub.take(source, client.frame());
    };
    for (int i = 0; i < 5; ++i) takeOne();
    const long before = allocations;
    for (int i = 0; i < 100; ++i) takeOne();
    EXPECT_EQ(allocations - before, 0);
    EXPECT_EQ(board->entries().size(), 24U);
}

TEST(TrackerAllocations, TrackersThatShareANameNeedNone) {
    const auto clock = std::make_shared<ManualClock>();
    TrackerHub hub(std::make_shared<PoseBoard>(), clock);
    const std::string name = "a body with a rather long name";
    hub.setRoles({{name, PoseRole::head}});
    const std::string first = "opentrack://127.0.0.1:4242", second = "natnet://192.168.0.2?mode=multicast";
    TrackerFrame frame;
    frame.bodies = {{1, name, true, {}}};
    const auto takeFrom = [&](const std::string& source) {
        clock->advance(Microseconds{4'167});
        frame.measured = frame.arrived = clock->now();
        hub.take(source, frame);
    };
    const auto takeTurns = [&] {
        for (int i = 0; i < 100; ++i) takeFrom(i % 2 == 0 ? first : second);
        for (const std::string& source : {std::cref(first), std::cref(second)}) // each is silent, and taken over from
            for (int i = 0; i < 100; ++i) takeFrom(source);
    };
    takeTurns();
    const long before = allocations;
    takeTurns();
    EXPECT_EQ(allocations - before, 0);
}

} // namespace
} // namespace lumorph
