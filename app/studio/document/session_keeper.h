#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include <QObject>
#include <QString>

#include "app/studio/document/session_folder.h"

namespace lumorph::studio {

/// Keeps the session in a folder of its own, in a thread of its own: what changes is on disk within two seconds,
/// however busy the window is and however long changes go on. One program at a time keeps sessions there; a second one
/// keeps none.
class SessionKeeper : public QObject {
    Q_OBJECT
public:
    /// `snapshot` is asked in the window's thread; empty while there is nothing to keep.
    SessionKeeper(std::filesystem::path folder, std::function<std::optional<SessionState>()> snapshot,
                  QObject* parent = nullptr);
    ~SessionKeeper() override;

    /// Something has changed: the session as it is now will be kept, unless it changes again before.
    void touch();
    /// It is kept now; returns when it is on disk. Throws DeviceError when the disk refuses.
    void keepNow();

signals:
    void failed(const QString& why);

private:
    using Clock = std::chrono::steady_clock;
    enum class Role { undecided, keeper, onlooker }; ///< whether sessions are this program's to keep

    /// With the mutex held; gives the offer's number.
    std::uint64_t offer(SessionState session);
    void run(const std::stop_token& end);
    [[nodiscard]] bool becomeKeeper(std::unique_lock<std::mutex>& lock, const std::stop_token& end);
    [[nodiscard]] std::exception_ptr write(const SessionState& session);

    std::filesystem::path folder_;
    std::function<std::optional<SessionState>()> snapshot_;
    SessionFolder sessions_; ///< the writer's
    int lockFile_ = -1;

    std::mutex mutex_; ///< of what follows; held for moments only
    std::condition_variable_any changed_;
    Role role_ = Role::undecided;
    std::optional<SessionState> waiting_; ///< the newest, not yet written
    Clock::time_point due_;               ///< when it is to be written
    std::uint64_t offered_ = 0;
    std::uint64_t tried_ = 0; ///< the newest that was written, or could not be
    bool hurry_ = false;      ///< somebody waits for it
    std::exception_ptr failure_;

    std::jthread writer_;
};

} // namespace lumorph::studio
