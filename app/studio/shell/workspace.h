#pragma once

#include <filesystem>
#include <vector>

#include <QKeySequence>
#include <QObject>
#include <QString>
#include <QUndoStack>
#include <QWidget>

namespace lumorph::studio {

/// A dock that a workspace brings. The main window owns it once handed over.
struct WorkspaceDock {
    QString id;    ///< objectName, such as "dock.actuators"
    QString title; ///< what the user sees
    QString icon;
    QWidget* content = nullptr;
    Qt::DockWidgetArea area = Qt::LeftDockWidgetArea;
    bool tabbedWithPrevious = false; ///< behind the dock before it, in the first layout
    bool hiddenAtFirst = false;      ///< until the user, or a command, shows it
};

/// One of the tabs in the top bar: a central view, docks, and actions of its own. The main window never names a panel.
class Workspace : public QObject {
    Q_OBJECT
public:
    using QObject::QObject;
    ~Workspace() override = default;

    [[nodiscard]] virtual QString id() const = 0;    ///< "field"
    [[nodiscard]] virtual QString title() const = 0; ///< "Field"
    /// Made once, when the workspace is first shown; the main window takes them over.
    [[nodiscard]] virtual QWidget* makeCentralView() = 0;
    [[nodiscard]] virtual std::vector<WorkspaceDock> makeDocks() = 0;
    /// The one that is shown, or another one is.
    virtual void setActive(bool active) { static_cast<void>(active); }
    /// Whether its views can be seen: it is the one that is shown, and the window is neither minimised nor covered.
    /// What is not seen draws nothing.
    virtual void setSeen(bool seen) = 0;
    /// What undo and redo work on while it is shown, where that is not the document; null: the document.
    [[nodiscard]] virtual QUndoStack* undoStack() { return nullptr; }
    /// Visitors stand before it: its view without tools, handles and notices, or all again. False: it has nothing for
    /// visitors.
    virtual bool setForVisitors(bool on) {
        static_cast<void>(on);
        return false;
    }
    /// Files were dropped while it is shown; false: it has no use for them of its own.
    virtual bool takeDrop(const std::vector<std::filesystem::path>& files) {
        static_cast<void>(files);
        return false;
    }
};

} // namespace lumorph::studio
