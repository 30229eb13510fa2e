#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <unistd.h>

#include <QCoreApplication>

#include "app/applications/registry/demos.h"
#include "app/cli/commands.h"
#include "app/cli/new_demo.h"
#include "app/cli/session.h"
#include "app/output/demo_player.h"
#include "app/weather/weather_fetch.h"
#include "core/base/error.h"

namespace lumorph::cli {

namespace {

struct DemoOptions {
    std::string name;
    DemoPlay play;
    std::string record, picture, inputs;
};

/// What `ambient` may be told: --NAME VALUE each.
constexpr std::pair<const char*, const char*> kSettings[] = {
    {"weather", "Without a window, of ambient: a forecast in Open-Meteo's JSON, a file or an http(s) address"},
    {"place", "Without a window, of ambient: LAT,LON or LAT,LON,HOURS ahead of UTC"},
    {"begin", "Without a window, of ambient: its first time, 2026-05-17T14:00 at the place"},
    {"day", "Without a window, of ambient: seconds that a day takes; 86400 is the world's own time"},
    {"anticipation", "Without a window, of ambient: seconds by which light is ahead of the servos"}};

void addSettings(CLI::App& command, DemoSettings& settings) {
    for (const auto& [name, help] : kSettings)
        command.add_option_function<std::string>(
            std::string("--") + name,
            [&settings, key = std::string(name)](const std::string& value) { settings[key] = value; }, help);
}

/// Replaces this process by `lumorph-studio`, which lies beside it: only it has a window.
void showInWindow(const Demo& demo) {
    std::error_code error;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
    std::string program = (self.parent_path() / "lumorph-studio").string();
    if (error || !std::filesystem::exists(program))
        throw DeviceError("demo", "the program lumorph-studio is not beside this one", "build it, or install it again");
    std::string option = "--demo";
    std::string name = demo.name;
    char* const argv[] = {program.data(), option.data(), name.data(), nullptr};
    Session::releaseSignals();
    execv(argv[0], argv);
    throw DeviceError(program, std::strerror(errno), "check that it may be run");
}

/// A forecast on the web is fetched here, because applications know no network.
void fetchForecast(DemoSettings& settings) {
    const auto weather = settings.find("weather");
    if (weather == settings.end() || !isWebAddress(weather->second)) return;
    int count = 1;
    char name[] = "lumorph";
    char* words[] = {name, nullptr};
    const QCoreApplication application(count, words); // sockets need it
    settings["forecast"] = fetchWeather(weather->second);
}

CLI::App* addNew(CLI::App& demo) {
    struct NewOptions {
        std::string name, tree = ".";
    };
    auto options = std::make_shared<NewOptions>();
    CLI::App* command =
        demo.add_subcommand("new", "Write an application of your own into the source tree, to begin with");
    command->add_option("NAME", options->name, "Its name: small letters, digits and _")->required();
    command->add_option("--tree", options->tree, "The folder of Lumorph's sources")->capture_default_str();
    command->callback([options] {
        for (const std::filesystem::path& file : writeNewDemo(options->tree, options->name))
            std::cout << file.string() << "\n";
        std::cout << "Build it, and play it: lumorph demo " << options->name << "\n";
    });
    return command;
}

} // namespace

void addDemoCommand(CLI::App& app) {
    auto options = std::make_shared<DemoOptions>();
    CLI::App* command = app.add_subcommand("demo", "Start a demonstration, or play one without a window");
    command->add_option("NAME", options->name, "Which: " + demoNames())->check([](const std::string& name) {
        const bool known = std::ranges::find(demos(), name, &Demo::name) != demos().end();
        return known ? std::string() : "there is no demo '" + name + "'; there are: " + demoNames();
    });
    CLI::Option* seconds =
        command->add_option("--seconds", options->play.seconds, "Without a window: how long it lasts")
            ->check(CLI::Range(0.1, 600.0))
            ->capture_default_str();
    CLI::Option* record =
        command->add_option("--record", options->record, "Without a window: a video of the lit device, OUT.mp4");
    CLI::Option* picture =
        command->add_option("--picture", options->picture, "Without a window: the last picture of that, OUT.png");
    CLI::Option* inputs =
        command->add_option("--input", options->inputs,
                            "Without a window: what visitors do, as JSON: seconds, name and value of each input");
    CLI::Option* seed =
        command->add_option("--seed", options->play.seed, "Without a window: of an application's chance")
            ->capture_default_str();
    command->add_flag("--json", options->play.json, "Without a window: print its rates as one JSON value");
    addSettings(*command, options->play.settings);
    CLI::App* own = addNew(*command);
    command->callback([options, seconds, record, picture, inputs, seed, own] {
        if (own->parsed()) return;
        if (options->name.empty())
            throw InvalidInput("demo", "which one is not said",
                               "name one of " + demoNames() + ", or 'new' to write one");
        const Demo& demo = demoNamed(options->name);
        fetchForecast(options->play.settings);
        options->play.video = options->record;
        options->play.last = options->picture;
        options->play.inputs = options->inputs;
        if (*seconds || *record || *picture || *inputs || *seed || options->play.json ||
            !options->play.settings.empty())
            playDemo(demo, options->play, std::cout);
        else
            showInWindow(demo);
    });
}

} // namespace lumorph::cli
