#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include <unistd.h>

#include "app/cli/commands.h"
#include "core/base/error.h"

namespace lumorph::cli {

namespace {

/// Replaces this process by `lumorph-bench`, which lies beside it. The benchmarks are a program of
/// their own because they need libraries that nothing else does.
void runBench(std::vector<std::string> arguments) {
    std::error_code error;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
    const std::filesystem::path program = self.parent_path() / "lumorph-bench";
    if (error || !std::filesystem::exists(program))
        throw DeviceError("bench", "the program lumorph-bench is not beside this one",
                          "install the packages of the section 'bench' in packaging/dependencies.txt and build again");
    std::vector<char*> argv;
    std::string name = program.string();
    argv.push_back(name.data());
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    Session::releaseSignals();
    execv(name.c_str(), argv.data());
    throw DeviceError(name, std::strerror(errno), "check that it may be run");
}

} // namespace

void addBenchCommand(CLI::App& app) {
    auto filter = std::make_shared<std::string>();
    auto json = std::make_shared<bool>(false);
    CLI::App* command = app.add_subcommand("bench", "Measure every speed bar, as ratios in one run");
    command->add_option("--filter", *filter, "Only the rows whose name holds this");
    command->add_flag("--json", *json, "Print one JSON value");
    command->callback([filter, json] {
        std::vector<std::string> arguments;
        if (!filter->empty()) arguments = {"--filter", *filter};
        if (*json) arguments.emplace_back("--json");
        runBench(arguments);
    });
}

} // namespace lumorph::cli
