#include "app/studio/devices/device_service_data.h"

#include <utility>

#include "core/base/error.h"
#include "devices/controllers/controller_kinds.h"
#include "devices/transport/address.h"

/// What the user orders at the service.
namespace lumorph::studio {

void DeviceService::setShown(bool shown) {
    data_->finder.setLooking(shown);
    if (!shown) {
        data_->poll.stop();
        return;
    }
    data_->poll.start();
    data_->take();
}

void DeviceService::searchBluetooth() {
    data_->notices.dismiss("devices", "Bluetooth");
    data_->finder.searchBluetooth();
}

bool DeviceService::setProfile(const DeviceProfile& profile) {
    if (!data_->force(profile)) return false;
    data_->keep();
    return true;
}

bool DeviceService::previewProfile(const DeviceProfile& profile) {
    if (data_->link && beginsAnew(data_->link->profile(), profile)) return false;
    return data_->force(profile);
}

void DeviceService::loadProfile(const QString& name) {
    if (!data_->rig) return;
    try {
        DeviceProfile loaded = data_->profiles.load(name, *data_->rig);
        if (data_->status.phase == LinkPhase::off) {
            data_->retire();
        } else { // what is connected stays connected
            loaded.address = data_->profile.address;
            loaded.controller = data_->profile.controller;
            loaded.identity = data_->profile.identity;
            loaded.confirmed = data_->profile.confirmed;
        }
        setProfile(loaded);
    } catch (const Error& error) {
        data_->notices.post("servo", noticeOf(error));
        emit profileChanged();
    }
}

void DeviceService::saveProfileAs(const QString& name) {
    DeviceProfile named = data_->profile;
    named.name = fileNameOf(name).toStdString();
    setProfile(named);
}

void DeviceService::resetProfile() {
    if (!data_->rig) return;
    DeviceProfile fresh = data_->profile;
    fresh.servos = freshProfile(*data_->rig, fresh.controller).servos;
    setProfile(fresh);
}

void DeviceService::connectTo(const QString& address, std::optional<ControllerKind> controller) {
    if (!data_->rig) return;
    const std::string wanted = address.trimmed().toStdString();
    const DeviceProfile next =
        readdressed(data_->profile, *data_->rig, wanted, controller.value_or(likelyController(wanted)));
    const DeviceProfile before = std::exchange(data_->profile, next);
    try {
        static_cast<void>(parseDeviceAddress(wanted));
        const bool other = !data_->link || data_->link->profile().address != wanted ||
                           data_->link->profile().controller != next.controller;
        if (other) data_->makeLink();
        data_->link->connect();
        data_->notices.dismissAll("devices");
        data_->keep();
    } catch (const Error& error) {
        data_->profile = before;
        data_->notices.post("devices", noticeOf(error));
    }
    emit profileChanged();
    data_->take();
}

void DeviceService::disconnect() {
    if (!data_->link) return;
    data_->link->disconnect();
    data_->feed.drop();
    data_->notices.dismissAll("device");
    data_->take();
}

void DeviceService::confirm() {
    if (!data_->link) return;
    data_->link->confirmIdentity();
    if (const std::string& identity = data_->status.identity; !identity.empty()) {
        DeviceProfile known = data_->profile;
        known.identity = identity;
        known.confirmed = true;
        setProfile(known);
    }
    data_->take();
}

void DeviceService::start(bool jumpAllowed) {
    if (!data_->link) return;
    static_cast<void>(data_->feed.takeStoppedLive()); // this start is the one to come
    data_->loop.resume();
    data_->link->arm(jumpAllowed);
    data_->take();
}

void DeviceService::stopNow() { data_->feed.stop(); }

void DeviceService::setStopKeysProblem(const QString& why) {
    data_->stopKeysProblem = why;
    emit changed();
}

const QString& DeviceService::stopKeysProblem() const noexcept { return data_->stopKeysProblem; }

void DeviceService::release() {
    if (!data_->link) return;
    data_->link->disarm();
    data_->feed.drop();
    data_->take();
}

void DeviceService::wiggle(std::size_t servo) {
    if (data_->link) data_->link->wiggle(servo);
}

void DeviceService::setSlow(bool slow) {
    data_->slow = slow;
    data_->feed.setSlow(SlowCause::user, slow);
    emit changed();
}

void DeviceService::test(std::size_t servo, double stroke) {
    if (data_->status.phase != LinkPhase::live) return;
    data_->feed.hold(servo, stroke);
    data_->sinceTest.start();
    data_->testTimer.start();
    emit changed();
}

void DeviceService::endTest() {
    if (!data_->feed.testing()) return;
    data_->feed.release();
    data_->sinceTest.start();
    data_->testTimer.start();
    emit changed();
}

void DeviceService::setPoses(std::shared_ptr<const PoseBoard> poses) { data_->handWatch.setPoses(std::move(poses)); }

QString DeviceService::name() const {
    const std::string& address = data_->profile.address;
    for (const FoundDevice& one : data_->finder.found())
        if (one.address == address) return QString::fromStdString(one.name);
    if (!data_->status.product.empty()) return QString::fromStdString(data_->status.product);
    return address.empty() ? QString("Device") : QString::fromStdString(address);
}

QString DeviceService::liveName() const {
    switch (data_->status.phase) {
    case LinkPhase::starting:
    case LinkPhase::live:
    case LinkPhase::stopped:
        return name();
    default:
        return {};
    }
}

void DeviceService::setTrace(std::function<void(const ServoTraceRow&)> sink) {
    data_->trace = std::move(sink);
    data_->traceLink();
}

void DeviceService::note(const QString& text) {
    data_->log.add({QDateTime::currentDateTime(), LinkEvent::Kind::information, text, {}, true});
    emit logged(1);
}

} // namespace lumorph::studio
