#pragma once

#include <optional>
#include <vector>

#include <QString>

#include "app/studio/base/commands.h"

namespace lumorph::studio {

/// How well typed letters fit a text; larger is better. Letters must come in order; those at the start of words and
/// next to each other count more. Empty when they do not fit; 0 for nothing typed.
[[nodiscard]] std::optional<double> searchScore(const QString& typed, const QString& text);

/// What a command is called in lists: without mnemonic and dots.
[[nodiscard]] QString commandTitle(const QAction& action);

/// Commands that can be seen now and fit what is typed, by their names, their menus or other words for them, best
/// first; of equal ones in the order they were added.
[[nodiscard]] std::vector<Commands::Entry> searchCommands(const Commands& commands, const QString& typed);

/// A command, or something else that has a name.
struct Found {
    QAction* action = nullptr; ///< null: it is `thing`
    QString menu;              ///< of the command
    Findable thing;
};
/// Both in one order. Where nothing is typed only commands are listed.
[[nodiscard]] std::vector<Found> searchAll(const Commands& commands, const QString& typed);

} // namespace lumorph::studio
