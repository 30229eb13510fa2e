#pragma once

#include <filesystem>
#include <string>

#include <CLI/App.hpp>

#include "core/mdf/target_library.h"

namespace lumorph::cli {

/// Which targets a rig is judged by, and where they stand.
struct LibraryArguments {
    std::string path; ///< empty: the bundled ones
    std::string place = "auto";

    /// Adds --targets and --place.
    void addTo(CLI::App& command);
    [[nodiscard]] std::filesystem::path folder() const;
    [[nodiscard]] TargetPlacing placing() const;
};

} // namespace lumorph::cli
