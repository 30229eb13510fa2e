#include "app/studio/document/kept_work.h"

#include <algorithm>
#include <chrono>
#include <tuple>

#include "app/studio/document/session_memory.h"
#include "core/base/error.h"

namespace lumorph::studio {

namespace {

namespace fs = std::filesystem;

constexpr const char* kFolder = "replaced";
constexpr const char* kThrown = ".thrown";
constexpr std::chrono::hours kThrownStays{24};

[[noreturn]] void refuse(const fs::path& place, const std::error_code& why) {
    throw DeviceError("kept work", "it cannot be moved in " + place.parent_path().string() + ": " + why.message(),
                      "free some disk space, or check the folder's permissions");
}

void moveTo(const fs::path& from, const fs::path& to) {
    std::error_code failed;
    fs::create_directories(to.parent_path(), failed);
    if (!failed) fs::rename(from, to, failed);
    if (failed) refuse(to, failed);
}

std::uintmax_t bytesIn(const fs::path& folder) {
    std::uintmax_t bytes = 0;
    std::error_code failed;
    for (fs::recursive_directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
        std::error_code none;
        if (at->is_regular_file(none)) bytes += at->file_size(none);
    }
    return bytes;
}

QDateTime changedAt(const fs::path& file) {
    std::error_code failed;
    const auto time = fs::last_write_time(file, failed);
    if (failed) return {};
    const auto since = std::chrono::file_clock::to_sys(time).time_since_epoch();
    return QDateTime::fromMSecsSinceEpoch(std::chrono::duration_cast<std::chrono::milliseconds>(since).count());
}

KeptWork workIn(const fs::path& place) {
    const SessionMemory memory = readSessionMemory(place);
    KeptWork work;
    work.thrown = place.extension() == kThrown;
    work.id = work.thrown ? place.stem().string() : place.filename().string();
    work.name = memory.name;
    work.demo = memory.demo;
    work.lastEdit = memory.lastEdit;
    work.edits = memory.edits;
    work.when = changedAt(place / kSessionFile); // nothing is written to it after that
    work.bytes = bytesIn(place);
    return work;
}

std::vector<fs::path> placesIn(const fs::path& folder) {
    std::vector<fs::path> places;
    std::error_code failed;
    for (fs::directory_iterator at(folder / kFolder, failed), end; !failed && at != end; at.increment(failed))
        places.push_back(at->path());
    return places;
}

} // namespace

std::string newKeptWorkId() {
    return QDateTime::currentDateTimeUtc().toString("yyyyMMdd'T'HHmmss'-'zzz").toStdString();
}

std::vector<KeptWork> keptWorkIn(const fs::path& folder) {
    std::vector<KeptWork> all;
    for (const fs::path& place : placesIn(folder)) all.push_back(workIn(place));
    std::ranges::sort(all, [](const KeptWork& a, const KeptWork& b) {
        return std::tie(a.thrown, b.when, b.id) < std::tie(b.thrown, a.when, a.id);
    });
    return all;
}

fs::path placeOfKeptWork(const fs::path& folder, const std::string& id) {
    std::error_code ignored;
    for (const std::string& name : {id, id + kThrown})
        if (!id.empty() && fs::exists(folder / kFolder / name, ignored)) return folder / kFolder / name;
    return {};
}

void keepWork(const fs::path& session, const fs::path& folder, const std::string& id) {
    std::string free = id.empty() ? newKeptWorkId() : id;
    for (int again = 2; !placeOfKeptWork(folder, free).empty(); ++again) free = id + "-" + std::to_string(again);
    moveTo(session, folder / kFolder / free);
}

void setThrown(const fs::path& folder, const std::string& id, bool thrown) {
    const fs::path place = placeOfKeptWork(folder, id);
    if (place.empty()) return;
    const fs::path other = folder / kFolder / (thrown ? id + kThrown : id);
    if (place == other) return;
    moveTo(place, other);
    std::error_code ignored;
    if (thrown) fs::last_write_time(other, fs::file_time_type::clock::now(), ignored);
}

void removeKeptWork(const fs::path& folder, const std::string& id) {
    std::error_code ignored;
    if (const fs::path place = placeOfKeptWork(folder, id); !place.empty()) fs::remove_all(place, ignored);
}

void clearThrownWork(const fs::path& folder) {
    for (const fs::path& place : placesIn(folder)) {
        std::error_code failed;
        const auto thrown = fs::last_write_time(place, failed);
        if (failed || place.extension() != kThrown || fs::file_time_type::clock::now() - thrown < kThrownStays)
            continue;
        fs::remove_all(place, failed);
    }
}

} // namespace lumorph::studio
