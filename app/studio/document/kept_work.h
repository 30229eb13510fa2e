#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <QDateTime>
#include <QString>

namespace lumorph::studio {

/// Edited work that was not saved when something else was opened. It stays on disk, `replaced/ID` below the folder of
/// sessions, until it is brought back or thrown away.
struct KeptWork {
    std::string id;       ///< sorts by time
    std::string name;     ///< of the project's file, else of the rig
    std::string demo;     ///< the demonstration that was edited; empty: none
    std::string lastEdit; ///< the newest step of undo; may be empty
    int edits = 0;        ///< steps of undo; 0: not known
    QDateTime when;       ///< when something else was opened
    std::uintmax_t bytes = 0;
    bool thrown = false; ///< thrown away, which can be undone for a day
    bool operator==(const KeptWork&) const = default;
};

/// An id for work that is replaced now.
[[nodiscard]] std::string newKeptWorkId();

/// All kept work of a folder of sessions, the newest first; what was thrown away stands last.
[[nodiscard]] std::vector<KeptWork> keptWorkIn(const std::filesystem::path& folder);
/// Where one lies, thrown away or not; empty where there is none of this id.
[[nodiscard]] std::filesystem::path placeOfKeptWork(const std::filesystem::path& folder, const std::string& id);

/// Moves a session's folder to the kept work. Throws DeviceError where the disk refuses.
void keepWork(const std::filesystem::path& session, const std::filesystem::path& folder, const std::string& id);
/// Throws work away, or takes that back. Throws DeviceError where the disk refuses.
void setThrown(const std::filesystem::path& folder, const std::string& id, bool thrown);
/// Removes it from the disk.
void removeKeptWork(const std::filesystem::path& folder, const std::string& id);
/// Removes what was thrown away more than a day ago.
void clearThrownWork(const std::filesystem::path& folder);

} // namespace lumorph::studio
