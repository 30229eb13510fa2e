#pragma once

#include <memory>
#include <vector>

#include <QMainWindow>

#include "app/studio/shell/studio.h"
#include "app/studio/shell/workspace.h"

namespace lumorph {
struct Demo;
}

namespace lumorph::studio {

/// The one window: workspaces as tabs in a slim top bar, STOP always in sight, each workspace's docks and central view
/// below with a layout of their own, and the status line.
class MainWindow : public QMainWindow {
    Q_OBJECT
public:
    MainWindow(Studio& studio, std::vector<std::unique_ptr<Workspace>> workspaces);
    ~MainWindow() override;

    /// Does nothing when there is no such workspace.
    void showWorkspace(const QString& id);
    [[nodiscard]] QString workspace() const;
    /// The first-run tour, from its first step.
    void startTour();
    /// The cards of all applications, to choose from.
    void showApplications();
    /// Full screen with the view and STOP alone, which alone hear anything; a still pointer is hidden. Asks for a PIN
    /// where there is none yet; with it the operator leaves.
    void enterKiosk();
    /// Also out of a kiosk: for who ends the program from outside.
    void closeNow();

protected:
    void closeEvent(QCloseEvent* event) override;
    void dragEnterEvent(QDragEnterEvent* event) override;
    void dragLeaveEvent(QDragLeaveEvent* event) override;
    void dropEvent(QDropEvent* event) override;
    void changeEvent(QEvent* event) override;
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    void addCommands();
    void leaveKiosk();
    void openApplication(const Demo& demo);
    void enterFullView();
    void leaveFullView();
    void setForVisitors(bool on, bool locked);
    void showFirstWorkspace();
    void showTitle();
    [[nodiscard]] bool viewsSeen() const;
    void followSight();
    void keepOnScreen();
    void retheme();
    void acceptDrag(QDropEvent& event);

    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::studio
