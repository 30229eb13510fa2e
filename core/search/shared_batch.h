#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "core/search/rig_search.h"

namespace lumorph {

/// The processes that `mpirun` has started together, as a search sees them: each does the same with the same numbers,
/// but scores only its part of a batch, and all get the scores of all. So the result is that of one process.
class Ranks {
public:
    /// Joins the others when the environment is that of `mpirun` with more than one process (Open MPI's); else
    /// nothing, and no library is loaded. The library that speaks MPI is looked for in the folder of the program, where
    /// it is built, and in `../lib/lumorph`, where it is installed. Throws DeviceError when it is in neither (it is
    /// built where MPI is installed) or refuses.
    [[nodiscard]] static std::optional<Ranks> join(const std::filesystem::path& programFolder);
    ~Ranks(); ///< leaves, once all do
    Ranks(Ranks&&) noexcept;
    Ranks& operator=(Ranks&&) noexcept;

    /// Whether this process is the one that writes and prints.
    [[nodiscard]] bool first() const noexcept;
    /// Scores a batch together. When one of the ranks is stopped (its scoring throws Cancelled), all throw Cancelled.
    [[nodiscard]] std::vector<DesignScore> score(const std::vector<DesignPoint>& points, const ScoreBatch& own) const;
    /// Whether any of the ranks says so.
    [[nodiscard]] bool any(bool mine) const;

private:
    struct Library;
    explicit Ranks(std::unique_ptr<Library> library);
    std::unique_ptr<Library> library_;
};

} // namespace lumorph
