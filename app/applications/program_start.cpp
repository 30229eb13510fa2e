#include "app/applications/program_start.h"

#include <algorithm>
#include <span>
#include <string_view>
#include <system_error>
#include <vector>

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

void checkTold(const Demo& demo, const DemoTold& told) {
    for (const auto& [name, text] : told)
        if (std::ranges::find(demo.options, name, &DemoOption::name) == demo.options.end())
            throw InvalidInput("--" + name, "the demo '" + demo.name + "' has no such option", "leave it out");
}

} // namespace

BegunProgram beginProgram(const Demo& demo, const ProgramWish& wish, const Progress& progress) {
    checkTold(demo, wish.told);
    BegunProgram begun;
    if (!demo.program) return begun;
    ProgramStart start{
        wish.seed,
        wish.told,
        {},
        {},
        [&begun](const std::string& note) { begun.notes.push_back(note); },
        wish.feed,
        [&begun](const std::string& name, const std::string& json) { begun.figures.emplace_back(name, json); }};
    std::error_code unknown;
    if (demo.keeps && !wish.kept.empty() && fs::exists(wish.kept, unknown)) {
        const std::string file = wish.kept.string();
        try {
            const std::vector<std::byte> bytes = readFile(wish.kept, kMostBytes);
            if (bytes.empty()) throw DataError(file, "it is empty", "remove it");
            start.kept = {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
            start.keptIn = file;
            begun.program = demo.program(start, progress);
            return begun;
        } catch (const DataError& damaged) {
            if (damaged.subject() != file) throw; // something else is
            begun.problem = damaged.why();
            begun.aside = movedAside(wish.kept);
            start.kept = {};
        }
    }
    begun.program = demo.program(start, progress);
    return begun;
}

void writeKeepsake(const fs::path& file, const std::string& keepsake) {
    std::error_code failed;
    if (file.has_parent_path()) fs::create_directories(file.parent_path(), failed);
    writeFileAtomically(file, std::as_bytes(std::span(keepsake)));
}

} // namespace lumorph
