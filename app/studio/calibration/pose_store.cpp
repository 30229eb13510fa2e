#include "app/studio/calibration/pose_store.h"

#include <algorithm>
#include <ctime>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "calibration/decode/capture_folder.h"
#include "core/base/atomic_file.h"

namespace lumorph::studio {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostWaiting = std::size_t{1} << 30U; // bytes

std::size_t bytesOf(const CapturedPose& pose) {
    std::size_t bytes = 0;
    for (const cv::Mat& image : pose.images) bytes += image.total() * image.elemSize();
    return bytes;
}

/// "2026-03-01-184502", by the clock on the wall.
std::string dateName() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    localtime_r(&now, &parts);
    char text[32];
    return {text, std::strftime(text, sizeof text, "%Y-%m-%d-%H%M%S", &parts)};
}

/// A folder that was not there before, also where two begin in the same second.
fs::path makeDatedFolder(const fs::path& parent) {
    std::error_code failed;
    fs::create_directories(parent, failed);
    if (failed) throwWriteError(parent, failed.value());
    const std::string date = dateName();
    for (int number = 1;; ++number) {
        fs::path folder = parent / (number == 1 ? date : date + "-" + std::to_string(number));
        if (fs::create_directory(folder, failed)) return folder;
        if (failed) throwWriteError(folder, failed.value());
    }
}

void copyTree(const fs::path& from, const fs::path& to, const Progress& progress) {
    std::error_code failed;
    std::vector<fs::path> entries;
    for (fs::recursive_directory_iterator at(from, failed), end; !failed && at != end; at.increment(failed))
        entries.push_back(at->path());
    if (failed) throwWriteError(to, failed.value());
    for (std::size_t i = 0; i < entries.size(); ++i) {
        progress.throwIfCancelled();
        progress.report(static_cast<double>(i) / static_cast<double>(entries.size()), "copying the poses so far");
        const fs::path target = to / entries[i].lexically_relative(from);
        if (fs::is_directory(entries[i], failed))
            fs::create_directory(target, failed);
        else
            fs::copy_file(entries[i], target, failed);
        if (failed) throwWriteError(target, failed.value());
    }
}

/// So that who reads the images later knows whose they are.
void mark(const fs::path& folder) {
    constexpr std::string_view kWords = "Made in the virtual lab.\n";
    std::error_code failed;
    if (!fs::exists(folder / kLabCaptureMark, failed))
        writeFileAtomically(folder / kLabCaptureMark, std::as_bytes(std::span(kWords)));
}

} // namespace

void PoseStore::moveTo(const fs::path& parent, const Progress& progress) {
    const fs::path before = folder();
    if (!before.empty() && before.parent_path() == parent) return;
    const fs::path fresh = makeDatedFolder(parent);
    std::error_code failed;
    try {
        if (fs::exists(before, failed)) copyTree(before, fresh, progress);
    } catch (...) {
        fs::remove_all(fresh, failed);
        throw;
    }
    const std::scoped_lock lock(mutex_);
    folder_ = fresh;
}

/// In place of one of the same name.
void PoseStore::wait(Pose pose) {
    const std::scoped_lock lock(mutex_);
    std::erase_if(waiting_, [&](const Pose& other) { return other->name == pose->name; });
    std::size_t bytes = bytesOf(*pose);
    for (const Pose& other : waiting_) bytes += bytesOf(*other);
    if (bytes > kMostWaiting && !waiting_.empty())
        ++lost_;
    else
        waiting_.push_back(std::move(pose));
}

void PoseStore::save(const fs::path& parent, Pose pose, const Progress& progress) {
    const std::scoped_lock one(saving_);
    if (pose) wait(std::move(pose));
    moveTo(parent, progress.part(0.0, 0.5));
    if (isSimulated_) mark(folder());
    while (true) {
        Pose next;
        {
            const std::scoped_lock lock(mutex_);
            if (waiting_.empty()) return;
            next = waiting_.front();
        }
        savePose(folder(), *next, progress.part(0.5, 1.0));
        const std::scoped_lock lock(mutex_);
        waiting_.erase(waiting_.begin());
    }
}

fs::path PoseStore::folder() const {
    const std::scoped_lock lock(mutex_);
    return folder_;
}

int PoseStore::unsaved() const {
    const std::scoped_lock lock(mutex_);
    return static_cast<int>(waiting_.size()) + lost_;
}

} // namespace lumorph::studio
