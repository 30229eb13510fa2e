#include "app/workspaces/devices/tracker_commands.h"

#include <span>

#include <QApplication>

#include "app/workspaces/common/body_axes.h"
#include "app/workspaces/common/export_dialogs.h"
#include "calibration/tracking/board_address.h"
#include "calibration/tracking/board_page.h"
#include "core/base/atomic_file.h"

namespace lumorph::studio {
namespace {

void addTrackerAction(Studio& studio, const char* id, const QString& text, const char* icon, const QString& tip,
                      std::function<void()> run) {
    Commands::Options options;
    options.icon = icon;
    options.menu = "Hardware";
    studio.commands.add(id, text, options, std::move(run))->setToolTip(tip);
}

/// The board that is open, or else the one of an address that was open last.
MarkerBoard usualBoard(const TrackerService& trackers) {
    for (const QString& address : trackers.addresses()) {
        if (!isBoardAddress(address.toStdString())) continue;
        try {
            return parseBoardAddress(address.toStdString()).board;
        } catch (const std::exception&) { // as it was typed wrongly once
        }
    }
    return {};
}

void writeBoard(Studio& studio) {
    askFile(QApplication::activeWindow(), studio.settings, "tracker.board", "Write a marker board to print",
            "marker-board", {{"PDF of true size", "pdf"}}, [&studio](const QString& file) {
                try {
                    const std::string pdf = boardPdf(usualBoard(studio.trackers));
                    writeFileAtomically(file.toStdString(), std::as_bytes(std::span(pdf)));
                } catch (const std::exception& error) {
                    studio.notices.post("devices", noticeOf(error));
                }
            });
}

void openBoard(Studio& studio) {
    for (const QString& address : studio.trackers.addresses())
        if (isBoardAddress(address.toStdString())) return studio.trackers.open(address);
}

} // namespace

void addTrackerCommands(Studio& studio) {
    addTrackerAction(
        studio, "tracker.simulate", "Open a simulated head", "eye",
        "A head that moves by itself before the device, or as you drag it, to try the show without a tracker",
        [&studio] { studio.trackers.open("sim://head"); });
    addTrackerAction(studio, "tracker.simulateDevice", "Open a simulated device pose", "device",
                     "The device as a tracker would see it: drag and turn it in the view of the room",
                     [&studio] { studio.trackers.open("sim://device"); });
    addTrackerAction(studio, "tracker.camera", "Open a camera with a marker board", "picture",
                     "The camera and board used last, or the first camera that is there",
                     [&studio] { openBoard(studio); });
    addTrackerAction(studio, "tracker.board", "Write a marker board to print...", "grid",
                     "A page as PDF, at true size, with the measures of the board's address. Fix it flat to the device",
                     [&studio] { writeBoard(studio); });
    addBodiesCommand(studio);
}

} // namespace lumorph::studio
