#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <functional>
#include <limits>
#include <mutex>
#include <numbers>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/loop/match_thread.h"
#include "tests/core/loop/loop_fixture.h"
#include "tests/support/scene_in_room.h"

namespace lumorph {
namespace {

/// Counts frames and waits for conditions on them.
class Frames {
public:
    std::function<void()> counter() {
        return [this] {
            {
                const std::scoped_lock lock(mutex_);
                ++count_;
            }
            changed_.notify_all();
        };
    }
    [[nodiscard]] int count() const {
        const std::scoped_lock lock(mutex_);
        return count_;
    }
    /// False after half a minute.
    bool wait(const std::function<bool()>& holds) {
        std::unique_lock lock(mutex_);
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        while (std::chrono::steady_clock::now() < end) {
            lock.unlock();
            const bool done = holds();
            lock.lock();
            if (done) return true;
            changed_.wait_for(lock, std::chrono::milliseconds(5));
        }
        return false;
    }
    /// Waits as long as frames come.
    bool waitForRest() {
        return wait([this, last = -1, since = std::chrono::steady_clock::now()]() mutable {
            const auto now = std::chrono::steady_clock::now();
            if (count() != last) since = now;
            last = count();
            return now - since > std::chrono::milliseconds(250);
        });
    }

private:
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    int count_ = 0;
};

class MatchThreadTest : public testing::Test {
protected:
    MatchWish held(double stroke) const {
        MatchWish wish = test::wishFor(field_, nullptr);
        wish.strokes.assign(wish.strokes.size(), stroke);
        return wish;
    }

    std::shared_ptr<const MatchField> field_ = test::matchFieldOf(test::cushionRig());
    Frames frames_;
};

TEST_F(MatchThreadTest, TheNewestWishWins) {
    MatchThread thread(frames_.counter(), 20.0);
    EXPECT_EQ(thread.latest(), nullptr);
    for (int k = 0; k <= 100; ++k) thread.wish(held(0.01 * k));
    ASSERT_TRUE(frames_.wait([&] { return thread.latest() && thread.latest()->wantedStrokes[0] == 1.0; }));
    EXPECT_LT(frames_.count(), 50) << "wishes in between are passed over";
}

TEST_F(MatchThreadTest, RestsWhenNothingMovesAndWakesUp) {
    MatchThread thread(frames_.counter(), 250.0);
    thread.wish(held(0.2));
    ASSERT_TRUE(frames_.wait([&] { return thread.rate() > 0.0; }));
    ASSERT_TRUE(frames_.waitForRest());
    const auto rested = thread.latest();
    EXPECT_EQ(rested->estimatedStrokes, rested->wantedStrokes);
    EXPECT_EQ(rested->number, static_cast<std::uint64_t>(frames_.count()));
    EXPECT_EQ(thread.rate(), 0.0);
    EXPECT_EQ(thread.latest(), rested);

    const Microseconds wished = SteadyClock().now();
    thread.wish(held(0.9));
    ASSERT_TRUE(frames_.wait([&] { return thread.latest()->wantedStrokes[0] == 0.9; }));
    const auto woken = thread.latest();
    EXPECT_GT(woken->number, rested->number);
    const double seconds = 1e-6 * static_cast<double>((woken->time - wished).count());
    EXPECT_LE(woken->estimatedStrokes[0], 0.2 + field_->rig.actuators()[0].maxVelocity * (seconds + 1.0 / 250.0))
        << "the rest counts as no time for moving";
    thread.wish(held(0.9));
    ASSERT_TRUE(frames_.waitForRest());
    EXPECT_EQ(thread.latest()->estimatedStrokes[0], 0.9);
}

TEST_F(MatchThreadTest, PausedItMakesOneFrameForAWishAndThenGoesOnWhereItWas) {
    constexpr double kPeriod = 1.0 / 250.0;
    MatchThread thread(frames_.counter(), 1.0 / kPeriod);
    MatchWish wish = test::wishFor(field_, test::movingTarget());
    wish.spin = 0.5;
    thread.wish(wish);
    ASSERT_TRUE(frames_.wait([&] { return frames_.count() > 10; }));
    thread.setPaused(true);
    ASSERT_TRUE(frames_.waitForRest()) << "though the target moves";
    EXPECT_EQ(thread.rate(), 0.0);
    const auto paused = thread.latest();

    thread.wish(wish);
    ASSERT_TRUE(frames_.wait([&] { return thread.latest() != paused; }));
    ASSERT_TRUE(frames_.waitForRest());
    EXPECT_EQ(thread.latest()->number, paused->number + 1);

    const Microseconds resumed = SteadyClock().now();
    thread.setPaused(false);
    ASSERT_TRUE(frames_.wait([&] { return thread.latest()->number > paused->number + 5; })) << "without a wish";
    const auto next = thread.latest();
    const double ran = 1e-6 * static_cast<double>((next->time - resumed).count()) + 3.0 * kPeriod;
    const double turned = std::remainder(next->turned.inRadians() - paused->turned.inRadians(), 2.0 * std::numbers::pi);
    EXPECT_GT(turned, 0.0);
    EXPECT_LE(turned, wish.spin * ran) << "the pause is no time";
}

TEST_F(MatchThreadTest, HeldUpItTakesServosNoFartherThanTheirCommands) {
    constexpr double kPeriod = 1.0 / 200.0;
    MatchThread* running = nullptr;
    std::vector<std::shared_ptr<const MatchFrame>> seen; // by the loop's thread, which is held up once
    std::mutex mutex;
    std::size_t heldAt = 0;
    MatchThread thread(
        [&] {
            const std::scoped_lock lock(mutex);
            if (!running) return;
            seen.push_back(running->latest());
            if (heldAt != 0 || seen.back()->estimatedStrokes[0] < 0.2) return;
            heldAt = seen.size();
            std::this_thread::sleep_for(std::chrono::milliseconds(500));
        },
        1.0 / kPeriod);
    {
        const std::scoped_lock lock(mutex);
        running = &thread;
    }
    thread.wish(held(1.0));
    ASSERT_TRUE(frames_.wait([&] {
        const std::scoped_lock lock(mutex);
        return heldAt > 0 && seen.size() > heldAt + 3;
    }));
    const std::scoped_lock lock(mutex);
    const double velocity = field_->rig.actuators()[0].maxVelocity;
    const MatchFrame &before = *seen[heldAt - 1], &after = *seen[heldAt];
    EXPECT_GT(after.time - before.time, Microseconds{490'000});
    EXPECT_LE(after.estimatedStrokes[0], before.estimatedStrokes[0] + 0.05 * velocity);
    EXPECT_LE(after.commandedStrokes[0], before.commandedStrokes[0] + 0.05 * velocity);
}

TEST_F(MatchThreadTest, KeepsItsRate) {
    MatchThread thread(frames_.counter(), 100.0);
    thread.wish(test::wishFor(field_, test::movingTarget()));
    ASSERT_TRUE(frames_.wait([&] { return frames_.count() >= 40; }));
    const auto first = thread.latest();
    const int count = frames_.count();
    ASSERT_TRUE(frames_.wait([&] { return frames_.count() >= count + 20; }));
    const auto last = thread.latest();
    const double seconds = 1e-6 * static_cast<double>((last->time - first->time).count());
    EXPECT_LE(static_cast<double>(last->number - first->number), 100.0 * seconds + 1.5) << "never faster";
    EXPECT_LE(thread.rate(), 101.0);
    EXPECT_GT(thread.rate(), 0.0);
    EXPECT_THROW(thread.setRate(0.0), InvalidInput);
    EXPECT_THROW(thread.setRate(std::numeric_limits<double>::quiet_NaN()), InvalidInput);
    EXPECT_THROW(MatchThread({}, -1.0), InvalidInput);
}

TEST_F(MatchThreadTest, AnErrorComesOutOnceAndTheNextWishRecovers) {
    MatchThread thread(frames_.counter(), 250.0);
    MatchWish wrong = held(0.5);
    wrong.strokes.pop_back();
    thread.wish(wrong);
    std::optional<std::string> error;
    ASSERT_TRUE(frames_.wait([&] {
        if (!error) error = thread.takeError();
        return error.has_value();
    }));
    EXPECT_NE(error->find("2 for 3 actuators"), std::string::npos) << *error;
    EXPECT_EQ(thread.takeError(), std::nullopt);
    EXPECT_EQ(thread.latest(), nullptr);
    thread.wish(held(0.5));
    ASSERT_TRUE(frames_.wait([&] { return thread.latest() && thread.latest()->wantedStrokes[0] == 0.5; }));
    EXPECT_EQ(thread.takeError(), std::nullopt);
}

TEST_F(MatchThreadTest, AnErrorOfTheListenerDoesNotEndTheThread) {
    int calls = 0;
    MatchThread thread(
        [&] {
            if (++calls == 1) throw DeviceError("window", "it is gone", "open it again");
        },
        250.0);
    thread.wish(held(0.5));
    std::optional<std::string> error;
    ASSERT_TRUE(frames_.wait([&] {
        if (!error) error = thread.takeError();
        return error.has_value();
    }));
    EXPECT_EQ(*error, "window: it is gone; open it again");
    thread.wish(held(0.4));
    EXPECT_TRUE(frames_.wait([&] { return thread.latest() && thread.latest()->wantedStrokes[0] == 0.4; }));
}

TEST_F(MatchThreadTest, TwoThousandFramesKeepNothing) {
    const auto target = test::movingTarget();
    {
        MatchThread thread(frames_.counter(), 1000.0);
        std::weak_ptr<const MatchFrame> early;
        MatchWish wish = test::wishFor(field_, target);
        wish.budget = Microseconds{200};
        thread.wish(wish);
        ASSERT_TRUE(frames_.wait([&] { return thread.latest() != nullptr; }));
        early = thread.latest();
        ASSERT_TRUE(frames_.wait([&] { return frames_.count() >= 2000; }));
        EXPECT_TRUE(early.expired()) << "a frame lives no longer than someone looks at it";
        EXPECT_LT(target.use_count(), 12);
    }
    EXPECT_EQ(target.use_count(), 1);
    EXPECT_EQ(field_.use_count(), 1);
}

// R25: a tracker does not call the loop, which follows it all the same.
TEST_F(MatchThreadTest, RunsWhileAHeadIsTrackedAndWakesWhenOneComes) {
    MatchWish wish = held(0.0);
    SceneInRoom scene;
    scene.predictionSeconds = 0.0;
    setSceneInRoom(wish, scene);
    wish.assets = std::make_shared<const SceneAssets>();
    const auto board = std::make_shared<PoseBoard>();
    wish.poses = board;
    const auto head = board->stream("Ada", PoseRole::head);
    const auto push = [&](double x) { return head->push({SteadyClock().now(), true, {{x, 0.5, 0.5}, {1, 0, 0, 0}}}); };
    MatchThread thread(frames_.counter(), 100.0);
    thread.wish(wish);
    ASSERT_TRUE(frames_.wait([&] { return thread.latest() != nullptr; }));
    ASSERT_TRUE(frames_.waitForRest());
    EXPECT_FALSE(thread.latest()->eye);

    for (const double x : {0.1, 0.4}) {
        const int before = frames_.count();
        ASSERT_TRUE(frames_.wait([&] {
            (void)push(x);
            return frames_.count() > before + 20;
        })) << "frames come without a wish";
        ASSERT_TRUE(thread.latest()->eye);
        EXPECT_NEAR(thread.latest()->eye->x, x, 0.02);
        ASSERT_TRUE(frames_.waitForRest()) << "and end when the tracker does";
        EXPECT_FALSE(thread.latest()->eye) << "the last of them says that nobody is there";
        EXPECT_EQ(thread.rate(), 0.0);
    }
}

} // namespace
} // namespace lumorph
