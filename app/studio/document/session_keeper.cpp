#include "app/studio/document/session_keeper.h"

#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "core/base/error.h"

namespace lumorph::studio {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kAfterChange{500}; // a drag changes much in that time, and is written once
constexpr std::chrono::seconds kAfterFailure{5};
constexpr std::chrono::seconds kLockWithin{10}; // a program that was killed may still be taking its leave
constexpr std::chrono::milliseconds kLockAgain{100};

} // namespace

SessionKeeper::SessionKeeper(fs::path folder, std::function<std::optional<SessionState>()> snapshot, QObject* parent)
    : QObject(parent), folder_(std::move(folder)), snapshot_(std::move(snapshot)), sessions_(folder_) {
    std::error_code ignored;
    fs::create_directories(folder_, ignored);
    // The system lets go of it when the program ends, however it ends.
    lockFile_ = ::open((folder_ / "lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    writer_ = std::jthread([this](const std::stop_token& end) { run(end); });
}

SessionKeeper::~SessionKeeper() {
    writer_.request_stop();
    writer_.join();
    if (lockFile_ >= 0) ::close(lockFile_);
}

void SessionKeeper::touch() {
    {
        const std::scoped_lock lock(mutex_);
        if (role_ == Role::onlooker) return;
    }
    std::optional<SessionState> session = snapshot_();
    if (!session) return;
    const std::scoped_lock lock(mutex_);
    offer(std::move(*session));
}

std::uint64_t SessionKeeper::offer(SessionState session) {
    if (!waiting_) due_ = Clock::now() + kAfterChange; // not put off by what comes later
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
    changed_.wait(lock, [&] { return tried_ >= mine || role_ == Role::onlooker; });
    hurry_ = false;
    if (role_ == Role::keeper && failure_) std::rethrow_exception(failure_);
}

bool SessionKeeper::becomeKeeper(std::unique_lock<std::mutex>& lock, const std::stop_token& end) {
    const auto until = Clock::now() + kLockWithin;
    bool locked = false;
    while (!locked && !end.stop_requested()) {
        locked = lockFile_ < 0 || ::flock(lockFile_, LOCK_EX | LOCK_NB) == 0; // without a disk, writing will tell
        if (locked || hurry_ || Clock::now() > until) break;
        changed_.wait_for(lock, end, kLockAgain, [this] { return hurry_; });
    }
    role_ = locked ? Role::keeper : Role::onlooker;
    changed_.notify_all();
    return locked;
}

void SessionKeeper::run(const std::stop_token& end) {
    std::unique_lock lock(mutex_);
    if (!becomeKeeper(lock, end)) return;
    while (changed_.wait(lock, end, [this] { return waiting_.has_value(); })) {
        changed_.wait_until(lock, end, due_, [this] { return hurry_; });
        if (end.stop_requested()) return;
        const std::uint64_t number = offered_;
        std::optional<SessionState> session = std::exchange(waiting_, std::nullopt);
        lock.unlock();
        const std::exception_ptr failure = write(*session);
        if (!failure) session.reset(); // it may be large, and nobody shall wait for that
        lock.lock();
        tried_ = number;
        failure_ = failure;
        if (failure && !waiting_) { // there may be space by then
            waiting_ = std::move(session);
            due_ = Clock::now() + kAfterFailure;
        }
        changed_.notify_all();
    }
}

std::exception_ptr SessionKeeper::write(const SessionState& session) {
    try {
        sessions_.write(session);
        return nullptr;
    } catch (const Error& error) {
        const QString why = QString::fromStdString(error.why() + "; " + error.remedy());
        if (!failure_) // once, until it can be kept again
            QMetaObject::invokeMethod(
                this, [this, why] { emit failed(why); }, Qt::QueuedConnection);
        return std::current_exception();
    }
}

} // namespace lumorph::studio
