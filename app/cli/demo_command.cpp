#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <unistd.h>

#include "app/cli/commands.h"
#include "core/base/error.h"

namespace lumorph::cli {

namespace {

struct DemoOptions {
    std::string name;
    double seconds = 6.0;
    std::string record;
    bool json = false;
};

/// Replaces this process by `lumorph-studio`, which lies beside it: the demonstrations are played by its loop and
/// renderer, and only it links Qt.
void runStudio(std::vector<std::string> arguments) {
    std::error_code error;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
    const std::filesystem::path program = self.parent_path() / "lumorph-studio";
    if (error || !std::filesystem::exists(program))
        throw DeviceError("demo", "the program lumorph-studio is not beside this one", "build it, or install it again");
    arguments.insert(arguments.begin(), program.string());
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    Session::releaseSignals();
    execv(argv.front(), argv.data());
    throw DeviceError(program.string(), std::strerror(errno), "check that it may be run");
}

} // namespace

void addDemoCommand(CLI::App& app) {
    auto options = std::make_shared<DemoOptions>();
    CLI::App* command = app.add_subcommand("demo", "Start a demonstration, or play one without a window");
    command->add_option("NAME", options->name, "Which: water, techniques, field (with a window only)")->required();
    CLI::Option* seconds = command->add_option("--seconds", options->seconds, "Without a window: how long it lasts")
                               ->check(CLI::Range(0.1, 600.0))
                               ->capture_default_str();
    CLI::Option* record =
        command->add_option("--record", options->record, "Without a window: a video of the lit device, OUT.mp4");
    command->add_flag("--json", options->json, "Without a window: print its rates as one JSON value");
    command->callback([options, seconds, record] {
        std::vector<std::string> arguments{"--demo", options->name};
        const bool hidden = *seconds || *record || options->json;
        if (hidden) arguments.insert(arguments.end(), {"--play", std::to_string(options->seconds)});
        if (*record) arguments.insert(arguments.end(), {"--record", options->record});
        if (options->json) arguments.emplace_back("--json");
        runStudio(arguments);
    });
}

} // namespace lumorph::cli
