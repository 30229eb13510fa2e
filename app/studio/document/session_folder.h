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
    OpenDemo demo;        ///< which its program begins anew
    std::string lastEdit; ///< the newest step of undo, for the list of kept work; empty: none
    int edits = 0;        ///< steps of undo
};

/// A session as it was read.
struct RestoredSession {
    SessionState session;
    int number = 0; ///< of its folder; 0: it is not a session of its folder but kept work
};

/// Where a session is kept: a numbered folder with a project in it, the newest complete one counting, so that a kill at
/// any time leaves a whole session. Edited work that something else replaces stays, as kept work (`kept_work.h`). What
/// nobody needs any more is cleared by the program that keeps sessions here:
/// - older sessions, as soon as its own first one is complete, with whatever a program that was killed left unfinished;
/// - files that the session no longer names;
/// - sessions that could not be opened (`broken-N`) beyond the newest three, and after thirty days.
/// For one thread at a time.
class SessionFolder {
public:
    explicit SessionFolder(std::filesystem::path folder);

    /// Replaces what was kept, whole or not at all; of the assets only those that are others by now are written. Throws
    /// DeviceError when the disk refuses.
    void write(const SessionState& session);
    /// Keeps a session that another will take the place of by the next `write`: it then becomes kept work of this id.
    /// Takes no more space on the disk than the session did. Throws as `write`.
    void writeReplaced(const SessionState& session, const std::string& id);
    /// The program goes on with the session of this number, which need not become kept work.
    void setRestored(int number) { restored_ = number; }

    /// The session that was kept last; empty when there is none. Files whose originals have gone are copied below
    /// `copies`, a folder of sessions. For a job's thread. Throws what `loadProject` throws.
    [[nodiscard]] static std::optional<RestoredSession>
    restore(const std::filesystem::path& folder, const std::filesystem::path& copies, const Progress& progress);
    /// The same of one folder with a project in it, such as kept work.
    [[nodiscard]] static RestoredSession restoreFrom(const std::filesystem::path& place,
                                                     const std::filesystem::path& copies, const Progress& progress);
    /// Whether there is one.
    [[nodiscard]] static bool hasSession(const std::filesystem::path& folder);
    /// Moves the session that was kept last out of the way and gives its new place.
    static std::filesystem::path moveAside(const std::filesystem::path& folder);
    /// Which session of a folder is adopted.
    enum class Adopted { edited, none };
    /// Moves the kept work of `from` to `to`, and with it the session that was kept last, where that was edited.
    static void adopt(const std::filesystem::path& from, const std::filesystem::path& to, Adopted session);

private:
    void write(const SessionState& session, const std::string& replacedAs);
    void writeAnew(const SessionState& session, const std::string& replacedAs);
    void writeAgain(const SessionState& session, const std::string& replacedAs);
    void clear(const SessionState& session) const;

    std::filesystem::path folder_;
    int number_ = 0;        ///< of the session that this program keeps; 0: none yet
    int found_ = 0;         ///< the newest that was there before it
    int restored_ = 0;      ///< the one that it went on with
    bool replaced_ = false; ///< the next session gets a number of its own
    bool cleared_ = true;   ///< of what the session took the place of
    StudioState last_;      ///< what was written
    TakenAssets taken_;     ///< and what its assets are called there
};

} // namespace lumorph::studio
