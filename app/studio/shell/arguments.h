#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/applications/demo.h"

namespace lumorph::studio {

/// What the program was started with: `lumorph-studio [PROJECT] [--demo NAME [--OPTION TEXT]] [--kiosk] [--workspace
/// ID] [--language en|de]`, `lumorph-studio --forget-pin`, which does only that, or `lumorph-studio --headless FOLDER
/// [--seconds S]`, which opens no window, nor does `--demo NAME --play S [--record OUT.mp4] [--json]`.
struct Arguments {
    std::filesystem::path project; ///< or a rig, a field or a target; empty: none
    std::string demo;
    DemoTold told;                    ///< to the demo, by the names of its options
    std::optional<Language> language; ///< that visitors read from now on; empty: as chosen before
    std::string workspace;
    bool kiosk = false;
    bool forgetPin = false;         ///< of the kiosk's operator; no window opens
    std::filesystem::path headless; ///< where to draw the show without a display; empty: open the window
    double seconds = 6.0;           ///< that the show lasts
    double play = 0.0;              ///< seconds of the demo without a window; 0: in a window
    std::filesystem::path record;   ///< a video of that; empty: none
    bool json = false;              ///< its rates as JSON
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
