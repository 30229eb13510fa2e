#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace lumorph::studio {

/// What the program was started with: `lumorph-studio [PROJECT] [--demo NAME] [--kiosk] [--workspace ID]`.
struct Arguments {
    std::filesystem::path project; ///< or a rig, a field or a target; empty: none
    std::string demo;
    std::string workspace;
    bool kiosk = false;
};

/// Either arguments to start with, or what to print and with which status to exit: 0 for help and version, 2 for wrong
/// usage. Qt's own options (such as -platform) are left to Qt.
struct ParsedArguments {
    std::optional<Arguments> arguments;
    std::string message;
    int status = 0;
};
[[nodiscard]] ParsedArguments parseArguments(int argc, const char* const* argv);

} // namespace lumorph::studio
