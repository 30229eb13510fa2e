#include "app/studio/calibration/folder_watch.h"

#include <condition_variable>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include <QCoreApplication>
#include <QMetaObject>

namespace lumorph::studio {

namespace fs = std::filesystem;

namespace {

void mix(std::size_t& print, std::size_t with) { print = (print ^ with) * 1099511628211ULL; }

FolderWatch::Content contentOf(const fs::path& folder) {
    FolderWatch::Content content;
    std::map<std::string, std::size_t> files; // in the order of their names, whatever the disk's is
    std::error_code failed;
    for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
        const std::string name = at->path().filename().string();
        std::error_code gone;
        if (name.starts_with('.') || !at->is_regular_file(gone)) continue;
        std::size_t& print = files[name];
        mix(print, static_cast<std::size_t>(at->file_size(gone)));
        mix(print, static_cast<std::size_t>(at->last_write_time(gone).time_since_epoch().count()));
    }
    for (const auto& [name, print] : files) {
        mix(content.print, std::hash<std::string>{}(name));
        mix(content.print, print);
    }
    content.files = static_cast<int>(files.size());
    return content;
}

/// Empty: it cannot be looked at now.
std::optional<FolderWatch::Contents> contentsOf(const fs::path& folder) {
    FolderWatch::Contents contents;
    std::error_code failed;
    for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
        const std::string name = at->path().filename().string();
        std::error_code gone;
        if (!name.starts_with('.') && at->is_directory(gone)) contents[name] = contentOf(at->path());
    }
    if (failed) return std::nullopt;
    return contents;
}

} // namespace

struct FolderWatch::Shared {
    fs::path folder;
    Told told; ///< of the window's thread
    std::chrono::milliseconds every;
    std::mutex mutex;
    std::condition_variable ended;
    // Guarded by the mutex.
    bool isWanted = true;
    std::optional<Contents> known; ///< at the last accepted call of `told`

    static void look(const std::shared_ptr<Shared>& shared);
    /// In the window's thread.
    void tell(const Contents& now);
};

void FolderWatch::Shared::look(const std::shared_ptr<Shared>& shared) {
    std::optional<Contents> before;
    while (true) {
        std::optional<Contents> now = contentsOf(shared->folder);
        std::unique_lock lock(shared->mutex);
        if (!shared->isWanted) return;
        if (now && !shared->known) shared->known = now;
        if (now && now == before && now != shared->known)
            QMetaObject::invokeMethod(
                QCoreApplication::instance(), [shared, now = *now] { shared->tell(now); }, Qt::QueuedConnection);
        before = std::move(now);
        if (shared->ended.wait_for(lock, shared->every, [&] { return !shared->isWanted; })) return;
    }
}

void FolderWatch::Shared::tell(const Contents& now) {
    Contents changed;
    {
        const std::scoped_lock lock(mutex);
        if (!isWanted) return;
        for (const auto& [name, content] : now)
            if (const auto old = known->find(name); old == known->end() || old->second != content)
                changed[name] = content;
    }
    if (!changed.empty() && !told(changed)) return;
    const std::scoped_lock lock(mutex);
    known = now;
}

FolderWatch::FolderWatch(fs::path folder, Told told, std::chrono::milliseconds every)
    : shared_(std::make_shared<Shared>()) {
    shared_->folder = std::move(folder);
    shared_->told = std::move(told);
    shared_->every = every;
    std::thread([shared = shared_] { Shared::look(shared); }).detach();
}

FolderWatch::~FolderWatch() {
    const std::scoped_lock lock(shared_->mutex);
    shared_->isWanted = false;
    shared_->ended.notify_all();
}

} // namespace lumorph::studio
