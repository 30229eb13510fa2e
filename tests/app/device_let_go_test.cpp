#include <chrono>
#include <csignal>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "devices/simulator/board_at_port.h"
#include "tests/app/process.h"
#include "tests/devices/event_loop.h"

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;

/// A move that is on its way, with servos that are driven.
struct RunningMove {
    explicit RunningMove(bool json)
        : process(lumorphProgram(), [&] {
              std::vector<std::string> words{"device",  "move", board.address(), "--actuator", "0",
                                             "--level", "32",   "--may-jump"};
              if (json) words.emplace_back("--json");
              return words;
          }()) {}

    BoardAtPort board{"uno"}; ///< nothing but what it is told lets go of its servos
    Process process;
};

TEST(DeviceLetGo, WhateverEndsAMoveServosAreLetGoFirst) {
    struct Row {
        const char* name;
        bool json;
        void (*end)(Process& process);
        int exitCode;
    };
    const Row rows[] = {
        {"it ends by itself", true, [](Process&) {}, 0},
        {"the reader goes", true, [](Process& p) { p.closeReaders(); }, 128 + SIGPIPE},
        {"the reader of text goes", false, [](Process& p) { p.closeReaders(); }, 128 + SIGPIPE},
        {"Ctrl-C", true, [](Process& p) { p.send(SIGINT); }, 1},
        {"terminated", true, [](Process& p) { p.send(SIGTERM); }, 1},
        {"the terminal closes", true, [](Process& p) { p.send(SIGHUP); }, 1},
        {"somebody is impatient", true,
         [](Process& p) {
             p.send(SIGTERM);
             std::this_thread::sleep_for(1ms);
             for (int i = 0; i < 3; ++i) p.send(SIGINT);
         },
         1},
    };
    std::vector<std::unique_ptr<RunningMove>> moves; // all at once: each takes seconds
    for (const Row& row : rows) moves.push_back(std::make_unique<RunningMove>(row.json));
    std::vector<std::jthread> watchers;
    std::vector<Outcome> outcomes(moves.size());
    std::vector<std::size_t> driven(moves.size(), 0);
    for (std::size_t i = 0; i < moves.size(); ++i)
        watchers.emplace_back([&, i] {
            RunningMove& move = *moves[i];
            static_cast<void>(comesTrue([&] { return move.board.driven() > 0; }, 60s));
            driven[i] = move.board.driven();
            rows[i].end(move.process);
            outcomes[i] = move.process.wait(60s);
        });
    watchers.clear();
    for (std::size_t i = 0; i < moves.size(); ++i) {
        SCOPED_TRACE(rows[i].name);
        EXPECT_GT(driven[i], 0U) << outcomes[i].err;
        EXPECT_EQ(outcomes[i].exitCode, rows[i].exitCode) << outcomes[i].err;
        EXPECT_TRUE(comesTrue([&] { return moves[i]->board.driven() == 0; }, 1s))
            << moves[i]->board.driven() << " servos are still driven";
    }
}

TEST(DeviceLetGo, AMonitorWhoseReaderGoesEnds) {
    Process monitor(lumorphProgram(), {"device", "monitor", "sim://tablet"});
    ASSERT_TRUE(comesTrue([&] { return monitor.gatherFor(20ms).out.find("-> F0 79 F7") != std::string::npos; }, 30s));
    monitor.closeReaders();
    EXPECT_EQ(monitor.wait(20s).exitCode, 128 + SIGPIPE);
}

} // namespace
} // namespace lumorph::test
