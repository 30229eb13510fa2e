#include "app/cli/target_arguments.h"

#include <CLI/CLI.hpp>

#include "core/base/resources.h"

namespace lumorph::cli {

void LibraryArguments::addTo(CLI::App& command) {
    command.add_option("--targets", path, "A folder of meshes (default: the bundled targets)");
    command
        .add_option("--place", place,
                    "Where targets stand: auto (a target that holds the device at rest is a pose of it and stays where "
                    "it is, any other is fitted), fit (as large as fits, standing on the device) or as-is")
        ->check(CLI::IsMember({"auto", "fit", "as-is"}))
        ->capture_default_str();
}

std::filesystem::path LibraryArguments::folder() const {
    return path.empty() ? resourcesFolder() / "targets" : std::filesystem::path(path);
}

TargetPlacing LibraryArguments::placing() const {
    return place == "fit" ? TargetPlacing::fitted : place == "as-is" ? TargetPlacing::asIs : TargetPlacing::automatic;
}

} // namespace lumorph::cli
