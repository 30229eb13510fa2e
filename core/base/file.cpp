#include "core/base/file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "core/base/error.h"

namespace lumorph {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 20;

struct Close {
    void operator()(std::FILE* stream) const noexcept { std::fclose(stream); }
};

std::string sizeText(std::size_t bytes) {
    constexpr std::size_t kMegabyte = 1'000'000;
    return bytes >= kMegabyte ? std::to_string(bytes / kMegabyte) + " MB" : std::to_string(bytes) + " bytes";
}

[[noreturn]] void failUnreadable(const std::filesystem::path& file, int reason) {
    throw DataError(file.string(), "cannot be read: " + std::generic_category().message(reason),
                    "check that the file exists and that you may read it");
}

[[noreturn]] void failTooLarge(const std::filesystem::path& file, std::size_t maxBytes) {
    throw DataError(file.string(), "is larger than " + sizeText(maxBytes) + ", the most that is read",
                    "reduce its detail or split it");
}

} // namespace

std::vector<std::byte> readFile(const std::filesystem::path& file, std::size_t maxBytes) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored))
        throw DataError(file.string(), "is a folder", "name a file inside it");
    const std::unique_ptr<std::FILE, Close> stream(std::fopen(file.c_str(), "rb"));
    if (!stream) failUnreadable(file, errno);

    // The size is a hint: a pipe or a device has none, and a file may grow while it is read.
    const std::uintmax_t size = std::filesystem::file_size(file, ignored);
    if (!ignored && size > maxBytes) failTooLarge(file, maxBytes);
    std::vector<std::byte> bytes;
    std::size_t filled = 0;
    std::size_t next = ignored ? kChunk : static_cast<std::size_t>(size) + 1;
    for (;;) {
        bytes.resize(filled + std::max<std::size_t>(next, 1));
        const std::size_t wanted = bytes.size() - filled;
        const std::size_t got = std::fread(bytes.data() + filled, 1, wanted, stream.get());
        filled += got;
        if (filled > maxBytes) failTooLarge(file, maxBytes);
        if (got < wanted) break;
        next = std::min(std::max(filled, kChunk), maxBytes - filled + 1);
    }
    if (std::ferror(stream.get()) != 0) failUnreadable(file, errno);
    bytes.resize(filled);
    return bytes;
}

} // namespace lumorph
