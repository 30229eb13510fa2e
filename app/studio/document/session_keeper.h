#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <QDateTime>
#include <QObject>
#include <QString>

#include "app/studio/base/folder_lock.h"
#include "app/studio/document/kept_work.h"
#include "app/studio/document/session_folder.h"

namespace lumorph::studio {

/// Keeps the session in a folder, in a thread of its own: what changes is on disk half a second later at the latest,
/// however busy the window is and however long changes go on. Edited work that something else replaces stays there as
/// kept work. One program at a time has a folder; a second one keeps its session in a folder of its own below it,
/// until the first has ended. Made and called in the window's thread.
class SessionKeeper : public QObject {
    Q_OBJECT
public:
    /// `snapshot` is asked in the window's thread; empty while there is nothing to keep. Where another program has the
    /// folder, it is waited for a second: one that was killed may still be ending.
    SessionKeeper(std::filesystem::path folder, std::function<std::optional<SessionState>()> snapshot,
                  QObject* parent = nullptr);
    ~SessionKeeper() override;

    /// Whether the folder is this program's.
    [[nodiscard]] bool first() const;
    /// Where this program's session and its kept work lie.
    [[nodiscard]] std::filesystem::path folder() const;
    /// Since when another program has the folder; empty where none has, or it does not say.
    [[nodiscard]] std::optional<QDateTime> otherSince() const;

    /// Something has changed: the session as it is now will be kept, unless it changes again before.
    void touch();
    /// It is kept now; returns when it is on disk. Throws DeviceError when the disk refuses.
    void keepNow();
    /// The program goes on with the session of this number.
    void setRestored(int number);

    /// Something else takes the place of this session, which becomes kept work. Gives its id.
    std::string replace(SessionState session);
    /// Kept work is open again, and goes as soon as the session that it is now is on disk.
    void release(const std::string& id);
    /// Throws DeviceError where the disk refuses.
    void setThrown(const std::string& id, bool thrown);
    /// The newest first; what was thrown away last.
    [[nodiscard]] std::vector<KeptWork> keptWork() const;

signals:
    void failed(const QString& why);
    void keptWorkChanged();
    /// The program that had the folder has ended, and this one has it now.
    void tookOver();

private:
    using Clock = std::chrono::steady_clock;
    struct Replaced {
        SessionState session;
        std::string id;
    };

    /// With the mutex held; gives the offer's number.
    std::uint64_t offer(SessionState session);
    void run(const std::stop_token& end);
    void work(std::unique_lock<std::mutex>& lock);
    void writeAll(std::deque<Replaced>& replaced, const std::optional<SessionState>& session);
    void report(const std::exception_ptr& failure);
    void takeOver(std::unique_lock<std::mutex>& lock);
    void adoptOthers();
    void finishTakeOver();
    void listKeptWork();

    const std::filesystem::path home_; ///< the folder that all want
    std::function<std::optional<SessionState>()> snapshot_;
    SessionFolder sessions_; ///< the writer's
    FolderLock ownLock_;     ///< of a second program's folder
    bool unlisted_ = false;  ///< the writer's: replaced work was written, and no session after it
    std::optional<std::filesystem::path> leftBehind_; ///< the writer's: what it kept its sessions in before

    mutable std::mutex mutex_; ///< of what follows; held for moments only
    std::condition_variable_any changed_;
    FolderLock lock_;
    std::filesystem::path folder_;
    std::deque<Replaced> replaced_;       ///< to be kept before the session
    std::optional<SessionState> waiting_; ///< the newest, not yet written
    Clock::time_point due_;               ///< when it is to be written
    Clock::duration took_{0};             ///< the last write
    std::uint64_t offered_ = 0;
    std::uint64_t tried_ = 0; ///< the newest that was written, or could not be
    bool hurry_ = false;      ///< somebody waits for it
    int restored_ = 0;
    std::exception_ptr failure_;
    std::vector<std::pair<std::string, std::uint64_t>> released_; ///< and the session that has it
    std::vector<KeptWork> keptWork_;

    std::jthread writer_;
};

} // namespace lumorph::studio
