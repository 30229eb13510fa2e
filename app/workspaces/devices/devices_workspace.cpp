#include "app/workspaces/devices/devices_workspace.h"

#include "app/workspaces/devices/device_commands.h"
#include "app/workspaces/devices/devices_docks.h"
#include "app/workspaces/devices/servo_board.h"
#include "app/workspaces/devices/start_panel.h"

namespace lumorph::studio {

DevicesWorkspace::DevicesWorkspace(Studio& studio) : studio_(studio) {
    studio.devices.setPoses(studio.trackers.poses());
    addDeviceCommands(studio);
    connect(&studio.devices, &DeviceService::startAsked, this, [this](DeviceService::StartBy by) {
        // Here the question stands over the servos already; the board gives it the keyboard.
        const bool here = active_ && by == DeviceService::StartBy::show && cardOf(deviceViewOf(studio_)).starts();
        if (!here) openStartDialog(studio_, by);
    });
}

QUndoStack* DevicesWorkspace::undoStack() { return &studio_.devices.undoStack(); }

QString DevicesWorkspace::id() const { return "devices"; }
QString DevicesWorkspace::title() const { return "Devices"; }

QWidget* DevicesWorkspace::makeCentralView() { return makeServoBoard(studio_, selection_); }

std::vector<WorkspaceDock> DevicesWorkspace::makeDocks() {
    return {
        {"dock.devices.found", "Devices", "device", makeFoundDock(studio_), Qt::LeftDockWidgetArea, false},
        {"dock.devices.trackers", "Trackers", "eye", makeTrackersDock(studio_), Qt::LeftDockWidgetArea, true},
        {"dock.devices.servo", "Servo", "actuator", makeServoDock(studio_, selection_), Qt::RightDockWidgetArea, false},
        {"dock.devices.setup", "Set-up", "settings", makeSetupDock(studio_), Qt::RightDockWidgetArea, true},
        {"dock.devices.simulator", "Simulator", "lab", makeSimulatorDock(studio_), Qt::RightDockWidgetArea, true},
        {"dock.devices.log", "Log", "clock", makeDeviceLog(studio_), Qt::BottomDockWidgetArea, false}};
}

void DevicesWorkspace::setActive(bool active) {
    if (!active) {
        selection_.assign(std::nullopt);
        studio_.devices.endTest();
    }
    active_ = active;
}

void DevicesWorkspace::setSeen(bool seen) { studio_.devices.setShown(seen); }

} // namespace lumorph::studio
