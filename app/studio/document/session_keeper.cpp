#include "app/studio/document/session_keeper.h"

#include <algorithm>
#include <system_error>

#include "core/base/error.h"

namespace lumorph::studio {

namespace {

namespace fs = std::filesystem;

// A drag changes much in that time, and is written once.
constexpr std::chrono::milliseconds kAfterChange{100};
// An edit is on disk after that, as long as one write takes less than half of it.
constexpr std::chrono::milliseconds kAtLatest{400};
constexpr std::chrono::seconds kAfterFailure{5};
constexpr std::chrono::seconds kPatience{1}; // a program that was killed may still be ending
constexpr std::chrono::milliseconds kLockAgain{250};
constexpr const char* kLock = "lock";
constexpr const char* kSecond = "second-";
constexpr int kMostSeconds = 100;

fs::path secondFolder(const fs::path& home, int number) { return home / (kSecond + std::to_string(number)); }

} // namespace

SessionKeeper::SessionKeeper(fs::path folder, std::function<std::optional<SessionState>()> snapshot, QObject* parent)
    : QObject(parent), home_(std::move(folder)), snapshot_(std::move(snapshot)), sessions_(home_), ownLock_(home_),
      lock_(home_ / kLock), folder_(home_) {
    bool locked = lock_.tryLockFor(kPatience);
    for (int number = 1; !locked && number <= kMostSeconds; ++number) {
        FolderLock own(secondFolder(home_, number) / kLock);
        if (!own.tryLock()) continue;
        ownLock_ = std::move(own);
        folder_ = secondFolder(home_, number);
        sessions_ = SessionFolder(folder_);
        locked = true;
    }
    writer_ = std::jthread([this](const std::stop_token& end) { run(end); });
}

SessionKeeper::~SessionKeeper() {
    writer_.request_stop();
    writer_.join();
}

bool SessionKeeper::first() const {
    const std::scoped_lock lock(mutex_);
    return lock_.held();
}

fs::path SessionKeeper::folder() const {
    const std::scoped_lock lock(mutex_);
    return folder_;
}

std::optional<QDateTime> SessionKeeper::otherSince() const {
    const std::scoped_lock lock(mutex_);
    return lock_.held() ? std::nullopt : lock_.since();
}

void SessionKeeper::touch() {
    std::optional<SessionState> session = snapshot_();
    if (!session) return;
    const std::scoped_lock lock(mutex_);
    offer(std::move(*session));
}

std::uint64_t SessionKeeper::offer(SessionState session) {
    // Not put off by what comes later. What takes long to write, such as a large rig, is written less often.
    if (!waiting_) due_ = Clock::now() + std::max<Clock::duration>(kAfterChange, std::min(took_, kAtLatest - took_));
    waiting_ = std::move(session);
    changed_.notify_all();
    return ++offered_;
}

void SessionKeeper::keepNow() {
    std::optional<SessionState> session = snapshot_();
    if (!session) return;
    std::unique_lock lock(mutex_);
    const std::uint64_t mine = offer(std::move(*session));
    hurry_ = true;
    changed_.notify_all();
    changed_.wait(lock, [&] { return tried_ >= mine; });
    hurry_ = false;
    if (failure_) std::rethrow_exception(failure_);
}

void SessionKeeper::setRestored(int number) {
    const std::scoped_lock lock(mutex_);
    restored_ = number;
}

std::string SessionKeeper::replace(SessionState session) {
    const std::scoped_lock lock(mutex_);
    std::string id = newKeptWorkId();
    // What waited to be written is part of it, and something else will be offered soon.
    waiting_.reset();
    replaced_.push_back({std::move(session), id});
    due_ = Clock::now();
    changed_.notify_all();
    return id;
}

void SessionKeeper::release(const std::string& id) {
    const std::scoped_lock lock(mutex_);
    released_.emplace_back(id, offered_);
}

void SessionKeeper::setThrown(const std::string& id, bool thrown) {
    {
        const std::scoped_lock lock(mutex_);
        studio::setThrown(folder_, id, thrown);
        keptWork_ = keptWorkIn(folder_);
    }
    emit keptWorkChanged();
}

std::vector<KeptWork> SessionKeeper::keptWork() const {
    const std::scoped_lock lock(mutex_);
    return keptWork_;
}

void SessionKeeper::run(const std::stop_token& end) {
    if (first()) adoptOthers();
    clearThrownWork(folder());
    listKeptWork();
    std::unique_lock lock(mutex_);
    const auto asked = [this] { return waiting_ || !replaced_.empty(); };
    while (!end.stop_requested()) {
        if (lock_.held()) {
            changed_.wait(lock, end, asked);
        } else {
            changed_.wait_for(lock, end, kLockAgain, asked);
            takeOver(lock);
        }
        if (end.stop_requested() || !asked()) continue;
        changed_.wait_until(lock, end, due_, [this] { return hurry_; });
        if (!end.stop_requested()) work(lock);
    }
    if (!replaced_.empty()) work(lock); // the session itself is kept by keepNow
}

/// One turn of the writer: work that was replaced, then the session. The lock is released meanwhile.
void SessionKeeper::work(std::unique_lock<std::mutex>& lock) {
    const std::uint64_t number = offered_;
    std::deque<Replaced> replaced = std::exchange(replaced_, {});
    std::optional<SessionState> session = std::exchange(waiting_, std::nullopt);
    sessions_.setRestored(restored_);
    // What was replaced counts as kept when the next session is complete; the first may find what others have left.
    unlisted_ = unlisted_ || !replaced.empty();
    bool listed = unlisted_ || failure_ || tried_ == 0;
    const bool completes = session.has_value();
    lock.unlock();
    const Clock::time_point begun = Clock::now();
    std::exception_ptr failure;
    try {
        writeAll(replaced, session);
        session.reset(); // it may be large, and nobody shall wait for that
        if (leftBehind_) {
            finishTakeOver();
            listed = true;
        }
    } catch (const Error&) {
        failure = std::current_exception();
        report(failure);
    }
    lock.lock();
    tried_ = number;
    took_ = Clock::now() - begun;
    failure_ = failure;
    if (failure) { // there may be space by then
        std::ranges::move(replaced_, std::back_inserter(replaced));
        replaced_ = std::move(replaced);
        if (!waiting_) waiting_ = std::move(session);
        due_ = Clock::now() + kAfterFailure;
    } else {
        unlisted_ = unlisted_ && !completes;
        std::erase_if(released_, [&](const auto& one) {
            if (one.second > number) return false;
            removeKeptWork(folder_, one.first);
            return listed = true;
        });
    }
    changed_.notify_all();
    lock.unlock();
    if (listed) listKeptWork();
    lock.lock();
}

void SessionKeeper::writeAll(std::deque<Replaced>& replaced, const std::optional<SessionState>& session) {
    while (!replaced.empty()) {
        sessions_.writeReplaced(replaced.front().session, replaced.front().id);
        replaced.pop_front();
    }
    if (session) sessions_.write(*session);
}

void SessionKeeper::report(const std::exception_ptr& failure) {
    if (failure_) return; // once, until it can be kept again
    try {
        std::rethrow_exception(failure);
    } catch (const Error& error) {
        const QString why = QString::fromStdString(error.why() + "; " + error.remedy());
        QMetaObject::invokeMethod(
            this, [this, why] { emit failed(why); }, Qt::QueuedConnection);
    }
}

/// The session lies in the other folder until it is complete in this one.
void SessionKeeper::takeOver(std::unique_lock<std::mutex>& lock) {
    if (!lock_.tryLock()) return;
    leftBehind_ = std::exchange(folder_, home_);
    sessions_ = SessionFolder(home_);
    restored_ = 0;
    lock.unlock();
    adoptOthers();
    listKeptWork();
    QMetaObject::invokeMethod(
        this,
        [this] {
            touch();
            emit tookOver();
        },
        Qt::QueuedConnection);
    lock.lock();
}

/// What second programs have left, and what they keep now where this is one of them.
void SessionKeeper::adoptOthers() {
    for (int number = 1; number <= kMostSeconds; ++number) {
        const fs::path folder = secondFolder(home_, number);
        std::error_code ignored;
        if (!fs::exists(folder, ignored) || folder == leftBehind_) continue;
        FolderLock other(folder / kLock);
        if (!other.tryLock()) continue;
        try {
            SessionFolder::adopt(folder, home_, SessionFolder::Adopted::edited);
            fs::remove_all(folder, ignored);
        } catch (const Error&) { // it stays, for the next time
            report(std::current_exception());
        }
    }
}

/// The session is complete in the folder that this program has now.
void SessionKeeper::finishTakeOver() {
    SessionFolder::adopt(*leftBehind_, home_, SessionFolder::Adopted::none);
    std::error_code ignored;
    fs::remove_all(*leftBehind_, ignored);
    leftBehind_.reset();
    ownLock_.release();
}

void SessionKeeper::listKeptWork() {
    std::vector<KeptWork> all = keptWorkIn(folder());
    {
        const std::scoped_lock lock(mutex_);
        if (all == keptWork_) return;
        keptWork_ = std::move(all);
    }
    QMetaObject::invokeMethod(
        this, [this] { emit keptWorkChanged(); }, Qt::QueuedConnection);
}

} // namespace lumorph::studio
