#include "app/studio/shell/loop_rest.h"

namespace lumorph::studio {

LoopRest::LoopRest(Studio& studio, QObject* parent) : QObject(parent), studio_(studio) {
    connect(&studio.show, &ShowFeed::wantedChanged, this, &LoopRest::follow);
    connect(&studio.devices, &DeviceService::changed, this, &LoopRest::follow);
    connect(&studio.recorder, &RecordingService::changed, this, &LoopRest::follow);
    connect(&studio.trackers, &TrackerService::changed, this, &LoopRest::follow);
    connect(&studio.jobs, &Jobs::started, this, &LoopRest::follow);
    connect(&studio.jobs, &Jobs::finished, this, &LoopRest::follow);
}

void LoopRest::setSeen(bool seen) {
    seen_ = seen;
    follow();
}

void LoopRest::follow() { studio_.loop.setPaused(!isFollowed()); }

bool LoopRest::isFollowed() const {
    return seen_ || studio_.show.isWanted() || studio_.devices.status().phase != LinkPhase::off ||
           studio_.recorder.phase() != RecordingService::Phase::idle || !studio_.trackers.trackers().empty() ||
           !studio_.jobs.running().empty();
}

} // namespace lumorph::studio
