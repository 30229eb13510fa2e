#pragma once

#include <memory>

#include "app/studio/shell/main_window.h"
#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// How the program ends. Whatever asks for it, servos leave before anything is kept:
/// - SIGINT, SIGTERM, SIGHUP and SIGQUIT close the window, as its user does. Where the window does not answer within
///   half a second, servos are let go without it. A second one lets them go at once and ends the program; but not a
///   second SIGHUP, since a terminal that closes sends two.
/// - Qt and Xlib call exit() when the display is lost: servos are let go, and the session is kept.
/// What leaves no time for that (a crash, SIGKILL) is the matter of the link's failsafe process. Lives in the window's
/// thread; one a program.
class WayOut {
public:
    WayOut(MainWindow& window, Studio& studio);
    ~WayOut();
    WayOut(const WayOut&) = delete;
    WayOut& operator=(const WayOut&) = delete;

    /// Runs the program until its window is closed and its servos have left.
    int exec();

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::studio
