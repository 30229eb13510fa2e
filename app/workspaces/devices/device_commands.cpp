#include "app/workspaces/devices/device_commands.h"

#include <filesystem>

#include <QApplication>
#include <QDesktopServices>
#include <QUrl>

#include "app/workspaces/common/export_dialogs.h"
#include "app/workspaces/devices/servo_board.h"
#include "app/workspaces/devices/tracker_commands.h"
#include "devices/firmware/pin_header.h"
#include "devices/firmware/sketch.h"

namespace lumorph::studio {
namespace {

constexpr auto kFirstAddress = "sim://tablet";
constexpr auto kMenu = "Hardware";
constexpr auto kPlace = "devices"; // of notices and jobs
constexpr auto kSketch = "The board's sketch";

QAction* addDeviceAction(Studio& studio, const char* id, const QString& text, const char* icon, const QString& tip,
                         std::function<void()> run, const QKeySequence& keys = {}, bool here = false) {
    Commands::Options options;
    options.icon = icon;
    options.menu = kMenu;
    options.shortcut = keys;
    options.workspace = here ? QString("devices") : QString();
    QAction* action = studio.commands.add(id, text, options, std::move(run));
    action->setToolTip(tip);
    return action;
}

void connectUsual(Studio& studio) {
    const std::string& address = studio.devices.profile().address;
    if (address.empty())
        studio.devices.connectTo(kFirstAddress);
    else
        studio.devices.connectTo(QString::fromStdString(address), studio.devices.profile().controller);
}

void doNext(Studio& studio) {
    switch (cardOf(deviceViewOf(studio)).step) {
    case DeviceCard::Step::openRig:
        if (QAction* open = studio.commands.find("rig.open")) open->trigger();
        break;
    case DeviceCard::Step::connect:
        connectUsual(studio);
        break;
    case DeviceCard::Step::confirm:
        studio.devices.confirm();
        break;
    case DeviceCard::Step::start:
    case DeviceCard::Step::startAgain:
    case DeviceCard::Step::startAnyway:
        studio.devices.askStart();
        break;
    case DeviceCard::Step::none:
        break;
    }
}

Notice writtenNotice(const std::filesystem::path& folder) {
    const QString place = QString::fromStdString(folder.string());
    const QString name = QString::fromStdString(folder.filename().string());
    Notice notice;
    notice.level = Notice::Level::info;
    notice.subject = kSketch;
    notice.why = "The whole sketch is in " + place;
    notice.remedy = "Open " + name + ".ino there in the Arduino IDE and upload it to the board";
    notice.actions.push_back({"Open its folder", [place] { QDesktopServices::openUrl(QUrl::fromLocalFile(place)); }});
    return notice;
}

void writeSketchInto(Studio& studio, const std::filesystem::path& parent) {
    studio.jobs.run<std::filesystem::path>(
        kPlace, "Writing the sketch",
        [profile = studio.devices.profile(), parent](const Progress&) { return writeSketch(profile, parent); },
        [&studio](const std::filesystem::path& folder) { studio.notices.post(kPlace, writtenNotice(folder)); },
        [&studio](const std::exception& error) { studio.notices.post(kPlace, noticeOf(error)); });
}

void askForSketch(Studio& studio) {
    try {
        (void)channelsHeader(studio.devices.profile()); // what the board cannot do is said before a folder is asked for
    } catch (const std::exception& error) {
        return studio.notices.post(kPlace, noticeOf(error));
    }
    askFolder(QApplication::activeWindow(), studio.settings, "device.firmware", "Where to put the folder of the sketch",
              [&studio](const QString& folder) { writeSketchInto(studio, folder.toStdString()); });
}

bool isOff(const LinkStatus& link) { return link.phase == LinkPhase::off; }
bool canStart(const LinkStatus& link) { return link.phase == LinkPhase::disarmed || link.phase == LinkPhase::stopped; }
bool isDriven(const LinkStatus& link) { return link.phase == LinkPhase::starting || link.phase == LinkPhase::live; }

void addSlow(Studio& studio) {
    Commands::Options options;
    options.icon = "speed";
    options.menu = kMenu;
    options.checkable = true;
    QAction* slow = studio.commands.add("device.slow", "Slow servos", options,
                                        [&studio] { studio.devices.setSlow(!studio.devices.slow()); });
    slow->setToolTip("All servos move at a quarter of their speed, or as the profile says: for when hands are near");
    QObject::connect(&studio.devices, &DeviceService::changed, slow,
                     [slow, &studio] { slow->setChecked(studio.devices.slow()); });
}

} // namespace

void addDeviceCommands(Studio& studio) {
    QAction* next = addDeviceAction(
        studio, "device.next", "Next step", "play", "What the card over the servos offers",
        [&studio] { doNext(studio); }, QKeySequence(Qt::CTRL | Qt::Key_Return), true);
    QAction* open = addDeviceAction(studio, "device.connect", "Connect device", "link",
                                    "Connects to the device of last time, or to the simulated tablet",
                                    [&studio] { connectUsual(studio); });
    QAction* close = addDeviceAction(studio, "device.disconnect", "Disconnect device", "cancel",
                                     "Lets the servos go and the link too", [&studio] { studio.devices.disconnect(); });
    QAction* start =
        addDeviceAction(studio, "device.start", "Start servos...", "play",
                        "Shows what will move; a button that is held for a second starts them, one after the other",
                        [&studio] { studio.devices.askStart(); });
    QAction* release =
        addDeviceAction(studio, "device.release", "Let servos go", "pause",
                        "No pulses: the servos are limp, the link stays", [&studio] { studio.devices.release(); });
    addDeviceAction(
        studio, "device.bluetooth", "Search Bluetooth devices", "search", "Takes ten seconds or so",
        [&studio] { studio.devices.searchBluetooth(); }, {}, true);
    addDeviceAction(
        studio, "device.firmware", "Write the board's sketch...", "file",
        "The whole sketch for an Arduino Pro Mini, with the pins, limits and speed of this profile, into a folder that "
        "you choose",
        [&studio] { askForSketch(studio); }, {}, true);
    addSlow(studio);
    addTrackerCommands(studio);
    const auto follow = [=, &studio] {
        const LinkStatus& link = studio.devices.status();
        const bool rig = studio.document.state().rig.rig != nullptr;
        next->setEnabled(cardOf(deviceViewOf(studio)).step != DeviceCard::Step::none);
        open->setEnabled(rig && isOff(link));
        close->setEnabled(!isOff(link));
        start->setEnabled(canStart(link));
        release->setEnabled(isDriven(link));
    };
    QObject::connect(&studio.devices, &DeviceService::changed, next, follow);
    QObject::connect(&studio.devices, &DeviceService::profileChanged, next, follow);
    follow();
}

} // namespace lumorph::studio
