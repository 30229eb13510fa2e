#include "devices/trackers/tracker_hub.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "devices/trackers/tracker_advice.h"

namespace lumorph {

namespace {

constexpr Microseconds kLately{2'000'000}; ///< so long that what is told of a slow tracker does not flicker

} // namespace

struct TrackerHub::Data {
    /// The stream of one name, and who brings bodies of that name.
    struct Fed {
        std::shared_ptr<PoseStream> stream;
        std::string followed; ///< the source whose poses go to the stream; empty after that was closed
        std::map<std::string, std::optional<Microseconds>> sources; ///< each, and when a pose of it was last left out

        /// Poses of two places in one stream would make the eye jump to and fro: who came first is followed until its
        /// poses are stale. Ages are compared as measured, or two late trackers would take turns.
        void take(const std::string& source, const PoseSample& sample, Microseconds now) {
            std::optional<Microseconds>& leftOut = sources[source];
            if (source == followed) {
                stream->push(sample);
            } else if (sample.valid && (followed.empty() || stream->isStale(sample.time))) {
                if (!stream->restart(sample)) return;
                followed = source;
                leftOut.reset();
            } else if (sample.valid) {
                leftOut = now;
            }
        }
    };
    std::shared_ptr<PoseBoard> board;
    std::shared_ptr<const Clock> clock;
    TrackerOpener opener;

    std::mutex tapping;
    std::map<int, Tap> taps;
    int nextTap = 1;

    mutable std::mutex mutex; ///< never held while a tracker is opened or ended: its thread may be in take()
    RoleMap roles;
    std::map<std::string, Fed, std::less<>> fed; ///< streams that are on the board because of us
    std::map<std::string, std::shared_ptr<Tracker>> trackers;

    Fed& feed(const std::string& name, PoseRole role, const std::string& source) {
        Fed& entry = fed[name];
        if (!entry.stream) entry = {board->stream(name, role), source, {}};
        return entry;
    }

    /// What is left out now of that source, because others are followed under the same names.
    [[nodiscard]] std::optional<SharedName> sharedNow(const std::string& source, Microseconds now) const {
        std::optional<SharedName> shared;
        for (const auto& [name, entry] : fed) {
            const auto found = entry.sources.find(source);
            if (found == entry.sources.end() || !found->second || now - *found->second > kLately) continue;
            if (entry.followed.empty()) continue;
            if (!shared)
                shared = SharedName{name, 0, entry.followed, {}};
            else if (shared->address == entry.followed)
                ++shared->more;
        }
        return shared;
    }

    void forget(const std::string& source) {
        for (auto entry = fed.begin(); entry != fed.end();) {
            auto& [name, streamed] = *entry;
            const bool wasLast = streamed.sources.erase(source) > 0 && streamed.sources.empty();
            if (streamed.followed == source) streamed.followed.clear();
            if (wasLast) board->remove(name);
            entry = wasLast ? fed.erase(entry) : std::next(entry);
        }
    }
};

TrackerHub::TrackerHub(std::shared_ptr<PoseBoard> board, std::shared_ptr<const Clock> clock, TrackerOpener opener)
    : data_(std::make_unique<Data>()) {
    data_->board = std::move(board);
    data_->clock = std::move(clock);
    data_->opener = std::move(opener);
}

TrackerHub::~TrackerHub() {
    std::map<std::string, std::shared_ptr<Tracker>> ending;
    {
        const std::scoped_lock lock(data_->mutex);
        ending.swap(data_->trackers);
    }
    ending.clear();
    for (const auto& [name, fed] : data_->fed) data_->board->remove(name);
}

void TrackerHub::open(const std::string& uri, bool openToNetwork) {
    {
        const std::scoped_lock lock(data_->mutex);
        // Its place is kept while it opens, so that nobody else opens it meanwhile.
        if (!data_->trackers.try_emplace(uri).second)
            throw InvalidInput("tracker " + uri, "it is open already", "close it first, or use another address");
    }
    try {
        TrackerOptions options;
        options.clock = data_->clock;
        options.openToNetwork = openToNetwork;
        options.onFrame = [this, uri](const TrackerFrame& frame) { take(uri, frame); };
        std::shared_ptr<Tracker> tracker = data_->opener(uri, std::move(options));
        const std::scoped_lock lock(data_->mutex);
        data_->trackers[uri] = std::move(tracker);
    } catch (...) {
        const std::scoped_lock lock(data_->mutex);
        data_->trackers.erase(uri);
        throw;
    }
}

void TrackerHub::close(const std::string& uri) {
    std::shared_ptr<Tracker> ending;
    {
        const std::scoped_lock lock(data_->mutex);
        const auto found = data_->trackers.find(uri);
        if (found == data_->trackers.end() || !found->second) return;
        ending = std::move(found->second);
        data_->trackers.erase(found);
    }
    // Whoever asks for its status holds it too, for a moment. It ends here, where there is time to wait for it, and
    // before its port is opened again.
    while (ending.use_count() > 1) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ending.reset();
    const std::scoped_lock lock(data_->mutex);
    data_->forget(uri);
}

void TrackerHub::setRoles(RoleMap roles) {
    const std::scoped_lock lock(data_->mutex);
    std::erase_if(data_->fed, [&](const auto& entry) {
        const auto kept = roles.find(entry.first);
        if (kept == roles.end()) {
            data_->board->remove(entry.first);
            return true;
        }
        (void)data_->board->stream(entry.first, kept->second); // the same stream under its new role
        return false;
    });
    data_->roles = std::move(roles);
}

RoleMap TrackerHub::roles() const {
    const std::scoped_lock lock(data_->mutex);
    return data_->roles;
}

std::vector<TrackerStatus> TrackerHub::status() const {
    std::vector<std::shared_ptr<Tracker>> trackers;
    {
        const std::scoped_lock lock(data_->mutex);
        for (const auto& [uri, tracker] : data_->trackers)
            if (tracker) trackers.push_back(tracker);
    }
    std::vector<TrackerStatus> all;
    all.reserve(trackers.size());
    for (const auto& tracker : trackers) all.push_back(tracker->status());
    const Microseconds now = data_->clock->now();
    const std::scoped_lock lock(data_->mutex);
    for (TrackerStatus& status : all) {
        std::optional<SharedName> shared = data_->sharedNow(status.address, now);
        if (!shared) continue;
        const auto other = std::ranges::find(all, shared->address, &TrackerStatus::address);
        if (other != all.end()) shared->source = other->source;
        status.advice += (status.advice.empty() ? "" : " ") + adviceFor(*shared);
    }
    return all;
}

int TrackerHub::addTap(Tap tap) {
    const std::scoped_lock lock(data_->tapping);
    data_->taps[data_->nextTap] = std::move(tap);
    return data_->nextTap++;
}

void TrackerHub::removeTap(int id) {
    const std::scoped_lock lock(data_->tapping);
    data_->taps.erase(id);
}

void TrackerHub::take(const std::string& source, const TrackerFrame& frame) {
    {
        const std::scoped_lock lock(data_->tapping);
        for (const auto& [id, tap] : data_->taps) tap(source, frame);
    }
    const Microseconds now = data_->clock->now();
    // A time to come would make all that is measured before it come too late.
    const Microseconds measured = std::min(frame.measured, now);
    const std::scoped_lock lock(data_->mutex);
    for (const TrackedBody& body : frame.bodies) {
        const auto role = data_->roles.find(body.name);
        if (role == data_->roles.end()) continue;
        data_->feed(body.name, role->second, source).take(source, {measured, body.valid, body.pose}, now);
    }
}

} // namespace lumorph
