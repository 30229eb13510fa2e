#include "app/studio/shell/arguments.h"

#include <algorithm>

#include <CLI/CLI.hpp>

#include "app/applications/registry/demos.h"

namespace lumorph::studio {
namespace {

ParsedArguments wrongUsage(const std::string& what) {
    return {std::nullopt, "lumorph-studio: arguments: " + what + "; see 'lumorph-studio --help'\n", 2};
}

/// Qt's options have one dash and a long name; each takes the next word.
std::vector<std::string> withoutQtOptions(int argc, const char* const* argv) {
    const std::vector<std::string> qt{"-platform", "-style", "-qwindowgeometry", "-geometry", "-display", "-name"};
    std::vector<std::string> rest;
    for (int i = 1; i < argc; ++i) {
        if (std::find(qt.begin(), qt.end(), argv[i]) != qt.end())
            ++i;
        else
            rest.emplace_back(argv[i]);
    }
    std::reverse(rest.begin(), rest.end()); // CLI11 takes words from the back
    return rest;
}

} // namespace

ParsedArguments parseArguments(int argc, const char* const* argv) {
    Arguments arguments;
    std::string project;
    CLI::App app("Lumorph Studio: objects that change shape and are painted with light.", "lumorph-studio");
    app.set_version_flag("--version", "lumorph-studio " LUMORPH_VERSION);
    app.add_option("PROJECT", project, "a project, recording, rig, field or 3D model to open");
    app.add_option("--demo", arguments.demo, "start a demonstration: " + demoNames());
    for (const DemoOption& told : demoOptions())
        app.add_option_function<std::string>(
               "--" + told.name,
               [&arguments, name = told.name](const std::string& text) { arguments.told[name] = text; }, told.help)
            ->needs("--demo");
    std::string language;
    app.add_option("--language", language, "what visitors read from now on: en or de")
        ->check(CLI::IsMember({"en", "de"}));
    app.add_option("--workspace", arguments.workspace, "the workspace to show first, such as field");
    CLI::Option* kiosk = app.add_flag(
        "--kiosk", arguments.kiosk, "full screen for visitors: the view and STOP alone; the operator leaves by a PIN");
    app.add_flag("--forget-pin", arguments.forgetPin,
                 "no window: forget the operator's PIN, and open a kiosk that runs")
        ->excludes(kiosk);
    std::string headless;
    CLI::Option* folder =
        app.add_option("--headless", headless, "no window: draw a live match into this folder and end");
    app.add_option("--seconds", arguments.seconds, "how long that lasts")
        ->check(CLI::Range(0.1, 600.0))
        ->needs(folder)
        ->capture_default_str();
    std::string record;
    CLI::Option* play = app.add_option("--play", arguments.play, "no window: play the demo for so many seconds and end")
                            ->check(CLI::Range(0.1, 600.0))
                            ->needs("--demo");
    app.add_option("--record", record, "a video of what is played (.mp4)")->needs(play);
    app.add_flag("--json", arguments.json, "print its rates as one JSON value")->needs(play);
    try {
        app.parse(withoutQtOptions(argc, argv));
    } catch (const CLI::CallForHelp&) {
        return {std::nullopt, app.help(), 0};
    } catch (const CLI::CallForVersion& version) {
        return {std::nullopt, std::string(version.what()) + "\n", 0};
    } catch (const CLI::ParseError& error) {
        return wrongUsage(error.what());
    }
    if (!arguments.demo.empty() && std::ranges::find(demos(), arguments.demo, &Demo::name) == demos().end())
        return wrongUsage("there is no demo '" + arguments.demo + "'; there are: " + demoNames());
    if (!arguments.demo.empty() && !project.empty())
        return wrongUsage("a demo and '" + project + "' cannot both be opened; leave one out");
    if (!language.empty()) arguments.language = language == "de" ? Language::german : Language::english;
    arguments.project = project;
    arguments.headless = headless;
    arguments.record = record;
    return {arguments, {}, 0};
}

} // namespace lumorph::studio
