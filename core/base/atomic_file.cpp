#include "core/base/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;

/// An open file descriptor, closed at the end of its life.
class Descriptor {
public:
    explicit Descriptor(int value) noexcept : value_(value) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (value_ >= 0) ::close(value_);
    }
    [[nodiscard]] int get() const noexcept { return value_; }
    [[nodiscard]] bool valid() const noexcept { return value_ >= 0; }

    /// Some file systems report a failed write only here.
    [[nodiscard]] bool close() noexcept {
        const int result = ::close(value_);
        value_ = -1;
        return result == 0;
    }

private:
    int value_;
};

/// Removes a file at the end of its life unless it was kept.
class Leftover {
public:
    explicit Leftover(fs::path file) : file_(std::move(file)) {}
    Leftover(const Leftover&) = delete;
    Leftover& operator=(const Leftover&) = delete;
    ~Leftover() {
        if (!file_.empty()) ::unlink(file_.c_str());
    }
    void keep() noexcept { file_.clear(); }

private:
    fs::path file_;
};

/// Gives 0, or the system's reason.
[[nodiscard]] int writeAll(int descriptor, std::span<const std::byte> bytes) noexcept {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return 0;
}

void writeDirectly(const fs::path& file, std::span<const std::byte> bytes) {
    Descriptor descriptor(::open(file.c_str(), O_WRONLY | O_CLOEXEC));
    if (!descriptor.valid()) throwWriteError(file, errno);
    if (const int reason = writeAll(descriptor.get(), bytes)) throwWriteError(file, reason);
    if (!descriptor.close()) throwWriteError(file, errno);
}

/// The name is short and its own, so that a long target name and two writers at once both work.
fs::path temporaryBeside(const fs::path& file) {
    static std::atomic<unsigned> counter{0};
    const std::string name = ".lumorph-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp";
    return file.parent_path() / name;
}

} // namespace

void throwWriteError(const fs::path& file, int reason) {
    throw DeviceError(file.string(), "cannot be written: " + std::generic_category().message(reason),
                      reason == ENOSPC || reason == EDQUOT ? "free some disk space, or save to another place"
                                                           : "choose another place, or check its permissions");
}

void writeFileAtomically(const fs::path& file, std::span<const std::byte> bytes) {
    std::error_code error;
    const bool link = fs::is_symlink(file, error); // an error here shows again when the file is opened
    error.clear();
    const fs::path resolved = link ? fs::weakly_canonical(file, error) : file;
    if (error) throwWriteError(file, error.value());
    struct stat old {};
    const bool exists = ::stat(resolved.c_str(), &old) == 0;
    if (exists && S_ISDIR(old.st_mode)) throwWriteError(file, EISDIR);
    if (exists && !S_ISREG(old.st_mode)) return writeDirectly(file, bytes);

    const fs::path temporary = temporaryBeside(resolved);
    Descriptor descriptor(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (!descriptor.valid()) throwWriteError(file, errno);
    Leftover leftover(temporary);
    // A replaced file keeps its permissions; where that is not allowed the new ones are good enough.
    if (exists) (void)!::fchmod(descriptor.get(), old.st_mode & 07777U);
    if (const int reason = writeAll(descriptor.get(), bytes)) throwWriteError(file, reason);
    if (::fsync(descriptor.get()) != 0 && errno != EINVAL) throwWriteError(file, errno);
    if (!descriptor.close()) throwWriteError(file, errno);
    if (::rename(temporary.c_str(), resolved.c_str()) != 0) throwWriteError(file, errno);
    leftover.keep();

    // The rename survives a power cut only once the folder is flushed too; a folder that cannot be
    // flushed does not make the file wrong.
    const fs::path folder = resolved.has_parent_path() ? resolved.parent_path() : fs::path(".");
    const Descriptor directory(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (directory.valid()) (void)!::fsync(directory.get());
}

} // namespace lumorph
