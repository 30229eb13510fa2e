#include "app/studio/document/file_watch.h"

namespace lumorph::studio {

namespace {

constexpr int kRestMilliseconds = 300;

QString textOf(const std::filesystem::path& path) { return QString::fromStdString(path.string()); }

} // namespace

FileWatch::FileWatch(QObject* parent) : QObject(parent) {
    rest_.setSingleShot(true);
    rest_.setInterval(kRestMilliseconds);
    connect(&rest_, &QTimer::timeout, this, &FileWatch::look);
    connect(&watcher_, &QFileSystemWatcher::fileChanged, &rest_, qOverload<>(&QTimer::start));
    connect(&watcher_, &QFileSystemWatcher::directoryChanged, &rest_, qOverload<>(&QTimer::start));
}

void FileWatch::watch(const std::map<QString, Watched>& files) {
    std::map<QString, Entry> next;
    for (const auto& [place, file] : files) {
        const auto old = files_.find(place);
        if (old != files_.end() && old->second.file.path == file.path && old->second.file.stamp == file.stamp)
            next[place] = std::move(old->second);
        else
            next[place] = {file, file.stamp, file.stamp};
    }
    files_ = std::move(next);
    follow();
    rest_.start(); // it may have changed since it was read
}

void FileWatch::look() {
    bool moving = false;
    const std::map<QString, Entry> before = files_;
    for (auto& [place, entry] : files_) {
        const FileStamp now = stampOf(entry.file.path);
        moving = moving || now != entry.seen;
        entry.seen = now;
    }
    follow();
    if (moving) { // still being written, or just replaced: look again
        rest_.start();
        return;
    }
    for (const auto& [place, entry] : before) {
        const FileStamp now = entry.seen;
        const auto found = files_.find(place); // who is told may watch other files at once
        if (now == entry.told || found == files_.end() || found->second.file.path != entry.file.path) continue;
        found->second.told = now;
        const QString path = textOf(entry.file.path);
        if (now == entry.file.stamp)
            emit restored(place, path);
        else if (now.there)
            emit changed(place, path);
        else
            emit vanished(place, path);
    }
}

void FileWatch::follow() {
    QStringList wanted;
    for (const auto& [place, entry] : files_) {
        wanted << textOf(entry.file.path.parent_path());
        if (entry.seen.there) wanted << textOf(entry.file.path);
    }
    wanted.removeDuplicates();
    wanted.removeAll(QString());
    // All anew: a file that was replaced is another one to the system, and the old watch sees nothing more.
    const QStringList old = watcher_.files() + watcher_.directories();
    if (!old.isEmpty()) watcher_.removePaths(old);
    if (!wanted.isEmpty()) watcher_.addPaths(wanted);
}

} // namespace lumorph::studio
