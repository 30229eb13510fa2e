#pragma once

#include <QMainWindow>
#include <QPointer>
#include <QTimer>

#include "app/studio/shell/studio.h"
#include "app/studio/shell/workspace.h"

class QDockWidget;

namespace lumorph::studio {

/// The page of one workspace: its central view with its docks around, and their layout, which is remembered. Docks that
/// float are hidden with the page and come back with it.
class WorkspacePage : public QMainWindow {
    Q_OBJECT
public:
    /// Makes view and docks. `settings` and `commands` outlive the page.
    WorkspacePage(Workspace& workspace, Settings& settings, Commands& commands, QWidget* parent);

    [[nodiscard]] const std::vector<QDockWidget*>& docks() const noexcept { return docks_; }
    /// Shows or hides what belongs to the page beside itself, and tells the workspace.
    void setActive(bool active);
    /// Whether the window's views can be seen; at first they can.
    void setInSight(bool inSight);
    void keepLayout();
    void resetLayout();
    /// Only the central view, as visitors may see it; nothing of it is remembered. Or all as it was.
    void setKiosk(bool on);
    /// Whether visitors find something in it.
    [[nodiscard]] bool hasVisitors() const noexcept { return hasVisitors_; }

protected:
    void showEvent(QShowEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;

private:
    void addDock(const WorkspaceDock& brought, QDockWidget* before);
    void addCommands(Commands& commands, QDockWidget* dock, const WorkspaceDock& brought);
    void applyFirstSizes();
    void fitColumns();
    void restore(const QByteArray& layout);
    void restoreInRoom();

    Workspace& workspace_;
    Settings& settings_;
    std::vector<QDockWidget*> docks_;
    std::vector<QPointer<QDockWidget>> hiddenFloats_;
    QByteArray firstLayout_;
    QByteArray wideLayout_; ///< what it was before the window became narrow; empty while it is wide
    QByteArray restored_;   ///< given back at every size until the page has the room that it is for
    QTimer settled_;        ///< the page has it
    bool sized_ = false;    ///< the docks' first widths were given
    bool active_ = false;
    bool inSight_ = true;
    bool kiosk_ = false;
    bool hasVisitors_ = false;
    QByteArray kioskLayout_; ///< what it was before
};

} // namespace lumorph::studio
