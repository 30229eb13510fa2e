#include "app/applications/keepsake.h"

#include <span>
#include <system_error>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = 64U << 20U;

/// A name beside it that is not taken.
fs::path besideName(const fs::path& file) {
    for (int number = 1;; ++number) {
        fs::path aside = file;
        aside.replace_filename(file.stem().string() + ".damaged-" + std::to_string(number) + file.extension().string());
        std::error_code unknown;
        if (!fs::exists(aside, unknown)) return aside;
    }
}

fs::path movedAside(const fs::path& file) {
    const fs::path aside = besideName(file);
    std::error_code failed;
    fs::rename(file, aside, failed);
    return failed ? file : aside;
}

} // namespace

BegunProgram beginProgram(const Demo& demo, std::uint64_t seed, const fs::path& kept) {
    BegunProgram begun;
    std::error_code unknown;
    if (demo.remembering && !kept.empty() && fs::exists(kept, unknown)) {
        try {
            const std::vector<std::byte> bytes = readFile(kept, kMostBytes);
            begun.program =
                demo.remembering(seed, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, kept.string());
            return begun;
        } catch (const DataError& damaged) {
            begun.problem = damaged.why();
            begun.aside = movedAside(kept);
        }
    }
    begun.program = demo.program(seed);
    return begun;
}

void writeKeepsake(const fs::path& file, const std::string& keepsake) {
    std::error_code failed;
    if (file.has_parent_path()) fs::create_directories(file.parent_path(), failed);
    writeFileAtomically(file, std::as_bytes(std::span(keepsake)));
}

} // namespace lumorph
