#pragma once

#include <functional>
#include <vector>

#include <QAction>
#include <QKeySequence>
#include <QObject>
#include <QString>
#include <QStringList>

namespace lumorph::studio {

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

signals:
    void added(QAction* action);

private:
    std::vector<Entry> entries_;
};

} // namespace lumorph::studio
