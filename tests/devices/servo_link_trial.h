#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <sched.h>

#include <QCoreApplication>
#include <gtest/gtest.h>

#include "devices/controllers/servo_link.h"
#include "devices/simulator/simulated_bench.h"

namespace lumorph {

using namespace std::chrono_literals;

/// Links want an application; it need not run.
inline void needApplication() {
    static int count = 1;
    static char name[] = "servo_link_test";
    static char* names[] = {name, nullptr};
    static const std::unique_ptr<QCoreApplication> application =
        QCoreApplication::instance() ? nullptr : std::make_unique<QCoreApplication>(count, names);
}

inline bool waitFor(const std::function<bool()>& condition, std::chrono::milliseconds atMost = 10s) {
    const auto end = std::chrono::steady_clock::now() + atMost;
    while (std::chrono::steady_clock::now() < end) {
        if (condition()) return true;
        std::this_thread::sleep_for(2ms);
    }
    return condition();
}

inline DeviceProfile tabletProfile(const std::string& board = "tablet", int first = 2) {
    DeviceProfile profile;
    profile.address = "sim://" + board;
    profile.staggerSeconds = 0.02;
    profile.restOnExit = false;
    profile.servos = {{.channel = first}, {.channel = first + 1}, {.channel = first + 2}};
    for (ServoSetup& servo : profile.servos) servo.maxAcceleration = 20.0;
    return profile;
}

/// A link to a board of a bench, and what it said.
class ServoLinkTest : public testing::Test {
protected:
    ServoLinkTest() { needApplication(); }

    void open(const DeviceProfile& profile) {
        profile_ = profile;
        board_ = bench_.board(profile.address.substr(6));
        LinkOptions options;
        options.bench = &bench_;
        options.onWire = [this](std::span<const std::uint8_t> bytes, bool sent) {
            policy_ = ::sched_getscheduler(0);
            if (sent && faultsToCome_ > 0 && --faultsToCome_ >= 0) throw std::runtime_error("out of memory");
            const std::scoped_lock lock(mutex_);
            if (sent) sent_.insert(sent_.end(), bytes.begin(), bytes.end());
        };
        link_ = std::make_unique<ServoLink>(profile, options);
        link_->connect();
    }
    bool reaches(LinkPhase phase) {
        return waitFor([&] { return link_->status().phase == phase; });
    }
    /// Servos stand in the middle at first, and are told to start there.
    void goLive() {
        ASSERT_TRUE(reaches(LinkPhase::disarmed)) << said();
        link_->command(std::vector<double>(3, 0.5));
        link_->arm(true);
        ASSERT_TRUE(reaches(LinkPhase::live)) << said();
    }
    double pulse(std::size_t servo) { return board_->servos().at(servo).pulse; }
    bool allLimp() {
        return std::ranges::all_of(board_->servos(), [](const SimulatedServo& s) { return s.pulse == 0.0; });
    }
    bool arrives(std::size_t servo, double microseconds) {
        return waitFor([&] { return std::abs(board_->servos().at(servo).position - microseconds) < 3.0; });
    }
    template <typename Change> void fault(Change change) {
        BoardFaults faults = board_->faults();
        change(faults);
        board_->setFaults(faults);
    }
    std::string said() {
        for (const LinkEvent& event : link_->takeEvents()) said_ += event.text + " (" + event.remedy + ")\n";
        return said_;
    }
    int times(const std::string& words) {
        int count = 0;
        const std::string all = said();
        for (auto at = all.find(words); at != std::string::npos; at = all.find(words, at + 1)) ++count;
        return count;
    }
    bool hears(const std::string& words) {
        return waitFor([&] { return times(words) > 0; });
    }
    /// What the board itself saw. Threads are woken late on a busy machine, so twice the limit is what cannot be
    /// mistaken; the exact limit is that of the test without threads.
    void expectSoft(double atMostJump = 3.0) {
        for (const SimulatedServo& servo : board_->servos()) {
            EXPECT_LE(servo.fastest, 2.0 * 1000.0);
            EXPECT_LE(servo.largestJump, atMostJump);
            if (servo.pulse == 0.0) continue;
            EXPECT_GE(servo.pulse, 1000.0);
            EXPECT_LE(servo.pulse, 2000.0);
        }
    }

    SimulatedBench bench_;
    DeviceProfile profile_;
    std::shared_ptr<SimulatedBoard> board_;
    std::atomic<int> faultsToCome_ = 0; ///< of what is sent next, as if the link itself failed
    std::atomic<int> policy_ = -1;      ///< of the thread that sends
    std::mutex mutex_;
    std::vector<std::uint8_t> sent_;
    std::unique_ptr<ServoLink> link_;
    std::string said_;
};

} // namespace lumorph
