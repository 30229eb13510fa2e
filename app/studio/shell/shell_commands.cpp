#include "app/studio/shell/shell_commands.h"
#include "app/studio/shell/guide_window.h"

#include <cmath>

#include "app/studio/look/icons.h"
#include "app/studio/shell/command_palette.h"
#include "app/studio/shell/dialogs.h"
#include "app/studio/shell/driver_chip.h"
#include "app/studio/shell/undo_commands.h"

namespace lumorph::studio {
namespace {

QAction* addShellAction(Studio& studio, const char* id, const QString& text, const char* iconName,
                        const QKeySequence& keys, const char* menu, std::function<void()> run) {
    Commands::Options options;
    options.icon = iconName;
    options.shortcut = keys;
    options.menu = menu;
    return studio.commands.add(id, text, options, std::move(run));
}

void addStop(Studio& studio) {
    QAction* stop = addShellAction(studio, "loop.stop", "STOP: hold the show, let all servos go", "stop", {},
                                   "Hardware", [&studio] { studio.loop.stop(); });
    stop->setToolTip(kStopPromise);
    QAction* resume = addShellAction(studio, "loop.resume", "Resume after STOP", "play", {}, "Hardware",
                                     [&studio] { studio.loop.resume(); });
    resume->setToolTip(kResumePromise);
    const auto follow = [&studio, resume] { resume->setEnabled(studio.loop.stopped()); };
    QObject::connect(&studio.loop, &StudioLoop::stoppedChanged, resume, follow);
    follow();
}

void addTheme(Studio& studio) {
    QAction* theme = addShellAction(studio, "view.theme", {}, "sun", {}, "View", [&studio] {
        studio.settings.setTheme(studio.settings.theme() == Theme::dark ? Theme::light : Theme::dark);
    });
    const auto follow = [&studio, theme] {
        const bool dark = studio.settings.theme() == Theme::dark;
        theme->setText(dark ? "&Light theme" : "Dark &theme");
        theme->setIcon(icon(dark ? "sun" : "moon"));
    };
    QObject::connect(&studio.settings, &Settings::themeChanged, theme, follow);
    follow();
}

/// Names the language that it leads to, in that language.
void addLanguage(Studio& studio) {
    QAction* language = addShellAction(studio, "view.language", {}, "", {}, "View", [&studio] {
        const bool german = studio.settings.language() == Language::german;
        studio.settings.setLanguage(german ? Language::english : Language::german);
    });
    language->setToolTip("The language of what visitors read: applications, their cards and their help");
    const auto follow = [&studio, language] {
        const bool german = studio.settings.language() == Language::german;
        language->setText(german ? "Language for visitors: &English" : "Language for visitors: &Deutsch");
    };
    QObject::connect(&studio.settings, &Settings::languageChanged, language, follow);
    follow();
}

/// What applications let be heard.
void addSound(Studio& studio) {
    constexpr double kStep = 0.1;
    Settings& settings = studio.settings;
    Commands::Options options;
    options.icon = "sound";
    options.menu = "View";
    options.checkable = true;
    QAction* sound =
        studio.commands.add("view.sound.on", "S&ound", options, [&settings] { settings.setSound(!settings.sound()); });
    sound->setToolTip("What applications let be heard");
    const auto by = [&settings](double step) {
        settings.setSound(true); // whoever turns it up wants to hear it
        settings.setLoudness(settings.loudness() + step);
    };
    QAction* louder = addShellAction(studio, "view.sound.louder", "Lou&der", "louder", {}, "View", [by] { by(kStep); });
    QAction* quieter =
        addShellAction(studio, "view.sound.quieter", "&Quieter", "quieter", {}, "View", [by] { by(-kStep); });
    const auto follow = [&settings, sound, louder, quieter] {
        sound->setChecked(settings.sound());
        louder->setEnabled(!settings.sound() || settings.loudness() < 1.0);
        quieter->setEnabled(settings.sound() && settings.loudness() > kStep);
        const QString percent = QString("Now at %1 %").arg(std::lround(100.0 * settings.loudness()));
        louder->setToolTip(percent);
        quieter->setToolTip(percent);
    };
    QObject::connect(&settings, &Settings::soundChanged, sound, follow);
    follow();
}

void addView(Studio& studio, QMainWindow& window, const ShellActions& does) {
    int number = 1;
    for (const auto& [title, show] : does.workspaces) {
        const QString id = "workspace." + QString::number(number);
        const QKeySequence keys(Qt::CTRL | static_cast<Qt::Key>(Qt::Key_0 + number++));
        addShellAction(studio, id.toLatin1().constData(), title + " workspace", "", keys, "View", show);
    }
    addShellAction(studio, "view.commandPalette", "&Search commands", "search", QKeySequence(Qt::CTRL | Qt::Key_K),
                   "View", [&studio, &window] { toggleCommandPalette(window, studio.commands); });
    addTheme(studio);
    addLanguage(studio);
    addSound(studio);
    Commands::Options options;
    options.icon = "frame";
    options.shortcut = QKeySequence(Qt::Key_F11);
    options.menu = "View";
    options.checkable = true;
    studio.commands.add("view.fullScreen", "&Full screen", options,
                        [&window] { window.isFullScreen() ? window.showNormal() : window.showFullScreen(); });
    addShellAction(studio, "view.kiosk", "&Kiosk for visitors...", "lock", {}, "View", does.enterKiosk)
        ->setToolTip("Full screen with the view and STOP alone; the operator leaves by a PIN");
    addShellAction(studio, "view.resetLayout", "&Reset layout", "reset", {}, "View", does.resetLayout);
}

} // namespace

void addShellCommands(Studio& studio, QMainWindow& window, const ShellActions& does) {
    addUndoCommands(studio, window, *does.stacks, does.present);
    addShellAction(studio, "settings", "&Settings...", "settings", QKeySequence(Qt::CTRL | Qt::Key_Comma), "Edit",
                   [&studio, &window] { openSettings(studio, window); });
    addShellAction(studio, "settings.pin", "Operator's &PIN...", "lock", {}, "Edit", does.changePin)
        ->setToolTip("Choose the number by which one leaves the kiosk");
    addShellAction(studio, "applications", "A&pplications...", "grid", QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_A),
                   "File", does.showApplications)
        ->setToolTip("All that visitors can play, to choose from");
    addView(studio, window, does);
    addStop(studio);
    addDriverCommands(studio);
    addShellAction(studio, "help.guide", "&Guide", "help", QKeySequence(Qt::Key_F1), "Help",
                   [&window] { openGuide(window); });
    addShellAction(studio, "help.tour", "&Tour", "tour", {}, "Help", does.startTour);
    addShellAction(studio, "help.shortcuts", "&Keyboard and mouse", "", QKeySequence(Qt::SHIFT | Qt::Key_F1), "Help",
                   [&studio, &window] { openShortcuts(studio, window); });
    addShellAction(studio, "help.about", "&About Lumorph", "info", {}, "Help", [&window] { openAbout(window); });
}

} // namespace lumorph::studio
