#include "devices/transport/link_failsafe.h"

#include <array>
#include <chrono>
#include <functional>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <termios.h>
#include <unistd.h>

#include "devices/simulator/pty.h"

namespace lumorph {
namespace {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;
using Messages = std::vector<Bytes>;
using WallClock = std::chrono::steady_clock;

const Messages kRelease{{0xF7, 0x01}, {0xF7, 0x02, 0x03}};
const Bytes kWritten{0xF7, 0x01, 0xF7, 0x02, 0x03};

Microseconds timeNow() { return SteadyClock{}.now(); }

/// A port, open as a link has it, and the failsafe process at it.
class LinkFailsafeTest : public testing::Test {
protected:
    LinkFailsafeTest() : port_(::open(pty_.path().c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) { start(); }
    ~LinkFailsafeTest() override {
        failsafe_.reset();
        if (port_ >= 0) ::close(port_);
    }
    void start(const std::filesystem::path& program = failsafeProgram()) {
        failsafe_ = std::make_unique<LinkFailsafe>(SharedLink{port_, 0}, program);
    }
    /// What has come at the far end within the time.
    [[nodiscard]] Bytes comesWithin(std::chrono::milliseconds time) const {
        Bytes all;
        for (const auto end = WallClock::now() + time; WallClock::now() < end;) {
            pty_.waitForBytes(20ms);
            const Bytes some = pty_.receive();
            all.insert(all.end(), some.begin(), some.end());
        }
        return all;
    }
    /// Until it has been written so many times; at most ten seconds, for a busy machine.
    [[nodiscard]] Bytes comes(std::size_t atLeast) const {
        Bytes all;
        for (const auto end = WallClock::now() + 10s;
             all.size() < atLeast * kWritten.size() && WallClock::now() < end;) {
            const Bytes some = comesWithin(20ms);
            all.insert(all.end(), some.begin(), some.end());
        }
        return all;
    }
    /// Until it is not written any more.
    void waitForQuiet() const {
        for (int i = 0; i < 50 && !comesWithin(200ms).empty(); ++i) {
        }
    }
    /// How many times the release was written, and nothing else.
    static std::size_t times(const Bytes& bytes) {
        EXPECT_EQ(bytes.size() % kWritten.size(), 0U);
        for (std::size_t i = 0; i < bytes.size(); ++i) EXPECT_EQ(bytes[i], kWritten[i % kWritten.size()]);
        return bytes.size() / kWritten.size();
    }

    Pty pty_;
    int port_;
    std::unique_ptr<LinkFailsafe> failsafe_;
};

TEST_F(LinkFailsafeTest, WritesAgainAndAgainOnceItsProgramHasEnded) {
    ASSERT_TRUE(failsafe_->runs());
    failsafe_->setRelease(kRelease, Microseconds{25'000});
    failsafe_->beat(timeNow());
    failsafe_.reset(); // as at the program's end
    ::close(std::exchange(port_, -1));
    EXPECT_GE(times(comes(4)), 4U);
}

TEST_F(LinkFailsafeTest, WritesNothingWhereNoServoIsUnderPower) {
    failsafe_->setRelease(kRelease, Microseconds{25'000});
    failsafe_->setRelease({}, {});
    failsafe_.reset();
    ::close(std::exchange(port_, -1));
    EXPECT_TRUE(comesWithin(100ms).empty());
}

TEST_F(LinkFailsafeTest, WritesNothingWhileThereAreBeats) {
    failsafe_->setRelease(kRelease, Microseconds{25'000});
    const auto beats = [this] {
        auto longest = 0ms;
        auto last = WallClock::now();
        for (const auto end = last + 1500ms; last < end;) {
            failsafe_->beat(timeNow());
            std::this_thread::sleep_for(20ms);
            longest = std::max(longest, std::chrono::ceil<std::chrono::milliseconds>(WallClock::now() - last));
            last = WallClock::now();
        }
        return longest;
    };
    // A machine that has let this thread wait for most of a second shows nothing.
    bool steady = false;
    for (int i = 0; i < 10 && !steady; ++i) {
        waitForQuiet();
        (void)failsafe_->takeLetGo();
        steady = beats() < 700ms;
    }
    ASSERT_TRUE(steady);
    EXPECT_TRUE(comesWithin(50ms).empty());
    EXPECT_FALSE(failsafe_->takeLetGo());
}

TEST_F(LinkFailsafeTest, AfterASecondWithoutABeatItLetsGoAndSaysSoUntilTheNextBeat) {
    failsafe_->setRelease(kRelease, Microseconds{25'000});
    failsafe_->beat(timeNow());
    const auto begin = WallClock::now();
    Bytes bytes = comes(1);
    EXPECT_GE(WallClock::now() - begin, 950ms);
    EXPECT_TRUE(failsafe_->takeLetGo());
    EXPECT_FALSE(failsafe_->takeLetGo()) << "once";
    const Bytes more = comesWithin(1500ms);
    bytes.insert(bytes.end(), more.begin(), more.end());
    EXPECT_GE(times(bytes), 4U);
    EXPECT_LT(times(bytes), 40U) << "not for ever";
    waitForQuiet();
    failsafe_->beat(timeNow());
    EXPECT_GE(times(comes(4)), 4U) << "and again";
    EXPECT_TRUE(failsafe_->takeLetGo());
}

TEST_F(LinkFailsafeTest, WhatALineDoesNotTakeIsDroppedBeforeIt) {
    const Bytes block(256, 0x55);
    while (::write(port_, block.data(), block.size()) > 0) {
    } // until it takes no more
    failsafe_->setRelease(kRelease, Microseconds{25'000});
    failsafe_.reset();
    std::this_thread::sleep_for(250ms); // nobody reads
    Bytes bytes = comesWithin(1000ms);
    const auto first = std::ranges::search(bytes, kWritten).begin();
    ASSERT_NE(first, bytes.end());
    EXPECT_GE(times({first, bytes.end()}), 3U);
}

TEST_F(LinkFailsafeTest, EndsWithTheDevice) {
    failsafe_->setRelease(kRelease, Microseconds{25'000});
    pty_.unplug();
    const auto begin = WallClock::now();
    while (failsafe_->runs() && WallClock::now() - begin < 5s) {
        std::this_thread::sleep_for(10ms);
        failsafe_->beat(timeNow());
    }
    EXPECT_FALSE(failsafe_->runs());
}

TEST_F(LinkFailsafeTest, KnowsThatItsProgramIsMissing) {
    start("/nowhere/lumorph-servo-failsafe");
    EXPECT_FALSE(failsafe_->runs());
    failsafe_->setRelease(kRelease, Microseconds{25'000}); // and does no harm
    failsafe_->beat(timeNow());
    EXPECT_FALSE(failsafe_->takeLetGo());
}

TEST(LinkFailsafe, HasNothingToDoWithALinkThatCannotBeShared) {
    const LinkFailsafe failsafe({}, failsafeProgram());
    EXPECT_FALSE(failsafe.runs());
}

// Of a HID device whole reports are written, with the number of none.
TEST(LinkFailsafe, FillsUpReports) {
    std::array<int, 2> ends{};
    ASSERT_EQ(::pipe2(ends.data(), O_NONBLOCK | O_CLOEXEC), 0);
    {
        LinkFailsafe failsafe({ends[1], 64}, failsafeProgram());
        failsafe.setRelease({{0x55, 0x55, 0x03}}, Microseconds{25'000});
    }
    ::close(ends[1]);
    Bytes expected(65, 0);
    expected[1] = expected[2] = 0x55;
    expected[3] = 0x03;
    Bytes all;
    std::array<std::uint8_t, 4096> some{};
    for (const auto end = WallClock::now() + 5s; WallClock::now() < end; std::this_thread::sleep_for(10ms)) {
        const ssize_t count = ::read(ends[0], some.data(), some.size());
        if (count == 0) break; // it has closed its end
        if (count > 0) all.insert(all.end(), some.begin(), some.begin() + count);
    }
    ::close(ends[0]);
    ASSERT_GE(all.size(), 4U * 65U);
    ASSERT_EQ(all.size() % 65U, 0U);
    for (std::size_t i = 0; i < all.size(); i += 65)
        EXPECT_EQ(
            Bytes(all.begin() + static_cast<std::ptrdiff_t>(i), all.begin() + static_cast<std::ptrdiff_t>(i + 65)),
            expected);
}

} // namespace
} // namespace lumorph
