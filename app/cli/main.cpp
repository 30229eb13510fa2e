#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/cli/commands.h"
#include "core/base/error.h"

namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongUsage = 2;

int complain(const char* message, int status) {
    lumorph::cli::Session::endProgress();
    std::fprintf(stderr, "lumorph: %s\n", message);
    return status;
}

/// What was wrong with the arguments, in whose help to look, and the word that is no command, if any.
std::string usageMessage(const CLI::App& program, const CLI::ParseError& error) {
    const CLI::App* group = &program;
    std::string name = program.get_name();
    while (!group->get_subcommands().empty()) {
        group = group->get_subcommands().front();
        name += " " + group->get_name();
    }
    std::string what = error.what();
    const std::vector<std::string> words = group->remaining();
    if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr && !words.empty() &&
        !group->get_subcommands([](const CLI::App*) { return true; }).empty())
        what = "'" + words.front() + "' is no command";
    return "arguments: " + what + "; see '" + name + " --help'";
}

} // namespace

int main(int argc, char** argv) {
    lumorph::cli::Session session;
    CLI::App app("Lumorph: objects that change shape and are painted with light.", "lumorph");
    app.set_version_flag("--version", LUMORPH_VERSION);
    app.require_subcommand(1);
    lumorph::cli::addRigCommands(app, session);
    lumorph::cli::addMdfCommands(app, session);
    lumorph::cli::addVoxelizeCommand(app, session);
    lumorph::cli::addMatchCommand(app, session);
    lumorph::cli::addProjectCommand(app, session);
#ifdef LUMORPH_WITH_CALIBRATION
    lumorph::cli::addRecordingCommands(app);
    lumorph::cli::addRenderCommand(app, session);
    lumorph::cli::addCalibrateCommands(app, session);
    lumorph::cli::addLabCommands(app, session);
    lumorph::cli::addCamerasCommand(app);
#endif
#ifdef LUMORPH_WITH_DEVICES
    lumorph::cli::addDeviceCommands(app, session);
    lumorph::cli::addTrackCommand(app, session);
    lumorph::cli::addDemoCommand(app, session);
#endif
    lumorph::cli::addBenchCommand(app);
    try {
        app.parse(argc, argv); // runs the command
        lumorph::cli::finishOutput();
        lumorph::cli::Session::endProgress();
        return kDone;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        return complain(usageMessage(app, error).c_str(), kWrongUsage);
    } catch (const lumorph::InvalidInput& error) {
        return complain(error.what(), kWrongUsage);
    } catch (const lumorph::Cancelled&) {
        return complain("stopped: it was asked to; nothing was written", kFailed);
    } catch (const lumorph::cli::ReaderGone&) {
        lumorph::cli::Session::endByPipe();
    } catch (const std::bad_alloc&) {
        return complain("memory: there is not enough for this; use a lower resolution or fewer levels", kFailed);
    } catch (const std::exception& error) {
        return complain(error.what(), kFailed);
    }
}
