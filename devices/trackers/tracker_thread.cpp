#include "devices/trackers/tracker_thread.h"

#include <exception>
#include <future>
#include <utility>

#include <QCoreApplication>
#include <QEventLoop>
#include <QTimer>

#include "core/base/error.h"
#include "devices/trackers/tracker_address.h"

namespace lumorph {

TrackerThread::TrackerThread(std::shared_ptr<TrackerLog> log, std::function<std::unique_ptr<TrackerWork>()> make,
                             std::chrono::milliseconds step)
    : log_(std::move(log)) {
    if (QCoreApplication::instance() == nullptr)
        throw InvalidInput("tracker", "events of sockets need a QCoreApplication", "make one before");
    auto begun = std::make_shared<std::promise<void>>();
    std::future<void> beginning = begun->get_future();
    thread_.reset(QThread::create([begun, make = std::move(make), step] {
        std::unique_ptr<TrackerWork> work;
        try {
            work = make();
        } catch (...) {
            begun->set_exception(std::current_exception());
            return;
        }
        QTimer timer;
        timer.setTimerType(Qt::PreciseTimer);
        QObject::connect(&timer, &QTimer::timeout, &timer, [&work] { work->tick(); });
        timer.start(step);
        begun->set_value();
        work->tick();
        QEventLoop().exec();
    }));
    thread_->start();
    try {
        beginning.get();
    } catch (...) {
        thread_->wait();
        throw;
    }
}

TrackerThread::~TrackerThread() {
    thread_->quit();
    thread_->wait();
}

std::unique_ptr<Tracker> openTracker(std::string_view uri, TrackerOptions options) {
    const std::string text(uri);
    const TrackerAddress address = parseTrackerAddress(uri);
    if (const auto* natnet = std::get_if<NatNetAddress>(&address)) return openNatNet(*natnet, text, std::move(options));
    if (const auto* openTrack = std::get_if<OpenTrackAddress>(&address))
        return openOpenTrack(*openTrack, text, std::move(options));
    if (const auto* osc = std::get_if<OscAddress>(&address)) return openOsc(*osc, text, std::move(options));
    return openSimulated(std::get<SimulatedBodyAddress>(address), text, std::move(options));
}

} // namespace lumorph
