#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <unistd.h>

#include <QCoreApplication>

#include "app/applications/registry/demos.h"
#include "app/cli/commands.h"
#include "app/cli/new_demo.h"
#include "app/cli/session.h"
#include "app/output/demo_player.h"
#include "app/output/video_writer.h"
#include "app/weather/weather_fetch.h"
#include "core/base/error.h"

namespace lumorph::cli {

namespace {

struct DemoOptions {
    std::string name;
    DemoPlay play;
    std::string record, picture, inputs, kept, language;
    std::vector<int> size;
};

/// Replaces this process by `lumorph-studio`, which lies beside it: only it has a window.
void showInWindow(const Demo& demo, const DemoTold& told, const std::string& language) {
    std::error_code error;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
    std::string program = (self.parent_path() / "lumorph-studio").string();
    if (error || !std::filesystem::exists(program))
        throw DeviceError("demo", "the program lumorph-studio is not beside this one", "build it, or install it again");
    std::vector<std::string> words{program, "--demo", demo.name};
    for (const auto& [name, text] : told) words.insert(words.end(), {"--" + name, text});
    if (!language.empty()) words.insert(words.end(), {"--language", language});
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    Session::releaseSignals();
    execv(argv[0], argv.data());
    throw DeviceError(program, std::strerror(errno), "check that it may be run");
}

/// Applications know no network.
void fetchForecast(DemoTold& told) {
    const auto weather = told.find("weather");
    if (weather == told.end() || !isWebAddress(weather->second)) return;
    int count = 1;
    char name[] = "lumorph";
    char* words[] = {name, nullptr};
    const QCoreApplication application(count, words); // sockets need it
    const CachedForecast forecast = fetchedForecast(weather->second);
    if (!forecast.problem.empty())
        std::cerr << "lumorph: " << forecast.problem << "; the forecast of " << std::lround(forecast.age / 60.0)
                  << " minutes ago shows\n";
    weather->second = forecast.file.string();
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

void addDemoCommand(CLI::App& app, const Session& session) {
    auto options = std::make_shared<DemoOptions>();
    CLI::App* command = app.add_subcommand("demo", "Start a demonstration, or play one without a window");
    command->add_option("NAME", options->name, "Which: " + demoNames())->check([](const std::string& name) {
        const bool known = std::ranges::find(demos(), name, &Demo::name) != demos().end();
        return known ? std::string() : "there is no demo '" + name + "'; there are: " + demoNames();
    });
    CLI::Option* seconds =
        command
            ->add_option("--seconds", options->play.seconds,
                         "Without a window: how long it lasts (default: 6; of a video as long as it shows new things)")
            ->check(CLI::Range(0.1, 600.0));
    CLI::Option* record =
        command->add_option("--record", options->record, "Without a window: a video of the lit device, OUT.mp4");
    CLI::Option* picture =
        command->add_option("--picture", options->picture, "Without a window: the last picture of that, OUT.png");
    CLI::Option* size =
        command->add_option("--size", options->size, "Without a window: pixels of video and picture (default: 960x600)")
            ->delimiter('x')
            ->expected(2)
            ->type_name("WIDTHxHEIGHT")
            ->check(CLI::Range(160, 3840));
    CLI::Option* inputs =
        command->add_option("--input", options->inputs,
                            "Without a window: what visitors do, as JSON: seconds, name and value of each input");
    CLI::Option* keep = command->add_option(
        "--keep", options->kept, "Without a window: the file in which an application keeps best runs and the like");
    CLI::Option* seed =
        command->add_option("--seed", options->play.seed, "Without a window: of an application's chance")
            ->capture_default_str();
    command
        ->add_option("--language", options->language,
                     "Of what it writes and lets be read, en or de; else English, in the window as chosen there")
        ->check(CLI::IsMember({"en", "de"}));
    command->add_flag("--json", options->play.json, "Without a window: print its rates as one JSON value");
    for (const DemoOption& told : demoOptions())
        command->add_option_function<std::string>(
            "--" + told.name, [options, name = told.name](const std::string& text) { options->play.told[name] = text; },
            told.help);
    CLI::App* own = addNew(*command);
    command->callback([options, seconds, record, picture, size, inputs, keep, seed, own, &session] {
        if (own->parsed()) return;
        if (options->name.empty())
            throw InvalidInput("demo", "which one is not said",
                               "name one of " + demoNames() + ", or 'new' to write one");
        const Demo& demo = demoNamed(options->name);
        options->play.video = options->record;
        options->play.last = options->picture;
        options->play.inputs = options->inputs;
        options->play.kept = options->kept;
        options->play.language = options->language == "de" ? Language::german : Language::english;
        if (!*seconds && *record) options->play.seconds = demo.filmSeconds;
        if (*size) options->play.size = evenSize({options->size[0], options->size[1]});
        if (*seconds || *record || *picture || *size || *inputs || *keep || *seed || options->play.json) {
            fetchForecast(options->play.told);
            std::ostringstream rates; // printed once the bar has gone
            playDemo(demo, options->play, rates, session.progress());
            Session::endProgress();
            std::cout << rates.str();
        } else {
            showInWindow(demo, options->play.told, options->language);
        }
    });
}

} // namespace lumorph::cli
