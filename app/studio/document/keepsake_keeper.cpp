#include "app/studio/document/keepsake_keeper.h"

#include <exception>
#include <utility>

#include "app/applications/program_start.h"
#include "app/studio/document/path_text.h"

namespace lumorph::studio {

KeepsakeKeeper::KeepsakeKeeper(StudioLoop& loop, Notices& notices) : loop_(loop), notices_(notices) {
    writer_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
    tap_ = loop_.addTap([this](const MatchFrame& frame) { take(frame); });
}

KeepsakeKeeper::~KeepsakeKeeper() { loop_.removeTap(tap_); }

void KeepsakeKeeper::keep(const std::shared_ptr<ShowProgram>& program, const std::filesystem::path& file) {
    const std::scoped_lock lock(mutex_);
    program_ = program;
    file_ = file;
}

void KeepsakeKeeper::take(const MatchFrame& frame) {
    if (!frame.keepsake) return;
    {
        const std::scoped_lock lock(mutex_);
        if (file_.empty() || !frame.program || program_.lock() != frame.program) return;
        waiting_[file_] = frame.keepsake;
    }
    changed_.notify_all();
}

void KeepsakeKeeper::run(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    // Also after the end was asked for, until nothing waits any more.
    while (changed_.wait(lock, stop, [this] { return !waiting_.empty(); })) {
        const auto next = waiting_.extract(waiting_.begin());
        lock.unlock();
        write(next.key(), next.mapped());
        lock.lock();
    }
}

void KeepsakeKeeper::write(const std::filesystem::path& file, const std::function<std::string()>& keepsake) {
    try {
        writeKeepsake(file, keepsake());
    } catch (const std::exception& failure) {
        const Notice notice = noticeOf(failure);
        QMetaObject::invokeMethod(
            this, [this, notice] { notices_.post("project", notice); }, Qt::QueuedConnection);
    }
}

} // namespace lumorph::studio
