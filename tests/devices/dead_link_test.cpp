// What a link that is dead or stands still costs, and what is left of it when it goes on: bytes, time, words.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "devices/controllers/servo_link.h"
#include "devices/simulator/pty.h"
#include "devices/simulator/simulated_bench.h"
#include "tests/core/temporary_folder.h"
#include "tests/devices/event_loop.h"

namespace lumorph {
namespace {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kDeadLinkServos = 3;
constexpr double kShareOfACore = 0.05;

std::atomic<int> g_qtWords{0};
void countQtWord(QtMsgType, const QMessageLogContext&, const QString&) { ++g_qtWords; }

double secondsOf(const rusage& usage) {
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Processor time of all threads but this one, seconds.
double timeOfOthers() {
    rusage all{};
    rusage own{};
    ::getrusage(RUSAGE_SELF, &all);
    ::getrusage(RUSAGE_THREAD, &own);
    return secondsOf(all) - secondsOf(own);
}

/// A simulated tablet at the far end of a pseudo-terminal or of a simulated link, and a link to it.
class ServoLinkDead : public testing::Test {
protected:
    void open(const std::string& address, ControllerKind controller = ControllerKind::firmata, int first = 2) {
        DeviceProfile profile;
        profile.controller = controller;
        profile.address = address;
        if (address.starts_with("sim://")) board_ = bench_.board(address.substr(6));
        profile.staggerSeconds = 0.0;
        profile.restOnExit = false;
        for (std::size_t i = 0; i < kDeadLinkServos; ++i)
            profile.servos.push_back({.channel = first + static_cast<int>(i)});
        LinkOptions options;
        options.bench = &bench_;
        options.onWire = [this](std::span<const std::uint8_t> bytes, bool sent) {
            if (sent) sent_ += bytes.size();
        };
        options.onChange = [this] { ++changes_; };
        link_ = std::make_unique<ServoLink>(profile, options);
        link_->connect();
    }
    /// Carries bytes between pseudo-terminal and board, if they are not held up.
    void pump() {
        if (!pty_ || stands_) return;
        if (const Bytes bytes = pty_->receive(); !bytes.empty()) board_->take(bytes, bench_.now());
        if (const Bytes bytes = board_->give(bench_.now()); !bytes.empty()) pty_->send(bytes);
    }
    template <typename Condition> bool runUntil(Condition isDone, std::chrono::milliseconds limit) {
        const auto end = std::chrono::steady_clock::now() + limit;
        while (!isDone()) {
            if (std::chrono::steady_clock::now() > end) return false;
            pump();
            std::this_thread::sleep_for(2ms);
        }
        return true;
    }
    bool reaches(LinkPhase phase, std::chrono::milliseconds limit = 10s) {
        return runUntil([&] { return link_->status().phase == phase; }, limit);
    }
    void goLive() {
        ASSERT_TRUE(reaches(LinkPhase::disarmed));
        link_->command(std::vector<double>(kDeadLinkServos, 0.5));
        link_->arm(true);
        ASSERT_TRUE(reaches(LinkPhase::live));
    }
    /// A new wish every few milliseconds, and the last one is told.
    void command(std::chrono::milliseconds time, double last) {
        const auto begin = std::chrono::steady_clock::now();
        (void)runUntil(
            [&] {
                const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
                link_->command(std::vector<double>(kDeadLinkServos, 0.5 + 0.4 * std::sin(9.0 * passed.count())));
                return passed > time;
            },
            time * 2);
        link_->command(std::vector<double>(kDeadLinkServos, last));
    }
    void stall(bool isSo) {
        BoardFaults faults = board_->faults();
        faults.stalled = isSo;
        board_->setFaults(faults);
    }
    bool standsAt(double stroke) {
        return runUntil(
            [&] {
                const std::vector<SimulatedServo> servos = board_->servos();
                return std::ranges::all_of(std::span(servos).first(kDeadLinkServos),
                                           [stroke](const SimulatedServo& servo) {
                                               return std::abs(servo.pulse - (1000.0 + 1000.0 * stroke)) < 1.5;
                                           });
            },
            10s);
    }

    EventLoop loop_; // the link's thread needs a program of Qt
    SimulatedBench bench_;
    std::shared_ptr<SimulatedBoard> board_ = bench_.board("tablet");
    std::unique_ptr<Pty> pty_;
    bool stands_ = false;
    std::atomic<std::size_t> sent_{0};
    std::atomic<int> changes_{0};
    std::unique_ptr<ServoLink> link_;
};

TEST_F(ServoLinkDead, ADeadPseudoTerminalCostsNoTimeAndFewWords) {
    pty_ = std::make_unique<Pty>();
    // By a name of its own: the system gives the number of a dead terminal to whoever asks next.
    const TemporaryFolder folder;
    const std::filesystem::path name = folder / "port";
    std::filesystem::create_symlink(pty_->path(), name);
    open("serial://" + name.string());
    goLive();
    (void)link_->takeEvents();
    g_qtWords = 0;
    const auto before = qInstallMessageHandler(countQtWord);
    std::filesystem::remove(name);
    pty_->unplug();
    pty_.reset();
    ASSERT_TRUE(reaches(LinkPhase::lost, 1s)) << "noticed within a second";
    changes_ = 0;
    const double begin = timeOfOthers();
    const auto commanded = [this, on = 0.0]() mutable {
        link_->command(std::vector<double>(kDeadLinkServos, on = 1.0 - on));
        return false;
    };
    (void)runUntil(commanded, 2s);
    const double share = (timeOfOthers() - begin) / 2.0;
    qInstallMessageHandler(before);
    const std::vector<LinkEvent> events = link_->takeEvents();
    std::printf("a dead port: %.2f %% of a core, %zu events, %d words of Qt, %d changes told a second\n", 100.0 * share,
                events.size(), g_qtWords.load(), changes_.load() / 2);
    EXPECT_LT(share, kShareOfACore);
    EXPECT_EQ(g_qtWords.load(), 0);
    EXPECT_LE(changes_.load(), 2 * 35);
    ASSERT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].text.find("The link is lost: there is no port"), 0U) << events[0].text;
    EXPECT_NE(events[0].remedy.find("plug the device in"), std::string::npos) << events[0].remedy;
    EXPECT_EQ(link_->status().phase, LinkPhase::lost);
}

TEST_F(ServoLinkDead, AWrongBaudRateIsNamedWithOthersToTry) {
    pty_ = std::make_unique<Pty>();
    stands_ = true; // what is not understood is not answered
    open("serial://" + pty_->path() + "?baud=38400");
    std::vector<LinkEvent> events;
    const auto isNamed = [&] {
        for (LinkEvent& event : link_->takeEvents()) events.push_back(std::move(event));
        return std::ranges::any_of(events, [](const LinkEvent& event) {
            return event.text.find("no answer at 38400 baud") != std::string::npos &&
                   event.remedy.find("try 57600 baud (StandardFirmata), 115200") != std::string::npos;
        });
    };
    EXPECT_TRUE(runUntil(isNamed, 20s));
    EXPECT_LE(events.size(), 2U);
}

// Its battery fails: its servos are limp, and nothing starts them again by itself, whatever board it is.
TEST_F(ServoLinkDead, ABrownOutIsToldByEveryBoard) {
    struct Row {
        const char* address;
        ControllerKind controller;
        int first;
        const char* words;
    };
    for (const Row& row : {Row{"sim://tablet", ControllerKind::firmata, 2, "The board has restarted"},
                           Row{"sim://uno", ControllerKind::firmata, 2, "The board has restarted"},
                           Row{"sim://maestro", ControllerKind::maestro, 0, "The board has restarted"},
                           Row{"sim://xarm", ControllerKind::lewansoul, 1, "The link is lost: the simulated device"}}) {
        open(row.address, row.controller, row.first);
        goLive();
        (void)link_->takeEvents();
        board_->reboot();
        std::string said;
        EXPECT_TRUE(runUntil(
            [&] {
                for (const LinkEvent& event : link_->takeEvents()) said += event.text + "\n";
                return said.find(row.words) != std::string::npos;
            },
            10s))
            << row.address << " said " << said;
        link_->command(std::vector<double>(kDeadLinkServos, 0.9));
        EXPECT_TRUE(reaches(LinkPhase::disarmed)) << row.address;
        (void)runUntil([] { return false; }, 300ms);
        for (const SimulatedServo& servo : board_->servos()) EXPECT_EQ(servo.pulse, 0.0) << row.address;
    }
}

TEST_F(ServoLinkDead, AStandstillOfFiveSecondsQueuesNothingAndTheNewestCommandComesOut) {
    open("sim://tablet");
    goLive();
    stall(true);
    const std::size_t before = sent_;
    command(5s, 0.9);
    const std::size_t queued = sent_ - before;
    stall(false);
    // Within the second after which servos count as lost there is no going on by itself.
    ASSERT_TRUE(reaches(LinkPhase::disarmed));
    link_->arm(true);
    ASSERT_TRUE(standsAt(0.9));
    std::printf("stalled for 5 s: %zu bytes queued\n", queued);
    EXPECT_LT(queued, 1000U) << "500 commands of 9 bytes were wished for";
    for (const SimulatedServo& servo : board_->servos()) EXPECT_LE(servo.fastest, 2.0 * 1000.0);
}

TEST_F(ServoLinkDead, AShortStandstillEndsWithTheNewestCommand) {
    open("sim://uno"); // which has no watchdog of its own
    goLive();
    ASSERT_TRUE(standsAt(0.5));
    stall(true);
    const std::size_t before = sent_;
    command(400ms, 0.2);
    const std::size_t queued = sent_ - before;
    stall(false);
    ASSERT_TRUE(standsAt(0.2));
    std::printf("stalled for 0.4 s: %zu bytes queued\n", queued);
    EXPECT_LT(queued, 300U) << "128 bytes, and a set and its questions";
    EXPECT_EQ(link_->status().reconnects, 0U);
}

TEST_F(ServoLinkDead, APseudoTerminalThatNobodyReadsHoldsLittle) {
    pty_ = std::make_unique<Pty>();
    open("serial://" + pty_->path());
    goLive();
    stands_ = true;
    command(5s, 0.9);
    const std::size_t held = pty_->receive().size();
    std::printf("nobody read for 5 s: %zu bytes waited\n", held);
    EXPECT_LT(held, 2500U) << "a second of commands, and what lets servos go";
    stands_ = false;
    ASSERT_TRUE(reaches(LinkPhase::disarmed));
    for (const SimulatedServo& servo : board_->servos()) EXPECT_EQ(servo.pulse, 0.0) << "nothing starts by itself";
    link_->arm(true);
    EXPECT_TRUE(standsAt(0.9));
}

} // namespace
} // namespace lumorph
