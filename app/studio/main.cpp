#include <cstdio>
#include <iostream>

#include "app/applications/registry/demos.h"
#include "app/output/demo_player.h"
#include "app/studio/base/operator_pin.h"
#include "app/studio/headless_show.h"
#include "app/studio/look/palette.h"
#include "app/studio/shell/arguments.h"
#include "app/studio/shell/main_window.h"
#include "app/studio/shell/studio.h"
#include "app/studio/shell/studio_application.h"
#include "app/studio/shell/way_out.h"
#include "app/workspaces/workspaces.h"
#include "core/base/error.h"

namespace {

using namespace lumorph::studio;

bool hasWorkspace(const std::vector<std::unique_ptr<Workspace>>& workspaces, const std::string& id) {
    return id.empty() || std::any_of(workspaces.begin(), workspaces.end(),
                                     [&id](const auto& one) { return one->id().toStdString() == id; });
}

/// The one asked for; else that in which a demo is seen.
QString firstWorkspace(const Arguments& arguments) {
    if (!arguments.workspace.empty() || arguments.demo.empty()) return QString::fromStdString(arguments.workspace);
    return QString::fromStdString(lumorph::demoNamed(arguments.demo).workspace);
}

/// A project brings everything; a target or a field needs the device that was there last time.
bool isProject(const std::filesystem::path& file) { return file.extension() == ".lumorph"; }

/// What was asked for, else what was there last time; at the very first start the cards, when that is ready.
void openFirst(Studio& studio, MainWindow& window, const Arguments& arguments) {
    const auto cardsOnce = [&studio, &window] {
        if (studio.settings.tourSeen()) return;
        studio.settings.setTourSeen(true);
        window.showApplications();
    };
    if (isProject(arguments.project))
        studio.project.open(arguments.project);
    else if (!arguments.project.empty())
        studio.project.restoreSession([&studio, file = arguments.project] { studio.project.open(file); });
    else if (!arguments.demo.empty())
        studio.project.openDemo(arguments.demo, Audience::host, arguments.told);
    else
        studio.project.restoreSession(arguments.kiosk ? std::function<void()>() : cardsOnce);
}

int run(int argc, char** argv, const Arguments& arguments) {
    StudioApplication application(argc, argv);
    Studio studio;
    application.setOnError([&studio](const std::exception& error) { studio.notices.post("project", noticeOf(error)); });
    if (arguments.language) studio.settings.setLanguage(*arguments.language);
    applyTheme(application, studio.settings.theme());
    auto workspaces = makeWorkspaces(studio);
    if (!hasWorkspace(workspaces, arguments.workspace)) {
        std::fprintf(stderr, "lumorph-studio: arguments: there is no workspace '%s'; see 'lumorph-studio --help'\n",
                     arguments.workspace.c_str());
        return 2;
    }
    MainWindow window(studio, std::move(workspaces));
    WayOut wayOut(window, studio);
    window.showWorkspace(firstWorkspace(arguments)); // empty: stays as it is
    studio.sound.open();
    studio.gamepads.open();
    arguments.kiosk ? window.enterKiosk() : window.show();
    openFirst(studio, window, arguments);
    const int status = wayOut.exec(); // servos leave as long as the window's keys can stop them
    application.setOnError({});
    return status;
}

/// For who cannot leave the kiosk any more; over ssh, too.
int forgetPin() {
    Settings settings;
    OperatorPin::forget(settings);
    std::puts(
        "The operator's PIN is forgotten. A kiosk that runs opens at a touch of its lock; the next one asks for a "
        "new PIN.");
    return 0;
}

/// Needs no display, and so no application.
int showHeadless(const Arguments& arguments) {
    try {
        if (arguments.play <= 0.0) {
            runHeadlessShow(arguments.headless, arguments.seconds, std::cout);
            return 0;
        }
        lumorph::DemoPlay play;
        play.seconds = arguments.play;
        play.video = arguments.record;
        play.told = arguments.told;
        play.language = arguments.language.value_or(lumorph::Language::english);
        play.json = arguments.json;
        lumorph::playDemo(lumorph::demoNamed(arguments.demo), play, std::cout);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lumorph-studio: %s\n", error.what());
        return 1;
    }
}

} // namespace

int main(int argc, char** argv) {
    const ParsedArguments parsed = parseArguments(argc, argv);
    if (!parsed.arguments) {
        std::fputs(parsed.message.c_str(), parsed.status == 0 ? stdout : stderr);
        return parsed.status;
    }
    if (parsed.arguments->forgetPin) return forgetPin();
    if (!parsed.arguments->headless.empty() || parsed.arguments->play > 0.0) return showHeadless(*parsed.arguments);
    const QString noDisplay = prepareApplication(argc, argv);
    if (!noDisplay.isEmpty()) {
        std::fputs(noDisplay.toUtf8().constData(), stderr);
        return 1;
    }
    try {
        return run(argc, argv, *parsed.arguments);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lumorph-studio: %s\n", error.what());
        return 1;
    }
}
