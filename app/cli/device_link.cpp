#include "app/cli/device_link.h"

#include <cstdio>
#include <string>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "devices/transport/address.h"
#include "devices/transport/bluetooth_trouble.h"

namespace lumorph::cli {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPause{20};
constexpr std::chrono::seconds kLetGoWithin{2};  // detaching is repeated until the board has confirmed it
constexpr std::chrono::seconds kAnswerWithin{8}; // an Arduino starts anew when its port is opened

/// Who is out of reach of the radio may come near, or be switched on. A port is there or it is not.
bool mayPass(const LinkTrouble& trouble, const DeviceAddress& address) {
    const auto* radio = std::get_if<BluetoothAddress>(&address);
    if (!radio) return false;
    for (const BluetoothObstacle lasting : {BluetoothObstacle::noAdapter, BluetoothObstacle::switchedOff,
                                            BluetoothObstacle::notAllowed, BluetoothObstacle::notPaired})
        if (trouble == bluetoothTrouble(lasting, radio->mac)) return false;
    return true;
}

} // namespace

DeviceLink::DeviceLink(const DeviceProfile& profile, Session& session, OnWire onWire)
    : session_(session), link_(profile, options(std::move(onWire))) {
    link_.connect();
    session_.setLastAct([this] { letGo(); });
    try {
        untilOpen();
    } catch (...) {
        session_.setLastAct({});
        throw;
    }
}

DeviceLink::~DeviceLink() {
    link_.leave();
    session_.setLastAct({});
}

/// Beside the command's own thread, which may wait for whoever reads what it prints.
void DeviceLink::letGo() { static_cast<void>(link_.letGo(kLetGoWithin)); }

LinkOptions DeviceLink::options(OnWire onWire) {
    LinkOptions options;
    options.bench = &bench_;
    options.onWire = std::move(onWire);
    return options;
}

void DeviceLink::untilOpen() {
    const DeviceAddress address = parseDeviceAddress(link_.profile().address);
    const auto end = Clock::now() + kAnswerWithin;
    for (LinkStatus status = link_.status(); status.phase <= LinkPhase::connecting; status = link_.status()) {
        if (Clock::now() > end || (status.trouble && !mayPass(*status.trouble, address))) throwTrouble();
        wait();
    }
}

void DeviceLink::untilReady(bool confirmed) {
    const auto answered = [](const LinkStatus& status) {
        return status.controller.phase == ControllerPhase::refused ||
               (status.phase >= LinkPhase::unidentified && status.phase != LinkPhase::lost);
    };
    if (!until(answered, kAnswerWithin) || link_.status().controller.phase == ControllerPhase::refused) throwTrouble();
    if (link_.status().phase != LinkPhase::unidentified || !confirmed) return;
    link_.confirmIdentity();
    if (!until([](const LinkStatus& status) { return status.phase == LinkPhase::disarmed; }, kAnswerWithin))
        throwTrouble();
}

void DeviceLink::throwTrouble() {
    const LinkStatus status = link_.status();
    const std::string subject = link_.profile().address;
    if (status.trouble) throw DeviceError(subject, status.trouble->why, status.trouble->remedy);
    throw DeviceError(subject, "it does not answer", "check its power, the address and the kind of controller");
}

void DeviceLink::wait() {
    session_.throwIfCancelled();
    std::this_thread::sleep_for(kPause);
}

void DeviceLink::tell() {
    for (const LinkEvent& event : link_.takeEvents())
        std::fprintf(stderr, "%s%s%s\n", event.text.c_str(),
                     event.remedy.empty() ? "" : " Remedy: ", event.remedy.c_str());
    if (std::ferror(stderr) != 0) throwIfReaderGone();
}

} // namespace lumorph::cli
