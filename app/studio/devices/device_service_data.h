#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <vector>

#include <QDateTime>
#include <QElapsedTimer>
#include <QTimer>

#include "app/studio/devices/device_finder.h"
#include "app/studio/devices/device_service.h"
#include "app/studio/devices/rig_profiles.h"
#include "app/studio/devices/servo_feed.h"
#include "devices/simulator/simulated_bench.h"

namespace lumorph::studio {

/// What a DeviceService holds. Private to device_service*.cpp.
struct DeviceService::Data {
    Data(DeviceService& owner, Settings& userSettings, StudioDocument& openDocument, StudioLoop& studioLoop,
         Notices& allNotices)
        : service(owner), document(openDocument), loop(studioLoop), notices(allNotices), profiles(userSettings) {}

    void listen();
    void follow(const MatchFrame& frame); ///< in the loop's thread
    void takeRig();
    void use(DeviceProfile next);
    bool force(const DeviceProfile& next);
    void keep();
    void makeLink();
    void traceLink();
    void retire();
    void leaveAll();
    void onLinkChanged(); ///< in the link's thread
    void take();
    void takeEvents();
    void tellAll(const std::vector<LinkEvent>& events);
    void onResumed();
    void identifyBoard();
    bool sense();
    void tellSearch(const LinkTrouble& trouble);
    void tick();

    DeviceService& service;
    StudioDocument& document;
    StudioLoop& loop;
    Notices& notices;
    RigProfiles profiles;
    std::unique_ptr<SimulatedBench> bench = std::make_unique<SimulatedBench>();
    std::shared_ptr<const Rig> rig;
    std::shared_ptr<const Rig> origin; ///< of the rig, the same for its edits
    DeviceProfile profile;
    HandWatch handWatch;
    HandSense hands;
    ServoFeed feed;
    int tap = 0;
    std::function<void(const ServoTraceRow&)> trace;
    std::shared_ptr<std::atomic<bool>> tracing; ///< false for a link that is no longer the present one
    std::shared_ptr<ServoLink> link;
    std::vector<std::future<void>> leaving; ///< links that go to rest; waiting for them would block the window
    LinkStatus status;
    DeviceFinder finder{*bench};
    DeviceLog log;
    std::atomic<bool> posted = false; ///< the window has been told of a change that it did not take yet
    QTimer due, poll, testTimer;
    QElapsedTimer sinceTest;
    QDateTime liveSince;
    QString stopKeysProblem; ///< why
    bool slow = false;
};

} // namespace lumorph::studio
