#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/applications/demo.h"
#include "app/studio/document/project_io.h"

namespace lumorph::studio {

/// The demonstration that is open.
struct OpenDemo {
    std::string name;   ///< of app/applications; empty: what is open is none
    bool plays = false; ///< its program shows
    DemoTold told = {}; ///< what that was told, by the names of its options
    bool operator==(const OpenDemo&) const = default;
};

/// What is needed to go on where a session ended.
struct SessionState {
    ProjectSource source;
    std::filesystem::path file; ///< the project's own file; empty while it has none
    bool modified = false;
    OpenDemo demo; ///< which its program begins anew
};

/// Where a session is kept: a numbered folder with a project in it, the newest complete one counting, so that a kill at
/// any time leaves a whole session. What nobody needs any more is cleared by the program that keeps sessions here:
/// - older sessions, as soon as its own first one is complete, with whatever a program that was killed left unfinished;
/// - files that the session no longer names;
/// - sessions that could not be opened (`broken-N`) beyond the newest three, and after thirty days.
/// For one thread at a time.
class SessionFolder {
public:
    explicit SessionFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Replaces what was kept, whole or not at all; of the assets only those that are others by now are written. Throws
    /// DeviceError when the disk refuses.
    void write(const SessionState& session);

    /// The session that was kept last; empty when there is none. For a job's thread. Throws what `loadProject` throws.
    [[nodiscard]] static std::optional<SessionState> restore(const std::filesystem::path& folder,
                                                             const Progress& progress);
    /// Moves the session that was kept last out of the way and gives its new place.
    static std::filesystem::path moveAside(const std::filesystem::path& folder);

private:
    void writeAnew(const SessionState& session);
    void writeAgain(const SessionState& session);
    void clear(const SessionState& session) const;

    std::filesystem::path folder_;
    int number_ = 0;    ///< of the session that this program keeps; 0: none yet
    StudioState last_;  ///< what was written
    TakenAssets taken_; ///< and what its assets are called there
};

} // namespace lumorph::studio
