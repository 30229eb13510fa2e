#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include <QLockFile>
#include <QObject>
#include <QString>
#include <QTimer>

#include "app/studio/document/project_io.h"

namespace lumorph::studio {

/// What is needed to go on where a session ended.
struct SessionState {
    ProjectSource source;
    std::filesystem::path file; ///< the project's own file; empty while it has none
    bool modified = false;
};

/// Keeps the session in a folder of its own as numbered projects, the newest complete one counting: a kill at any time
/// leaves the one before. One program at a time keeps sessions there; a second one keeps none.
class SessionKeeper : public QObject {
    Q_OBJECT
public:
    /// `snapshot` is asked in the window's thread; empty while there is nothing to keep.
    SessionKeeper(std::filesystem::path folder, std::function<std::optional<SessionState>()> snapshot,
                  QObject* parent = nullptr);

    /// It is kept some seconds from now.
    void touch();
    /// It is kept now; returns when it is on disk. Throws DeviceError when the disk refuses.
    void keepNow();

    /// The session that was kept last; empty when there is none. For a job's thread. Throws what `loadProject` throws.
    [[nodiscard]] static std::optional<SessionState> restore(const std::filesystem::path& folder,
                                                             const Progress& progress);
    /// Moves the session that was kept last out of the way and gives its new place.
    static std::filesystem::path moveAside(const std::filesystem::path& folder);

    /// What was kept last by this program.
    struct Written {
        int number = 0;
        StudioState assets;
    };

signals:
    void failed(const QString& why);

private:
    void keepBeside();

    std::filesystem::path folder_;
    std::function<std::optional<SessionState>()> snapshot_;
    std::unique_ptr<QLockFile> lock_;
    QTimer soon_;
    Written written_; ///< the writer's while it writes
    std::atomic<bool> writing_ = false;
    std::jthread writer_;
};

} // namespace lumorph::studio
