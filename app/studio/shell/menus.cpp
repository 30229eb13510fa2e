#include "app/studio/shell/menus.h"

#include <algorithm>

#include <QMenu>

#include "app/studio/look/icons.h"
#include "app/studio/shell/file_commands.h"

namespace lumorph::studio {
namespace {

/// The order of the File menu, whatever was added first. What begins with a name stands with it.
const QStringList kFileOrder{"file.new",     "file.open",   "rig.open",   "file.save", "file.saveAs", "file.bringBack",
                             "applications", "demo.",       "labyrinth.", "rig.new",   "rig.draw",    "rig.save",
                             "record.",      "replay.open", "export.",    "room.",     "file.quit"};

int rankOf(const QString& id) {
    const auto found = std::find_if(kFileOrder.begin(), kFileOrder.end(), [&id](const QString& one) {
        return one.endsWith('.') ? id.startsWith(one) : id == one;
    });
    return static_cast<int>(found - kFileOrder.begin());
}

/// Commands of one kind stand together: "view.dock.target" is of the kind "view.dock".
QString kindOf(const QString& id) { return id.section('.', 0, -2); }

bool startsGroup(const QString& id, const QString& before) {
    if (id == "file.save" || id == "file.quit") return true;
    if (before.isEmpty() || id == "rig.open" || before == "applications") return false;
    return kindOf(before) != kindOf(id) && !(id == "replay.open" && before.startsWith("record."));
}

} // namespace

Menus::Menus(Studio& studio, QMenuBar& bar, QWidget& window) : QObject(&window), studio_(studio), window_(window) {
    recent_ = new QMenu("Open &recent", &window);
    recent_->setObjectName("file.openRecent");
    recent_->setIcon(icon("clock"));
    recent_->setToolTipsVisible(true);
    connect(recent_, &QMenu::aboutToShow, this, [this] { fillRecentMenu(studio_, *recent_); });
    for (const QString& name : kMenus) {
        QMenu* menu = bar.addMenu('&' + name);
        menu->setObjectName("menu." + name);
        menu->setToolTipsVisible(true);
        menus_[name] = menu;
    }
    for (const auto& entry : studio.commands.all()) window.addAction(entry.action);
    for (const QString& name : kMenus) fill(name);
    connect(&studio.commands, &Commands::added, this, &Menus::join);
    follow();
}

void Menus::join(QAction* action) {
    window_.addAction(action);
    for (const auto& entry : studio_.commands.all())
        if (entry.action == action) fill(entry.options.menu);
    follow();
}

void Menus::fill(const QString& name) {
    const auto found = menus_.find(name);
    if (found == menus_.end()) return;
    std::vector<QAction*> actions;
    for (const auto& entry : studio_.commands.all())
        if (entry.options.menu == name) actions.push_back(entry.action);
    if (name == "File")
        std::ranges::stable_sort(actions, {}, [](const QAction* action) { return rankOf(action->objectName()); });
    QMenu& menu = *found->second;
    menu.clear();
    QString before;
    for (QAction* action : actions) {
        const QString id = action->objectName();
        if (!menu.isEmpty() && startsGroup(id, before)) {
            if (id == "file.save") menu.addMenu(recent_);
            menu.addSeparator();
        }
        menu.addAction(action);
        before = id;
    }
}

void Menus::show(const QString& workspace) {
    workspace_ = workspace;
    follow();
}

void Menus::setShut(bool shut) {
    shut_ = shut;
    follow();
}

void Menus::follow() {
    for (const auto& entry : studio_.commands.all())
        entry.action->setVisible(!shut_ &&
                                 (entry.options.workspace.isEmpty() || entry.options.workspace == workspace_));
    for (const auto& [name, menu] : menus_) {
        const auto actions = menu->actions();
        menu->menuAction()->setVisible(std::ranges::any_of(
            actions, [](const QAction* action) { return action->isVisible() && !action->isSeparator(); }));
    }
}

} // namespace lumorph::studio
