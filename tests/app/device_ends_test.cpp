#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "devices/simulator/board_at_port.h"
#include "tests/app/process.h"
#include "tests/devices/event_loop.h"
#include "tests/support/long_tests.h"

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;
using WallClock = std::chrono::steady_clock;

struct BoardRow {
    const char* name;
    const char* controller;
};
constexpr BoardRow kBoards[] = {
    {"uno", "firmata"}, {"tablet", "firmata"}, {"maestro", "maestro"}, {"xarm", "lewansoul"}};

/// A way in which the command line ends, or hangs.
struct CommandEnd {
    const char* name;
    std::vector<int> sent;  ///< 20 ms apart
    bool shortForm = false; ///< on each board, not on one alone: what lets go is the board's own protocol
};
const CommandEnd kCommandEnds[] = {
    {"SIGKILL", {SIGKILL}, true},
    {"hang of 3 s", {SIGSTOP}, true},
    {"Ctrl+C twice", {SIGINT, SIGINT}},
    {"SIGTERM twice", {SIGTERM, SIGTERM}},
    {"SIGHUP twice", {SIGHUP, SIGHUP}},
    {"SIGQUIT", {SIGQUIT}},
    {"SIGQUIT twice", {SIGQUIT, SIGQUIT}},
    {"SIGSEGV", {SIGSEGV}},
    {"SIGABRT", {SIGABRT}},
};

/// A move under way on a board at a port, how it is ended, and what became of its servos.
class CommandEnding {
public:
    CommandEnding(const BoardRow& board, const CommandEnd& how)
        : boardRow_(board), how_(how), name_(std::string(board.name) + ", " + how.name), board_(board.name),
          process_(lumorphProgram(), {"device", "move", board_.address(), "--controller", board.controller,
                                      "--actuator", "0", "--level", "32", "--may-jump", "--is-right"}) {}

    void play() {
        driven_ = comesTrue([this] { return board_.driven() >= 3; }, 60s);
        const WallClock::time_point begin = WallClock::now();
        for (const int signal : how_.sent) {
            process_.send(signal);
            if (how_.sent.size() > 1) std::this_thread::sleep_for(20ms);
        }
        limp_ = comesTrue([this] { return board_.driven() == 0; }, 5s);
        seconds_ = std::chrono::duration<double>(board_.lastDriven() - begin).count();
        if (!hangs()) {
            outcome_ = process_.wait(60s);
            staysLimp_ = !comesTrue([this] { return board_.driven() > 0; }, 300ms);
            return;
        }
        std::this_thread::sleep_until(begin + 3s);
        process_.send(SIGCONT);
        staysLimp_ = !comesTrue([this] { return board_.driven() > 0; }, 1500ms);
        process_.send(SIGTERM);
        outcome_ = process_.wait(60s);
    }
    void check() const {
        SCOPED_TRACE(name_);
        ASSERT_TRUE(driven_) << outcome_.err;
        EXPECT_TRUE(limp_);
        EXPECT_LT(seconds_, limit());
        EXPECT_TRUE(staysLimp_) << "servos were driven again";
        if (!hangs()) return;
        EXPECT_NE(outcome_.err.find("Lumorph itself was stuck for"), std::string::npos) << outcome_.err;
        for (const char* untrue : {"silent", "lost", "restarted", "by itself", "Silence"})
            EXPECT_EQ(outcome_.err.find(untrue), std::string::npos) << outcome_.err;
    }
    /// Once more, alone: where all are played at once, a busy machine may be the one that was late.
    [[nodiscard]] std::unique_ptr<CommandEnding> again() const {
        if (seconds_ < limit()) return nullptr;
        auto ending = std::make_unique<CommandEnding>(boardRow_, how_);
        ending->play();
        return ending;
    }
    void print() const { std::printf("  %-24s %6.3f s\n", name_.c_str(), seconds_); }

private:
    [[nodiscard]] double limit() const { return hangs() ? 2.0 : 1.0; }
    [[nodiscard]] bool hangs() const { return how_.sent.front() == SIGSTOP; }

    const BoardRow& boardRow_;
    const CommandEnd& how_;
    std::string name_;
    BoardAtPort board_;
    Process process_;
    Outcome outcome_;
    bool driven_ = false, limp_ = false, staysLimp_ = false;
    double seconds_ = -1.0; ///< until the last servo was let go
};

// The long form (LUMORPH_SOAK) plays every end on every board.
TEST(DeviceEnds, WhateverEndsOrHaltsTheProgramServosAreLetGo) {
    constexpr rlimit kNoCore{0, 0};
    ::setrlimit(RLIMIT_CORE, &kNoCore);
    std::vector<std::unique_ptr<CommandEnding>> endings;
    const auto playAll = [&endings] {
        std::vector<std::jthread> players;
        for (const auto& ending : endings) players.emplace_back([&ending] { ending->play(); });
        players.clear();
        for (auto& ending : endings) {
            ending->print();
            if (auto again = ending->again()) {
                ending = std::move(again);
                ending->print();
            }
            ending->check();
        }
        endings.clear();
    };
    for (const BoardRow& board : kBoards) {
        for (const CommandEnd& how : kCommandEnds)
            if (how.shortForm || board.name == std::string("uno") || longTests())
                endings.push_back(std::make_unique<CommandEnding>(board, how));
        if (longTests()) playAll();
    }
    playAll();
}

} // namespace
} // namespace lumorph::test
