#pragma once

#include <functional>
#include <vector>

#include <QAction>
#include <QKeySequence>
#include <QObject>
#include <QString>
#include <QStringList>

namespace lumorph::studio {

/// Something that can be found by its name beside commands: an object of the scene, a rig, a target.
struct Findable {
    QString title;
    QString kind;      ///< what it is, in a word: "Target"
    QString icon;      ///< may be empty
    QString workspace; ///< id of the one in which it is seen; empty: any
    std::function<void()> choose;
};

/// The menus, in the order of the work. None is called as a workspace is: those are the tabs beside them.
inline const QStringList kMenus{"File", "Edit", "View", "Target", "Actuators", "Things", "Hardware", "Help"};

/// Everything the user can do, by name: menus, shortcuts and the command palette show these.
class Commands : public QObject {
    Q_OBJECT
public:
    using QObject::QObject;

    struct Options {
        QString icon;
        QKeySequence shortcut;
        QString menu;      ///< one of kMenus; empty: palette only
        QString workspace; ///< id of the workspace it belongs to; empty: always there
        bool checkable = false;
    };
    /// `id` such as "target.open" becomes the action's objectName.
    QAction* add(const QString& id, const QString& text, const Options& options, std::function<void()> run);
    [[nodiscard]] QAction* find(const QString& id) const; ///< null when there is none
    struct Entry {
        QAction* action = nullptr;
        Options options;
    };
    [[nodiscard]] const std::vector<Entry>& all() const noexcept { return entries_; }

    /// `find` is asked at each search; what it tells of may change. It lives as long as this does.
    void addFinder(std::function<std::vector<Findable>()> find);
    /// All that the finders know now, in the order in which they were added.
    [[nodiscard]] std::vector<Findable> findables() const;
    /// Shows the workspace of what was found, and chooses it there.
    void choose(const Findable& found);

signals:
    void added(QAction* action);
    void workspaceWanted(const QString& id);

private:
    std::vector<Entry> entries_;
    std::vector<std::function<std::vector<Findable>()>> finders_;
};

} // namespace lumorph::studio
