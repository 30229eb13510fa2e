#include "core/search/shared_batch.h"

#include <cstdlib>
#include <string>
#include <system_error>

#include <dlfcn.h>

#include "core/base/error.h"
#include "core/search/mpi/ranks.h"

namespace lumorph {

struct Ranks::Library {
    LumorphRanks ranks{0, 1};
    LumorphRanksMost most = nullptr;
    LumorphRanksShare share = nullptr;
    LumorphRanksLeave leave = nullptr;
};

namespace {

std::filesystem::path libraryFile(const std::filesystem::path& programFolder) {
    constexpr const char* kName = "liblumorph_mpi.so";
    std::error_code error;
    const std::filesystem::path built = programFolder / kName;
    if (std::filesystem::exists(built, error)) return built;
    return (programFolder / "../lib/lumorph" / kName).lexically_normal();
}

} // namespace

std::optional<Ranks> Ranks::join(const std::filesystem::path& programFolder) {
    const char* count = std::getenv("OMPI_COMM_WORLD_SIZE");
    if (count == nullptr || std::atoi(count) < 2) return std::nullopt;
    const std::string file = libraryFile(programFolder).string();
    // Never unloaded: MPI leaves threads and handlers behind.
    void* const handle = dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
    if (handle == nullptr)
        throw DeviceError(file, "it cannot be loaded (" + std::string(dlerror()) + ")",
                          "install Lumorph again, build where libopenmpi-dev is installed, or run without mpirun");
    auto library = std::make_unique<Library>();
    const auto join = reinterpret_cast<LumorphRanksJoin>(dlsym(handle, "lumorphRanksJoin"));
    library->most = reinterpret_cast<LumorphRanksMost>(dlsym(handle, "lumorphRanksMost"));
    library->share = reinterpret_cast<LumorphRanksShare>(dlsym(handle, "lumorphRanksShare"));
    library->leave = reinterpret_cast<LumorphRanksLeave>(dlsym(handle, "lumorphRanksLeave"));
    if (join == nullptr || library->most == nullptr || library->share == nullptr || library->leave == nullptr)
        throw DeviceError(file, "it is of another version", "build it anew");
    if (!join(&library->ranks)) throw DeviceError("MPI", "it cannot be started", "check mpirun");
    return Ranks(std::move(library));
}

Ranks::Ranks(std::unique_ptr<Library> library) : library_(std::move(library)) {}
Ranks::~Ranks() {
    if (library_) library_->leave();
}
Ranks::Ranks(Ranks&&) noexcept = default;
Ranks& Ranks::operator=(Ranks&&) noexcept = default;

bool Ranks::first() const noexcept { return library_->ranks.rank == 0; }

bool Ranks::any(bool mine) const { return library_->most(mine ? 1 : 0) != 0; }

std::vector<DesignScore> Ranks::score(const std::vector<DesignPoint>& points, const ScoreBatch& own) const {
    constexpr std::size_t kNumbers = 3;
    const auto ranks = static_cast<std::size_t>(library_->ranks.count);
    const auto rank = static_cast<std::size_t>(library_->ranks.rank);
    const auto start = [&](std::size_t r) { return points.size() * r / ranks; };
    std::vector<double> mine;
    bool stopped = false;
    try {
        const auto first = points.begin() + static_cast<std::ptrdiff_t>(start(rank));
        const auto last = points.begin() + static_cast<std::ptrdiff_t>(start(rank + 1));
        for (const DesignScore& score : own(std::vector<DesignPoint>(first, last)))
            mine.insert(mine.end(), {score.cost, score.fit, score.gain});
    } catch (const Cancelled&) {
        stopped = true;
    }
    if (any(stopped)) throw Cancelled(); // on all of them, so that none waits for the others
    std::vector<int> counts;
    for (std::size_t r = 0; r < ranks; ++r) counts.push_back(static_cast<int>(kNumbers * (start(r + 1) - start(r))));
    std::vector<double> all(kNumbers * points.size());
    library_->share(mine.data(), all.data(), counts.data());
    std::vector<DesignScore> scores;
    for (std::size_t k = 0; k < points.size(); ++k)
        scores.push_back({all[kNumbers * k], all[kNumbers * k + 1], all[kNumbers * k + 2]});
    return scores;
}

} // namespace lumorph
