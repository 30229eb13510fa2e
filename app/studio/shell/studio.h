#pragma once

#include <functional>
#include <memory>
#include <string>

#include "app/studio/base/commands.h"
#include "app/studio/base/jobs.h"
#include "app/studio/base/notices.h"
#include "app/studio/base/settings.h"
#include "app/studio/base/studio_home.h"
#include "app/studio/calibration/lab_room.h"
#include "app/studio/calibration/watch_stand.h"
#include "app/studio/devices/device_service.h"
#include "app/studio/devices/gamepad_service.h"
#include "app/studio/devices/tracker_service.h"
#include "app/studio/document/installation_keeper.h"
#include "app/studio/document/keepsake_keeper.h"
#include "app/studio/document/project_service.h"
#include "app/studio/document/studio_document.h"
#include "app/studio/document/studio_loop.h"
#include "app/studio/output/projector_outputs.h"
#include "app/studio/recording/recording_service.h"
#include "app/studio/recording/replay_service.h"
#include "app/studio/rendering/render_thread.h"
#include "app/studio/rendering/show_feed.h"
#include "app/studio/shell/driver_control.h"
#include "app/studio/sound/sound_service.h"

namespace lumorph {
class CaptureCamera;
}

namespace lumorph::studio {

/// What every workspace may use; made once by the program, in this order.
struct Studio {
    Settings settings;
    StudioHome home{settings};
    Notices notices;
    Jobs jobs;
    StudioDocument document;
    StudioLoop loop{document};
    ProjectService project{document, jobs, notices};
    InstallationKeeper room{settings, document, project, notices};
    DeviceService devices{settings, document, loop, notices};
    TrackerService trackers{settings, loop, notices};
    LabRoom lab{settings, document, trackers};
    Commands commands;
    RenderThread renderer;
    ShowFeed show{loop, renderer, notices};
    ProjectorOutputs outputs{document, show, commands, notices};
    RecordingService recorder{settings, document, project, loop, devices, trackers, jobs, notices};
    ReplayService replay{document, project, loop, devices, jobs, notices};
    DriverControl driver{document, loop, replay};
    SoundService sound{settings, loop};
    GamepadService gamepads{loop};
    KeepsakeKeeper keepsakes{loop, notices};
    WatchBoard watch;
    /// Cameras that calibrate, by their addresses, in any thread; empty: those of this machine.
    std::function<std::unique_ptr<CaptureCamera>(const std::string& address)> openCamera;
};

} // namespace lumorph::studio
