#include "app/studio/base/commands.h"

#include <algorithm>

#include "app/studio/look/icons.h"

namespace lumorph::studio {

QAction* Commands::add(const QString& id, const QString& text, const Options& options, std::function<void()> run) {
    auto* action = new QAction(text, this);
    action->setObjectName(id);
    action->setCheckable(options.checkable);
    action->setShortcut(options.shortcut);
    if (!options.icon.isEmpty()) action->setIcon(icon(options.icon));
    connect(action, &QAction::triggered, this, [run = std::move(run)] {
        if (run) run();
    });
    entries_.push_back({action, options});
    connect(action, &QObject::destroyed, this, [this, action] {
        std::erase_if(entries_, [action](const Entry& entry) { return entry.action == action; });
    });
    emit added(action);
    return action;
}

void Commands::addFinder(std::function<std::vector<Findable>()> find) { finders_.push_back(std::move(find)); }

std::vector<Findable> Commands::findables() const {
    std::vector<Findable> all;
    for (const auto& find : finders_)
        for (Findable& one : find()) all.push_back(std::move(one));
    return all;
}

void Commands::choose(const Findable& found) {
    if (!found.workspace.isEmpty()) emit workspaceWanted(found.workspace);
    if (found.choose) found.choose();
}

QAction* Commands::find(const QString& id) const {
    for (const Entry& entry : entries_)
        if (entry.action->objectName() == id) return entry.action;
    return nullptr;
}

} // namespace lumorph::studio
