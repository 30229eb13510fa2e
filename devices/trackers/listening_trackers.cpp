// Trackers that send on their own account to a port of ours: opentrack and OSC.
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "devices/protocol/opentrack.h"
#include "devices/protocol/osc_pose.h"
#include "devices/trackers/osc_bodies.h"
#include "devices/trackers/packet_intake.h"
#include "devices/trackers/tracker_thread.h"

namespace lumorph {

namespace {

constexpr std::chrono::milliseconds kListeningStep{100};

/// Listens to one port; what is read from packets is the business of the kind.
class ListeningWork : public TrackerWork {
public:
    ListeningWork(const std::string& local, std::uint16_t port, std::shared_ptr<TrackerLog> log, TrackerOptions options)
        : log_(std::move(log)), options_(std::move(options)), intake_(options_, log_),
          port_(UdpBinding{bindingOf(local, intake_.gate()), port},
                [this](std::span<const std::byte> bytes, const QHostAddress& sender, quint16 from) {
                    take(bytes, sender, from);
                }) {}

    void tick() override {
        const Microseconds now = options_.clock->now();
        intake_.tick(now);
        log_->setAdvice(advice(intake_.situation(now)));
    }

protected:
    /// The frame that a packet completes, or none yet; what of it cannot be used is added to `refused`. Throws
    /// DataError.
    virtual const TrackerFrame* read(std::span<const std::byte> bytes, Microseconds now,
                                     std::vector<std::string>& refused) = 0;
    [[nodiscard]] virtual std::string advice(const TrackerSituation& situation) const = 0;
    [[nodiscard]] virtual std::string protocol() const = 0;

private:
    /// Loopback, whatever the address says, unless the user opened the way.
    static QHostAddress bindingOf(const std::string& local, const PacketGate& gate) {
        if (!gate.isOpen()) return QHostAddress::LocalHost;
        const QHostAddress address(QString::fromStdString(local));
        return address.isLoopback() ? QHostAddress(QHostAddress::AnyIPv4) : address;
    }

    void take(std::span<const std::byte> bytes, const QHostAddress& sender, quint16 port) {
        const Microseconds now = options_.clock->now();
        if (!intake_.admit(sender, now)) return;
        try {
            std::vector<std::string> refused;
            const TrackerFrame* frame = read(bytes, now, refused);
            for (const std::string& why : refused) intake_.reject(why, sender, port, now);
            if (frame == nullptr) return refused.empty() ? log_->noteAnswer() : void();
            if (sender != source_) {
                source_ = sender;
                log_->setSource(protocol() + " from " + sender.toString().toStdString(), true);
            }
            intake_.deliver(*frame, std::nullopt);
        } catch (const DataError& error) {
            intake_.reject(error.what(), sender, port, now);
        }
    }

    std::shared_ptr<TrackerLog> log_;
    TrackerOptions options_;
    PacketIntake intake_;
    QHostAddress source_;
    UdpPort port_;
};

class OpenTrackWork final : public ListeningWork {
public:
    OpenTrackWork(const OpenTrackAddress& address, std::shared_ptr<TrackerLog> log, TrackerOptions options)
        : ListeningWork(address.local, address.port, std::move(log), std::move(options)), address_(address) {
        frame_.bodies = {{0, "head", true, {}}};
    }

private:
    const TrackerFrame* read(std::span<const std::byte> bytes, Microseconds now, std::vector<std::string>&) override {
        frame_.bodies.front().pose = opentrack::poseOf(opentrack::readPacket(bytes));
        frame_.measured = frame_.arrived = now;
        ++frame_.number;
        return &frame_;
    }
    [[nodiscard]] std::string advice(const TrackerSituation& situation) const override {
        return adviceFor(address_, situation);
    }
    [[nodiscard]] std::string protocol() const override { return "opentrack"; }

    OpenTrackAddress address_;
    TrackerFrame frame_;
};

class OscWork final : public ListeningWork {
public:
    OscWork(const OscAddress& address, std::shared_ptr<TrackerLog> log, TrackerOptions options)
        : ListeningWork(address.local, address.port, std::move(log), std::move(options)), address_(address) {}

private:
    const TrackerFrame* read(std::span<const std::byte> bytes, Microseconds now,
                             std::vector<std::string>& refused) override {
        return bodies_.take(osc::readPoseParts(bytes, &refused), now);
    }
    [[nodiscard]] std::string advice(const TrackerSituation& situation) const override {
        return adviceFor(address_, situation, bodies_.onlyRotations());
    }
    [[nodiscard]] std::string protocol() const override { return "OSC"; }

    OscAddress address_;
    OscBodies bodies_;
};

} // namespace

std::unique_ptr<Tracker> openOpenTrack(const OpenTrackAddress& address, const std::string& uri,
                                       TrackerOptions options) {
    auto log = std::make_shared<TrackerLog>(uri, options.clock);
    return std::make_unique<TrackerThread>(
        log, [=] { return std::make_unique<OpenTrackWork>(address, log, options); }, kListeningStep);
}

std::unique_ptr<Tracker> openOsc(const OscAddress& address, const std::string& uri, TrackerOptions options) {
    auto log = std::make_shared<TrackerLog>(uri, options.clock);
    return std::make_unique<TrackerThread>(
        log, [=] { return std::make_unique<OscWork>(address, log, options); }, kListeningStep);
}

} // namespace lumorph
