#pragma once

#include <vector>

#include <QMenuBar>
#include <QPushButton>
#include <QToolButton>
#include <QWidget>

#include "app/studio/shell/kiosk.h"
#include "app/studio/shell/studio.h"
#include "app/studio/shell/workspace.h"

class QHBoxLayout;

namespace lumorph::studio {

class DriverChip;

/// The slim bar at the top: mark, workspaces, menus, undo and redo, search, theme, who moves the servos, and STOP,
/// which never leaves it.
class TopBar : public QWidget {
    Q_OBJECT
public:
    /// The commands applications, edit.undo, edit.redo, view.commandPalette, view.theme and those of the drivers must
    /// be there.
    TopBar(Studio& studio, const std::vector<std::unique_ptr<Workspace>>& workspaces, QWidget* parent);

    [[nodiscard]] QMenuBar& menuBar() noexcept { return *menus_; }
    void setWorkspace(const QString& id);
    /// Only the mark, STOP, and a way out stay, which is a lock for the operator where the doors are shut; or all
    /// again.
    void setForVisitors(bool on, bool locked);
    [[nodiscard]] Kiosk::Buttons kioskButtons() const noexcept { return {stop_, resume_, leave_}; }

signals:
    void workspaceChosen(const QString& id);
    void leaveWanted(); ///< by the way out, where it is not locked

protected:
    bool event(QEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;

private:
    void addTabs(const std::vector<std::unique_ptr<Workspace>>& workspaces, QHBoxLayout& row);
    void addLeave(QHBoxLayout& row);
    void addTools(QHBoxLayout& row);
    void addStop(QHBoxLayout& row);
    void showStopped();
    void fitSearch();

    Studio& studio_;
    QWidget* mark_ = nullptr;
    QMenuBar* menus_ = nullptr;
    std::vector<QToolButton*> tabs_;
    std::vector<QWidget*> tools_;
    bool forVisitors_ = false;
    DriverChip* driver_ = nullptr;
    std::vector<QPointer<QWidget>> shut_; ///< what visitors do not see
    QToolButton* leave_ = nullptr;
    QPushButton* search_ = nullptr;
    QPushButton* resume_ = nullptr;
    QPushButton* stop_ = nullptr;
};

} // namespace lumorph::studio
