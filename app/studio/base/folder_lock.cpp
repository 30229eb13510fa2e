#include "app/studio/base/folder_lock.h"

#include <fstream>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lumorph::studio {

namespace {

constexpr std::chrono::milliseconds kAgain{20};

/// Whether the path still names the open file: its folder may have been removed after it was opened.
bool isNamed(const std::filesystem::path& file, int descriptor) {
    struct stat open {
    }, named{};
    return ::fstat(descriptor, &open) == 0 && ::stat(file.c_str(), &named) == 0 && open.st_ino == named.st_ino &&
           open.st_dev == named.st_dev;
}

} // namespace

FolderLock::~FolderLock() { release(); }

FolderLock::FolderLock(FolderLock&& other) noexcept
    : file_(std::move(other.file_)), descriptor_(std::exchange(other.descriptor_, -1)),
      held_(std::exchange(other.held_, false)) {}

FolderLock& FolderLock::operator=(FolderLock&& other) noexcept {
    release();
    file_ = std::move(other.file_);
    descriptor_ = std::exchange(other.descriptor_, -1);
    held_ = std::exchange(other.held_, false);
    return *this;
}

void FolderLock::release() noexcept {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
    held_ = false;
}

bool FolderLock::tryLock() {
    if (held_) return true;
    std::error_code ignored;
    std::filesystem::create_directories(file_.parent_path(), ignored);
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) return held_ = true;
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 || !isNamed(file_, descriptor_)) {
        release();
        return false;
    }
    const std::string text = QDateTime::currentDateTimeUtc().toString(Qt::ISODate).toStdString() + "\n";
    (void)!::ftruncate(descriptor_, 0);
    (void)!::write(descriptor_, text.data(), text.size());
    return held_ = true;
}

bool FolderLock::tryLockFor(std::chrono::milliseconds patience) {
    const auto until = std::chrono::steady_clock::now() + patience;
    while (!tryLock()) {
        if (std::chrono::steady_clock::now() >= until) return false;
        std::this_thread::sleep_for(kAgain);
    }
    return true;
}

std::optional<QDateTime> FolderLock::since() const {
    std::ifstream stream(file_);
    std::string text;
    std::getline(stream, text);
    const QDateTime when = QDateTime::fromString(QString::fromStdString(text), Qt::ISODate);
    return when.isValid() ? std::optional(when) : std::nullopt;
}

} // namespace lumorph::studio
