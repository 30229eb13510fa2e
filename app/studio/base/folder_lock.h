#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

#include <QDateTime>

namespace lumorph::studio {

/// A lock that one program at a time holds, by a file. The system releases it when the program ends, however it ends.
/// The file says since when it is held.
class FolderLock {
public:
    explicit FolderLock(std::filesystem::path file) : file_(std::move(file)) {}
    ~FolderLock();
    FolderLock(FolderLock&& other) noexcept;
    FolderLock& operator=(FolderLock&& other) noexcept;

    /// True where it is held now. So it is where the file cannot be made: what is written beside it will report that.
    bool tryLock();
    /// Tries again until then: a program that was killed needs a moment to end.
    bool tryLockFor(std::chrono::milliseconds patience);
    [[nodiscard]] bool held() const noexcept { return held_; }
    void release() noexcept;

    /// Since when some program holds it; empty where it does not say.
    [[nodiscard]] std::optional<QDateTime> since() const;

private:
    std::filesystem::path file_;
    int descriptor_ = -1;
    bool held_ = false;
};

} // namespace lumorph::studio
