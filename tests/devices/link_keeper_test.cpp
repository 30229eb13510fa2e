#include "devices/transport/link_keeper.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/base/error.h"
#include "devices/simulator/pty.h"
#include "devices/transport/serial_transport.h"
#include "tests/devices/event_loop.h"

namespace lumorph {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using Bytes = std::vector<std::uint8_t>;

const LinkTrouble kGone{"it is gone", "plug it in"};
const LinkTrouble kDenied{"permission denied", "join the group"};
const LinkTrouble kSilent{"it does not answer", "choose another baud rate"};

/// A device that opens, fails and speaks at the test's word.
struct Script {
    std::optional<LinkTrouble> refusal = kGone;
    bool isSlow = false; ///< neither opens nor fails before it is told to
    std::vector<DeviceAddress> attempts;
    Transport::Events events; ///< of the newest transport
    Bytes written;
    bool open = false;

    void die(const LinkTrouble& why) {
        open = false;
        events.closed(why);
    }
    void say(const Bytes& bytes) const { events.received(bytes); }
};

class ScriptedTransport final : public Transport {
public:
    ScriptedTransport(Script& script, DeviceAddress address) : script_(script), address_(std::move(address)) {}
    void open() override {
        script_.attempts.push_back(address_);
        if (script_.isSlow) return;
        if (script_.refusal) return script_.events.closed(*script_.refusal);
        script_.open = true;
        script_.events.opened();
    }
    void close() override { script_.open = false; }
    [[nodiscard]] bool isOpen() const override { return script_.open; }
    void write(std::span<const std::uint8_t> message) override {
        script_.written.insert(script_.written.end(), message.begin(), message.end());
    }
    [[nodiscard]] std::size_t unsent() const override { return script_.written.size(); }
    [[nodiscard]] std::string identity() const override { return "S1"; }
    [[nodiscard]] std::string product() const override { return "Uno"; }

private:
    Script& script_;
    DeviceAddress address_;
};

class LinkKeeperTest : public testing::Test {
protected:
    LinkKeeperTest() {
        world_.makeTransport = [this](const DeviceAddress& address, Transport::Events events) {
            script_.events = std::move(events);
            return std::make_unique<ScriptedTransport>(script_, address);
        };
        world_.serialPorts = [this] { return ports_; };
        world_.sight = [this](const DeviceAddress&) { return sight_; };
    }
    void make(DeviceAddress address = SerialAddress{"/dev/none0"}) {
        keeper_.emplace(
            std::move(address),
            LinkKeeper::Events{[this] { ++opened_; },
                               [this](auto bytes) { received_.insert(received_.end(), bytes.begin(), bytes.end()); },
                               [this](const LinkTrouble& why) {
                                   lost_.push_back(why.why);
                                   if (onLost_) onLost_();
                               }},
            world_);
    }
    /// Ticks every 10 ms; the times of attempts in milliseconds since the beginning.
    std::vector<int> run(std::chrono::milliseconds time) {
        std::vector<int> times;
        for (const Microseconds end = now_ + time; now_ < end;) {
            now_ += 10ms;
            const std::size_t before = script_.attempts.size();
            keeper_->tick(now_);
            if (script_.attempts.size() > before) times.push_back(static_cast<int>((now_ - begin_) / 1ms));
        }
        return times;
    }
    /// Rounded pauses between attempts, tenths of a second.
    static std::vector<int> pauses(const std::vector<int>& times) {
        std::vector<int> pauses;
        for (int last = 0; const int time : times) {
            pauses.push_back((time - last + 40) / 100);
            last = time;
        }
        return pauses;
    }
    void begin() { begin_ = now_; }

    Script script_;
    std::vector<SerialPort> ports_;
    std::string sight_;
    LinkWorld world_;
    std::optional<LinkKeeper> keeper_;
    Microseconds now_{1h};
    Microseconds begin_{now_};
    int opened_ = 0;
    Bytes received_;
    std::vector<std::string> lost_;
    std::function<void()> onLost_;
};

TEST_F(LinkKeeperTest, TriesAgainWithGrowingPausesAndComplainsOnce) {
    make();
    run(1s);
    EXPECT_TRUE(script_.attempts.empty()); // not started
    begin();
    keeper_->start(now_);
    EXPECT_EQ(script_.attempts.size(), 1u); // at once
    EXPECT_THAT(pauses(run(10s)), ElementsAre(2, 4, 8, 16, 20, 20, 20));
    EXPECT_THAT(lost_, ElementsAre(kGone.why));
    EXPECT_EQ(keeper_->trouble(), kGone);
    EXPECT_FALSE(keeper_->isOpen());

    script_.refusal = kDenied;
    run(10s);
    EXPECT_THAT(lost_, ElementsAre(kGone.why, kDenied.why));
    EXPECT_EQ(keeper_->trouble(), kDenied);
    script_.refusal = std::nullopt;
    run(2100ms);
    EXPECT_EQ(opened_, 1);
    EXPECT_TRUE(keeper_->isOpen());
    EXPECT_EQ(keeper_->trouble(), std::nullopt);
    run(10s);
    EXPECT_EQ(opened_, 1);
}

TEST_F(LinkKeeperTest, PassesBytesOnlyWhileOpen) {
    make();
    keeper_->write(Bytes{1});
    script_.refusal = std::nullopt;
    keeper_->start(now_);
    keeper_->write(Bytes{2, 3});
    EXPECT_THAT(script_.written, ElementsAre(2, 3));
    EXPECT_EQ(keeper_->unsent(), 2u);
    EXPECT_EQ(keeper_->identity(), "S1");
    EXPECT_EQ(keeper_->product(), "Uno");
    script_.say({7, 8});
    EXPECT_THAT(received_, ElementsAre(7, 8));
    script_.die(kGone);
    keeper_->write(Bytes{4});
    EXPECT_THAT(script_.written, ElementsAre(2, 3));
    EXPECT_EQ(keeper_->unsent(), 0u);
}

TEST_F(LinkKeeperTest, ADeviceThatSpokeIsTriedSoonOneThatIsSilentEverLater) {
    make();
    script_.refusal = std::nullopt;
    keeper_->start(now_);
    for (int round = 0; round < 5; ++round) {
        script_.say({1});
        script_.die(kGone);
        begin();
        EXPECT_THAT(pauses(run(300ms)), ElementsAre(2)) << round;
    }
    EXPECT_EQ(lost_.size(), 5u); // each loss of an open link is told

    // A port that opens but does not answer (the wrong baud rate) must not be opened five times a second.
    script_.say({1});
    std::vector<int> tenths;
    for (int round = 0; round < 6; ++round) {
        keeper_->drop(kSilent, now_);
        EXPECT_FALSE(script_.open);
        begin();
        tenths.push_back(pauses(run(2500ms)).at(0));
    }
    EXPECT_THAT(tenths, ElementsAre(2, 4, 8, 16, 20, 20));
    EXPECT_EQ(keeper_->trouble(), std::nullopt);
    EXPECT_EQ(lost_.back(), kSilent.why);
}

TEST_F(LinkKeeperTest, TheDeviceThatIsExpectedIsOpenedWhateverItsPortIsCalledToday) {
    script_.refusal = std::nullopt;
    ports_ = {{"/dev/none0", "S7", 0x2341, 0x43, "Uno"}, {"/dev/none3", "S1", 0x2341, 0x43, "Uno"}};
    make();
    keeper_->start(now_, "S1");
    EXPECT_EQ(script_.attempts.back(), DeviceAddress(SerialAddress{"/dev/none3"}))
        << "another board has the port that is typed";
    for (const auto& [ports, opened] : std::vector<std::pair<std::vector<SerialPort>, const char*>>{
             {{{"/dev/none0", "S1", 0x2341, 0x43, "Uno"}}, "/dev/none0"},
             {{{"/dev/none5", "S7", 0x2341, 0x43, "Uno"}}, "/dev/none0"}, // its own trouble is told
             {{{"/dev/none5", "S1", 0x2341, 0x43, "Uno"}, {"/dev/none6", "S1", 0x2341, 0x43, "Uno"}}, "/dev/none0"},
             {{{"/dev/none5", "S1", 0x2341, 0x43, "Uno"}}, "/dev/none5"}}) {
        keeper_->stop();
        ports_ = ports;
        keeper_->start(now_, "S1");
        EXPECT_EQ(script_.attempts.back(), DeviceAddress(SerialAddress{opened}));
    }
    keeper_->stop();
    keeper_->start(now_);
    EXPECT_EQ(script_.attempts.back(), DeviceAddress(SerialAddress{"/dev/none0"})) << "nobody in particular is meant";
}

TEST_F(LinkKeeperTest, OpensAtOnceWhatHasComeBack) {
    make();
    keeper_->start(now_);
    run(10s); // the pauses are long by now
    begin();
    script_.refusal = std::nullopt;
    sight_ = "a new node";
    run(250ms); // not at the very moment: its permissions come a little later
    EXPECT_EQ(opened_, 1);
}

TEST_F(LinkKeeperTest, ASightThatDoesNotChangeHastensNothing) {
    sight_ = "a node that cannot be opened";
    make();
    script_.refusal = kDenied;
    begin();
    keeper_->start(now_);
    EXPECT_THAT(pauses(run(10s)), ElementsAre(2, 4, 8, 16, 20, 20, 20));
}

TEST_F(LinkKeeperTest, WaitsForASlowOpening) {
    make(BluetoothAddress{"98:D3:31:F4:12:AB"});
    script_.isSlow = true;
    keeper_->start(now_);
    run(10s);
    EXPECT_EQ(script_.attempts.size(), 1u);
    script_.events.closed(kGone);
    run(300ms);
    EXPECT_EQ(script_.attempts.size(), 2u);
    script_.events.opened();
    EXPECT_TRUE(keeper_->isOpen());
}

TEST_F(LinkKeeperTest, StopsForGoodEvenFromItsOwnEvent) {
    make();
    script_.refusal = std::nullopt;
    keeper_->start(now_);
    onLost_ = [this] { keeper_->stop(); };
    keeper_->drop(kSilent, now_);
    EXPECT_TRUE(run(10s).empty());
    keeper_->drop(kSilent, now_);
    EXPECT_EQ(lost_.size(), 1u);
    EXPECT_EQ(keeper_->trouble(), std::nullopt);

    // Or begins anew there.
    onLost_ = nullptr;
    keeper_->start(now_);
    ASSERT_TRUE(keeper_->isOpen());
    onLost_ = [this] {
        keeper_->stop();
        keeper_->start(now_);
    };
    script_.die(kGone);
    EXPECT_TRUE(keeper_->isOpen());
    run(1s);
    EXPECT_EQ(opened_, 3);
}

TEST_F(LinkKeeperTest, TellsWhatCannotBeMade) {
    world_.makeTransport = [](const DeviceAddress&, const Transport::Events&) -> std::unique_ptr<Transport> {
        throw InvalidInput("simulated device 'x'", "there is none of this name", "choose one of tablet, uno");
    };
    make(SimulatedAddress{"x", {}});
    keeper_->start(now_);
    run(5s);
    EXPECT_THAT(lost_, ElementsAre("there is none of this name"));
    EXPECT_EQ(keeper_->trouble()->remedy, "choose one of tablet, uno");
    keeper_->drop(kSilent, now_); // there is nothing to close
    EXPECT_EQ(keeper_->trouble(), kSilent);
}

TEST_F(LinkKeeperTest, FollowsASerialNumberAndLeavesOthersAlone) {
    const SerialPort mine{"/dev/none0", "S1", 0x2341, 0x43, "Uno"};
    const SerialPort other{"/dev/none0", "S2", 0x2341, 0x43, "Uno"};
    const SerialPort moved{"/dev/none7", "S1", 0x2341, 0x43, "Uno"};
    ports_ = {mine};
    script_.refusal = std::nullopt;
    make(SerialAddress{"/dev/none0", 9600});
    keeper_->start(now_);
    ports_ = {other}; // another board sits where it was
    script_.die(kGone);
    run(10s);
    EXPECT_EQ(script_.attempts.size(), 1u);
    EXPECT_THAT(lost_, ElementsAre(kGone.why, "there is no port /dev/none0"));
    ports_ = {other, moved};
    run(2100ms);
    ASSERT_EQ(script_.attempts.size(), 2u);
    EXPECT_EQ(script_.attempts.back(), DeviceAddress(SerialAddress{"/dev/none7", 9600}));
    EXPECT_TRUE(keeper_->isOpen());

    // Its user may mean the other board: connecting anew begins with the address as it was typed.
    keeper_->stop();
    keeper_->start(now_);
    EXPECT_EQ(script_.attempts.back(), DeviceAddress(SerialAddress{"/dev/none0", 9600}));
}

// Real pseudo-terminals, real time.

class LinkKeeperOnPty : public testing::Test {
protected:
    LinkKeeperOnPty() {
        world_.makeTransport = [](const DeviceAddress& address, Transport::Events events) {
            return makeSerialTransport(std::get<SerialAddress>(address), std::move(events));
        };
        world_.serialPorts = [this] { return ports_; };
        world_.sight = sightOfNode;
    }
    ~LinkKeeperOnPty() override { std::filesystem::remove(link_); }
    void make(const std::string& path) {
        keeper_.emplace(
            SerialAddress{path},
            LinkKeeper::Events{[this] { ++opened_; },
                               [this](auto bytes) { received_.insert(received_.end(), bytes.begin(), bytes.end()); },
                               [this](const LinkTrouble& why) { lost_.push_back(why); }},
            world_);
        keeper_->start(clock_.now());
    }
    bool runUntil(const std::function<bool()>& isDone, std::chrono::milliseconds limit) {
        return EventLoop::runUntil(
            [&] {
                keeper_->tick(clock_.now());
                return isDone();
            },
            limit);
    }
    void expectTraffic(const Pty& pty) {
        received_.clear();
        pty.send({0xF9, 2, 5});
        EXPECT_TRUE(runUntil([&] { return received_.size() == 3; }, 2s));
        keeper_->write(Bytes{0xF0, 0x79, 0xF7});
        EXPECT_THAT(pty.receive(), ElementsAre(0xF0, 0x79, 0xF7));
    }

    EventLoop loop_;
    SteadyClock clock_;
    std::vector<SerialPort> ports_;
    LinkWorld world_;
    int opened_ = 0;
    Bytes received_;
    std::vector<LinkTrouble> lost_;
    std::string link_ = testing::TempDir() + "lumorph_tty_" + std::to_string(::getpid());
    std::optional<LinkKeeper> keeper_;
};

TEST_F(LinkKeeperOnPty, OpensATypedPathAgainWhoseDeviceWasKilled) {
    auto pty = std::make_unique<Pty>();
    std::filesystem::create_symlink(pty->path(), link_);
    make(link_);
    ASSERT_TRUE(keeper_->isOpen());
    for (int round = 1; round <= 3; ++round) {
        expectTraffic(*pty);
        // Dead, and noticed within a second.
        auto next = std::make_unique<Pty>(); // before the old one goes, so that it has another number
        pty->unplug();
        std::filesystem::remove(link_); // at once: its number may become that of a stranger's terminal
        ASSERT_TRUE(runUntil([&] { return !keeper_->isOpen(); }, 1s));
        (void)runUntil([] { return false; }, 300ms); // attempts that fail
        EXPECT_EQ(lost_.size(), static_cast<std::size_t>(round));
        std::filesystem::create_symlink(next->path(), link_);
        ASSERT_TRUE(runUntil([&] { return keeper_->isOpen(); }, 3s));
        pty = std::move(next);
    }
    expectTraffic(*pty);
    EXPECT_EQ(opened_, 4);
    EXPECT_EQ(lost_.size(), 3u);
}

TEST_F(LinkKeeperOnPty, FindsADeviceAgainUnderAnotherName) {
    Pty before;
    Pty after;
    Pty stranger;
    const auto portAt = [](const std::string& path, const std::string& serial) {
        return SerialPort{path, serial, 0x2341, 0x43, "Uno"};
    };
    ports_ = {portAt(before.path(), "S1"), portAt(stranger.path(), "S2")};
    make(before.path());
    ASSERT_TRUE(keeper_->isOpen());
    expectTraffic(before);
    ports_ = {portAt(stranger.path(), "S2")};
    before.unplug();
    ASSERT_TRUE(runUntil([&] { return !keeper_->isOpen(); }, 1s));
    (void)runUntil([] { return false; }, 500ms);
    EXPECT_EQ(lost_.size(), 1u);
    EXPECT_FALSE(keeper_->isOpen());
    ports_.push_back(portAt(after.path(), "S1"));
    ASSERT_TRUE(runUntil([&] { return keeper_->isOpen(); }, 3s));
    expectTraffic(after);
}

} // namespace
} // namespace lumorph
