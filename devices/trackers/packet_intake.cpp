#include "devices/trackers/packet_intake.h"

#include <utility>

namespace lumorph {

namespace {

constexpr Microseconds kLookEvery{5'000'000};

} // namespace

PacketIntake::PacketIntake(const TrackerOptions& options, std::shared_ptr<TrackerLog> log)
    : log_(std::move(log)), onFrame_(options.onFrame), gate_(options.openToNetwork), opened_(options.clock->now()),
      nextLook_(opened_ + kLookEvery) {}

bool PacketIntake::admit(const QHostAddress& sender, Microseconds now) {
    if (!gate_.lets(sender)) {
        ++dropped_;
        droppedAt_ = now;
        lastDropped_ = sender.toString().toStdString();
        return false;
    }
    log_->notePacket();
    return true;
}

void PacketIntake::reject(const std::string& why, Microseconds now) {
    rejected_ = now;
    lastRejected_ = why;
    log_->noteRejected(why);
}

void PacketIntake::reject(const std::string& why, const QHostAddress& sender, quint16 port, Microseconds now) {
    reject("from " + sender.toString().toStdString() + " port " + std::to_string(port) + ": " + why, now);
}

void PacketIntake::deliver(const TrackerFrame& frame, std::optional<double> latencyMilliseconds) {
    frame_ = frame.arrived;
    log_->noteFrame(frame, latencyMilliseconds);
    if (onFrame_) onFrame_(frame);
}

void PacketIntake::tick(Microseconds now) {
    if (now < nextLook_) return;
    nextLook_ = now + kLookEvery;
    gate_.refresh();
}

TrackerSituation PacketIntake::situation(Microseconds now) const {
    const auto since = [now](const std::optional<Microseconds>& then) {
        return then ? std::optional(now - *then) : std::nullopt;
    };
    TrackerSituation s;
    s.openToNetwork = gate_.isOpen();
    s.ownAddresses = listOf(gate_.own());
    s.sinceOpened = now - opened_;
    s.sinceFrame = since(frame_);
    s.sinceRejected = since(rejected_);
    s.lastRejected = lastRejected_;
    s.dropped = dropped_;
    s.lastDropped = lastDropped_;
    s.sinceDropped = since(droppedAt_);
    return s;
}

} // namespace lumorph
