#include <optional>
#include <utility>

#include "core/base/error.h"
#include "devices/trackers/natnet_client.h"
#include "devices/trackers/packet_intake.h"
#include "devices/trackers/tracker_address.h"
#include "devices/trackers/tracker_advice.h"
#include "devices/trackers/tracker_thread.h"

namespace lumorph {

namespace {

constexpr std::chrono::milliseconds kNatNetStep{100};
constexpr Microseconds kAgain{2'000'000};

QHostAddress hostOf(const std::string& text) { return QHostAddress(QString::fromStdString(text)); }

class NatNetWork final : public TrackerWork {
public:
    NatNetWork(NatNetAddress address, std::shared_ptr<TrackerLog> log, TrackerOptions options)
        : address_(std::move(address)), host_(hostOf(address_.host)), log_(std::move(log)),
          options_(std::move(options)), intake_(options_, log_),
          client_(!address_.multicast, address_.version, [this](std::span<const std::byte> bytes) { say(bytes); }) {
        if (!isLocalMissing()) openPorts();
    }

    void tick() override {
        const Microseconds now = options_.clock->now();
        intake_.tick(now);
        if (!command_) openLater(now);
        if (command_ && mayTalk()) client_.tick(now);
        log_->setAdvice(adviceFor(address_, situation(now)));
    }

private:
    [[nodiscard]] bool isHostHere() const { return intake_.gate().isOwn(host_); }
    [[nodiscard]] bool mayTalk() const { return isHostHere() || intake_.gate().isOpen(); }
    [[nodiscard]] bool isLocalMissing() const {
        return !address_.local.empty() && !intake_.gate().isOwn(hostOf(address_.local));
    }

    void openPorts() {
        const auto onPacket = [this](std::span<const std::byte> bytes, const QHostAddress& sender, quint16 port) {
            take(bytes, sender, port);
        };
        const QHostAddress local = address_.local.empty() ? QHostAddress() : hostOf(address_.local);
        // The server sends its answers, and in unicast its frames, to where it was asked from.
        const QHostAddress wide = local.isNull() ? QHostAddress(QHostAddress::AnyIPv4) : local;
        auto command = std::make_unique<UdpPort>(
            UdpBinding{intake_.gate().isOpen() ? wide : QHostAddress(QHostAddress::LocalHost)}, onPacket);
        std::unique_ptr<UdpPort> data;
        if (address_.multicast) {
            // What is sent to a group comes only to sockets that are bound to all or to the group.
            data = std::make_unique<UdpPort>(UdpBinding{hostOf(address_.group), address_.data, true}, onPacket);
            // The gate alone would not do: anyone on the network can forge the sender of a packet.
            data->join(hostOf(address_.group), intake_.gate().isOpen() ? local : QHostAddress(QHostAddress::LocalHost));
        } else if (address_.dataGiven) {
            data = std::make_unique<UdpPort>(
                UdpBinding{intake_.gate().isOpen() ? wide : QHostAddress(QHostAddress::LocalHost), address_.data},
                onPacket);
        }
        command_ = std::move(command);
        data_ = std::move(data);
    }

    /// Networks come late: what could not be had at the start is tried again.
    void openLater(Microseconds now) {
        if (isLocalMissing() || now < nextTry_) return;
        nextTry_ = now + kAgain;
        try {
            openPorts();
            trouble_.clear();
        } catch (const DeviceError& error) {
            trouble_ = std::string(error.what()) + ".";
        }
    }

    void say(std::span<const std::byte> bytes) {
        command_->send(bytes, host_, address_.command);
        if (data_ && !address_.multicast) data_->send(bytes, host_, address_.command);
    }

    void take(std::span<const std::byte> bytes, const QHostAddress& sender, quint16 port) {
        const Microseconds now = options_.clock->now();
        if (!intake_.admit(sender, now)) return;
        // Of several machines in a group only the one that was named is listened to.
        if (sender != host_ && !(isHostHere() && intake_.gate().isOwn(sender))) {
            intake_.reject("it comes from " + sender.toString().toStdString() + ", not from " + address_.host, now);
            return;
        }
        try {
            use(client_.take(bytes, now), now);
        } catch (const DataError& error) {
            intake_.reject(error.what(), sender, port, now);
        }
    }

    void use(NatNetClient::Outcome outcome, Microseconds now) {
        switch (outcome) {
        case NatNetClient::Outcome::waiting:
            waitingSince_ = now;
            return;
        case NatNetClient::Outcome::answer:
            log_->noteAnswer();
            break;
        case NatNetClient::Outcome::frame:
            waitingSince_.reset();
            intake_.deliver(client_.frame(), client_.latencyMilliseconds());
            if (sourceTold_) return;
            break;
        }
        tellSource();
    }

    void tellSource() {
        const auto version = client_.version();
        if (!version) return;
        const std::string natnet = "NatNet " + std::to_string(version->major) + "." + std::to_string(version->minor);
        std::string source = "a server at " + address_.host + ", " + natnet;
        if (const auto& server = client_.server())
            source = server->name + " " + std::to_string(server->program[0]) + "." +
                     std::to_string(server->program[1]) + " at " + address_.host + ", " + natnet;
        log_->setSource(source, client_.isVerified());
        sourceTold_ = true;
    }

    [[nodiscard]] NatNetSituation situation(Microseconds now) const {
        NatNetSituation s;
        static_cast<TrackerSituation&>(s) = intake_.situation(now);
        s.localMissing = isLocalMissing();
        s.trouble = trouble_;
        s.hostIsHere = isHostHere();
        s.server = client_.server();
        s.framesWithoutVersion = waitingSince_ && now - *waitingSince_ < kAgain;
        return s;
    }

    NatNetAddress address_;
    QHostAddress host_;
    std::shared_ptr<TrackerLog> log_;
    TrackerOptions options_;
    PacketIntake intake_;
    NatNetClient client_;
    std::unique_ptr<UdpPort> command_;
    std::unique_ptr<UdpPort> data_;
    std::string trouble_;
    Microseconds nextTry_{0};
    std::optional<Microseconds> waitingSince_;
    bool sourceTold_ = false;
};

} // namespace

std::unique_ptr<Tracker> openNatNet(const NatNetAddress& address, const std::string& uri, TrackerOptions options) {
    auto log = std::make_shared<TrackerLog>(uri, options.clock);
    return std::make_unique<TrackerThread>(
        log, [=, options = std::move(options)] { return std::make_unique<NatNetWork>(address, log, options); },
        kNatNetStep);
}

} // namespace lumorph
