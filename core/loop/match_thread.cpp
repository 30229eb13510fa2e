#include "core/loop/match_thread.h"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/loop/match_loop.h"
#include "core/loop/show_inputs.h"
#include "core/loop/viewer_stage.h"

namespace lumorph {

namespace {

constexpr std::chrono::milliseconds kGlance{100};

void requireRate(double framesPerSecond) {
    if (!(framesPerSecond >= 1.0 && framesPerSecond <= 1000.0))
        throw InvalidInput("frame rate", "it must be 1 to 1000 frames a second", "give a rate in that range");
}

Microseconds periodOf(double framesPerSecond) {
    return Microseconds(static_cast<std::int64_t>(std::lround(1e6 / framesPerSecond)));
}

double secondsOf(Microseconds time) { return 1e-6 * static_cast<double>(time.count()); }

/// Whether something has happened that nobody sent a wish for. A program sees pointers too, and takes inputs.
bool wakes(const MatchWish& wish, Microseconds now) {
    if (wish.program && wish.driver != Driver::recording) {
        if (wish.inputs && !wish.inputs->empty()) return true;
        return wish.poses && std::ranges::any_of(wish.poses->entries(), [&](const PoseBoard::Entry& entry) {
                   return entry.stream->at(now, now).has_value();
               });
    }
    return wish.scene && wish.poses && anyTracked(*wish.poses, now);
}

std::chrono::steady_clock::time_point pointOf(Microseconds time) { return std::chrono::steady_clock::time_point(time); }

} // namespace

struct MatchThread::Data {
    Data(std::function<void()> onFrame, double framesPerSecond)
        : tell(std::move(onFrame)), period(periodOf(framesPerSecond)) {}

    void run(const std::stop_token& stop);
    /// Waits for the next frame's turn and gives its wish, or nothing when the thread is to end.
    std::optional<MatchWish> nextTurn(const std::stop_token& stop);
    /// One frame; false when it failed.
    bool frame(MatchLoop& loop, const MatchWish& wish, double sinceLast);

    const SteadyClock clock;
    const std::function<void()> tell;

    mutable std::mutex mutex; ///< guards what follows
    std::condition_variable_any changed;
    Microseconds period;
    std::optional<MatchWish> newest;
    bool fresh = false;  ///< the newest wish has not been looked at
    bool resting = true; ///< another frame of the last wish would show nothing new
    bool rested = true;  ///< there was a rest before this turn
    bool failed = false; ///< the last wish could not be fulfilled
    bool paused = false; ///< nobody follows the frames
    Microseconds started{0};
    std::shared_ptr<const MatchFrame> latest;
    std::optional<std::string> error;
    std::deque<Microseconds> times; ///< when the frames of the last second were done

    std::jthread thread; ///< last, so that it ends before what it uses
};

std::optional<MatchWish> MatchThread::Data::nextTurn(const std::stop_token& stop) {
    std::unique_lock lock(mutex);
    rested = resting;
    // Trackers do not call: while the loop rests, it looks now and then whether they see somebody again.
    while (!changed.wait_for(lock, stop, kGlance, [&] { return fresh || !resting; })) {
        if (stop.stop_requested()) return std::nullopt;
        if (newest && !failed && !paused && wakes(*newest, clock.now())) break;
    }
    while (!stop.stop_requested() && clock.now() < started + period) {
        const Microseconds before = period;
        changed.wait_until(lock, stop, pointOf(started + period), [&] { return period != before; });
    }
    if (stop.stop_requested()) return std::nullopt;
    fresh = false;
    return newest;
}

void MatchThread::Data::run(const std::stop_token& stop) {
    MatchLoop loop(clock);
    bool first = true;
    while (const std::optional<MatchWish> wish = nextTurn(stop)) {
        const Microseconds now = clock.now();
        // A rest is no time in which anything moved, except servos that were on their way.
        const Microseconds sinceLast = first ? Microseconds{0} : rested ? period : now - started;
        if (!first && rested && now > started + sinceLast) loop.rest(secondsOf(now - started - sinceLast));
        first = false;
        started = now;
        const bool done = frame(loop, *wish, secondsOf(sinceLast));
        const std::scoped_lock lock(mutex);
        failed = !done;
        resting = failed || paused || loop.settled();
    }
}

bool MatchThread::Data::frame(MatchLoop& loop, const MatchWish& wish, double sinceLast) {
    try {
        std::shared_ptr<const MatchFrame> frame = loop.step(wish, sinceLast);
        {
            const std::scoped_lock lock(mutex);
            latest = std::move(frame);
            const Microseconds now = clock.now();
            times.push_back(now);
            while (times.front() <= now - std::chrono::seconds(1)) times.pop_front();
        }
        if (tell) tell();
        return true;
    } catch (const std::exception& failure) {
        const std::scoped_lock lock(mutex);
        error = failure.what();
    } catch (...) {
        const std::scoped_lock lock(mutex);
        error = "The live loop failed for an unknown reason.";
    }
    return false;
}

MatchThread::MatchThread(std::function<void()> onFrame, double framesPerSecond) {
    requireRate(framesPerSecond);
    data_ = std::make_unique<Data>(std::move(onFrame), framesPerSecond);
    data_->thread = std::jthread([data = data_.get()](const std::stop_token& stop) { data->run(stop); });
}

MatchThread::~MatchThread() = default;

void MatchThread::wish(MatchWish wish) {
    std::optional<MatchWish> next(std::move(wish));
    {
        const std::scoped_lock lock(data_->mutex);
        std::swap(data_->newest, next); // the old one is let go outside the lock
        data_->fresh = true;
    }
    data_->changed.notify_all();
}

void MatchThread::setRate(double framesPerSecond) {
    requireRate(framesPerSecond);
    {
        const std::scoped_lock lock(data_->mutex);
        data_->period = periodOf(framesPerSecond);
    }
    data_->changed.notify_all();
}

void MatchThread::setPaused(bool paused) {
    {
        const std::scoped_lock lock(data_->mutex);
        if (std::exchange(data_->paused, paused) == paused) return;
        if (!paused) data_->fresh = data_->newest.has_value();
    }
    data_->changed.notify_all();
}

std::shared_ptr<const MatchFrame> MatchThread::latest() const {
    const std::scoped_lock lock(data_->mutex);
    return data_->latest;
}

double MatchThread::rate() const noexcept {
    const std::scoped_lock lock(data_->mutex);
    if (data_->resting && !data_->fresh) return 0.0;
    const Microseconds start = data_->clock.now() - std::chrono::seconds(1);
    return static_cast<double>(
        std::ranges::count_if(data_->times, [&](const Microseconds& time) { return time > start; }));
}

std::optional<std::string> MatchThread::takeError() {
    const std::scoped_lock lock(data_->mutex);
    return std::exchange(data_->error, std::nullopt);
}

} // namespace lumorph
