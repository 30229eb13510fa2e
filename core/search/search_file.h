#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "core/mdf/target_library.h"
#include "core/search/rig_search.h"

namespace lumorph {

/// What a search is about: a folder belongs to one.
struct SearchIdentity {
    std::string rig;           ///< its name
    std::uint64_t sheet = 0;   ///< of the sheet's measures and the lines it begins with
    std::uint64_t targets = 0; ///< of the targets as they stand
    std::uint64_t seed = 1;
    int population = 0;
    std::size_t mostServos = 0;
    SearchCost cost = SearchCost::servos;
    bool operator==(const SearchIdentity&) const = default;
};

/// FNV-1a of what the numbers of a sheet device, or of the targets' meshes and places, are made of.
[[nodiscard]] std::uint64_t fingerprint(const SheetDevice& sheet);
[[nodiscard]] std::uint64_t fingerprint(std::span<const Target> targets);

/// The file in a search's folder that a search goes on from.
[[nodiscard]] std::filesystem::path searchStateFile(const std::filesystem::path& folder);

/// Writes the state, whole or not at all. Throws DeviceError.
void writeSearchState(const std::filesystem::path& folder, const SearchIdentity& identity, const SearchState& state);

/// The state in a folder; nothing where there is none. Throws InvalidInput when the folder holds the search of another
/// rig, or with other targets or settings (named), DataError when the file is no state.
[[nodiscard]] std::optional<SearchState> readSearchState(const std::filesystem::path& folder,
                                                         const SearchIdentity& identity);

} // namespace lumorph
